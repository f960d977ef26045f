#include "runtime/tool/json_text.h"

#include <charconv>
#include <nlohmann/json.hpp>

#include "formats/base/text.h"

namespace relief {

using Json = nlohmann::ordered_json;

Json jsonNumber(float value) {
    double number = 0.0;
    const std::string text = shortest(value);
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

Json jsonVector(const glm::vec3& v) {
    return Json::array({jsonNumber(v.x), jsonNumber(v.y), jsonNumber(v.z)});
}

std::string jsonText(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace relief
