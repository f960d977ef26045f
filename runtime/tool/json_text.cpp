#include "runtime/tool/json_text.h"

#include <nlohmann/json.hpp>

#include "formats/fields/json.h"

namespace relief {

Json jsonVector(const glm::vec3& v) {
    return Json::array({jsonNumber(v.x), jsonNumber(v.y), jsonNumber(v.z)});
}

std::string jsonText(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace relief
