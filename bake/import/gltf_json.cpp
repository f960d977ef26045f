#include "bake/import/gltf_json.h"

#include <algorithm>
#include <set>

#include "formats/base/text.h"

namespace relief {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kDepthMax = 256;
constexpr std::uint64_t kWholeMax = std::uint64_t{1} << 53U;
constexpr std::size_t kKeyMax = 40;  // bytes of a key in a message

/// Thrown and caught in this file: nothing else stops the parser.
struct Refusal {
    Error error;
};

/// What the parser reports as it goes.
class Strictness {
  public:
    void hear(Json::parse_event_t event, const Json& parsed) {
        using Event = Json::parse_event_t;
        switch (event) {
            case Event::object_start:
            case Event::array_start:
                countElement();
                if (open_.size() >= kDepthMax) {
                    throw Refusal{{ErrorCode::kLimit, "its JSON is nested more than " +
                                                          std::to_string(kDepthMax) +
                                                          " deep; export it again"}};
                }
                open_.push_back({event == Event::object_start, {}, {}, 0});
                break;
            case Event::object_end:
            case Event::array_end:
                open_.pop_back();
                break;
            case Event::key:
                open_.back().key = parsed.get<std::string>();
                if (!open_.back().keys.insert(open_.back().key).second) {
                    throw Refusal{{ErrorCode::kInvalidInput, "its JSON has the key " + path() +
                                                                 " twice in one object; export it again"}};
                }
                break;
            case Event::value:
                countElement();
                break;
        }
    }

  private:
    struct Open {
        bool object;
        std::set<std::string> keys;
        std::string key;
        std::size_t elements;
    };

    void countElement() {
        if (!open_.empty() && !open_.back().object) {
            ++open_.back().elements;
        }
    }
    [[nodiscard]] std::string path() const {
        std::string text;
        for (const Open& open : open_) {
            text += open.object ? (text.empty() ? "" : ".") + cleanUtf8(open.key, kKeyMax)
                                : "[" + std::to_string(open.elements - 1) + "]";
        }
        return text;
    }

    std::vector<Open> open_;
};

std::optional<std::uint64_t> wholeOf(const Json& json) {
    if (json.is_number_unsigned() && json.get<std::uint64_t>() <= kWholeMax) {
        return json.get<std::uint64_t>();
    }
    if (json.is_number_float()) {
        const double value = json.get<double>();
        if (value >= 0.0 && value <= static_cast<double>(kWholeMax) &&
            value == static_cast<double>(static_cast<std::uint64_t>(value))) {
            return static_cast<std::uint64_t>(value);
        }
    }
    return std::nullopt;
}

std::string placeInText(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = before.size() - (before.find_last_of('\n') + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace

Result<Json> parseGltfJson(std::string_view text) {
    // Zeros fill up the last block of some files; the parser would stop at any.
    text = text.substr(0, text.find_last_not_of(std::string_view(" \t\r\n\0", 5)) + 1);
    if (text.find('\0') != std::string_view::npos) {
        return invalidInput("it is no valid JSON (" + placeInText(text, text.find('\0') + 1) +
                            ": a byte of 0)");
    }
    try {
        Strictness strict;
        return Json::parse(text.begin(), text.end(),
                           [&strict](int /*depth*/, Json::parse_event_t event, Json& parsed) {
                               strict.hear(event, parsed);
                               return true;
                           });
    } catch (const Refusal& refusal) {
        return tl::unexpected<Error>(refusal.error);
    } catch (const Json::parse_error& error) {
        return invalidInput("it is no valid JSON (" + placeInText(text, error.byte) + ")");
    } catch (const Json::exception& error) {  // a number beyond all numbers
        return invalidInput("it is no valid JSON: " + cleanUtf8(error.what(), 200) + "; export it again");
    }
}

std::string GltfValue::path() const {
    std::string text;
    for (std::size_t i = 0; i < depth_; ++i) {
        const Step& step = steps_.at(i);
        text += (i == 0 ? "" : ".") + std::string(step.name) +
                (step.index ? "[" + std::to_string(*step.index) + "]" : "");
    }
    return text.empty() ? "the document" : text;
}

tl::unexpected<Error> GltfValue::wrong(const std::string& what, ErrorCode code) const {
    return fail(code, path() + " " + what);
}

GltfValue GltfValue::step(const Json& json, const char* name, std::optional<std::size_t> index) const {
    GltfValue value = *this;
    value.json_ = &json;
    if (value.depth_ < value.steps_.size()) {
        value.steps_.at(value.depth_++) = {name, index};
    }
    return value;
}

const Json* GltfValue::member(const char* name) const {
    const auto found = json_->find(name);
    return found == json_->end() ? nullptr : &*found;
}

Result<const Json*> GltfValue::array(const char* name) const {
    const Json* const json = member(name);
    if (json != nullptr && !json->is_array()) {
        return step(*json, name).wrong("is not an array");
    }
    return json;
}

Result<std::optional<GltfValue>> GltfValue::object(const char* name) const {
    const Json* const json = member(name);
    if (json == nullptr) {
        return std::nullopt;
    }
    const GltfValue value = step(*json, name);
    if (!json->is_object()) {
        return value.wrong("is not an object");
    }
    return value;
}

Result<GltfList> GltfValue::objects(const char* name) const {
    return GltfList(*this, name, RELIEF_TRY(array(name)));
}

Result<std::optional<std::uint64_t>> GltfValue::whole(const char* name) const {
    const Json* const json = member(name);
    if (json == nullptr) {
        return std::nullopt;
    }
    const std::optional<std::uint64_t> value = wholeOf(*json);
    if (!value) {
        return step(*json, name).wrong("is not a whole number");
    }
    return value;
}

Result<std::uint64_t> GltfValue::neededWhole(const char* name) const {
    const std::optional<std::uint64_t> value = RELIEF_TRY(whole(name));
    if (!value) {
        return wrong(std::string("has no ") + name);
    }
    return *value;
}

Result<std::vector<std::uint64_t>> GltfValue::wholes(const char* name) const {
    const Json* const json = RELIEF_TRY(array(name));
    std::vector<std::uint64_t> values;
    for (std::size_t i = 0; json != nullptr && i < json->size(); ++i) {
        const std::optional<std::uint64_t> value = wholeOf((*json)[i]);
        if (!value) {
            return step(*json, name, i).wrong("is not a whole number");
        }
        values.push_back(*value);
    }
    return values;
}

Result<bool> GltfValue::flag(const char* name) const {
    const Json* const json = member(name);
    if (json != nullptr && !json->is_boolean()) {
        return step(*json, name).wrong("is neither true nor false");
    }
    return json != nullptr && json->get<bool>();
}

Result<std::optional<std::string>> GltfValue::text(const char* name) const {
    const Json* const json = member(name);
    if (json == nullptr) {
        return std::nullopt;
    }
    if (!json->is_string()) {
        return step(*json, name).wrong("is no string");
    }
    return json->get<std::string>();
}

Result<std::vector<std::string>> GltfValue::texts(const char* name) const {
    const Json* const json = RELIEF_TRY(array(name));
    std::vector<std::string> values;
    for (std::size_t i = 0; json != nullptr && i < json->size(); ++i) {
        if (!(*json)[i].is_string()) {
            return step(*json, name, i).wrong("is no string");
        }
        values.push_back((*json)[i].get<std::string>());
    }
    return values;
}

Result<bool> GltfValue::numbers(const char* name, std::span<float> out) const {
    const Json* const json = RELIEF_TRY(array(name));
    if (json == nullptr) {
        return false;
    }
    if (json->size() != out.size()) {
        return step(*json, name)
            .wrong("has " + std::to_string(json->size()) + " numbers instead of " +
                   std::to_string(out.size()));
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(*json)[i].is_number()) {
            return step(*json, name, i).wrong("is no number");
        }
        out[i] = static_cast<float>((*json)[i].get<double>());
    }
    return true;
}

Result<GltfValue> GltfList::at(std::size_t index) const {
    const GltfValue value = owner_.step((*array_)[index], name_, index);
    if (!value.isObject()) {
        return value.wrong("is not an object");
    }
    return value;
}

Result<GltfValue> GltfList::named(std::uint64_t index, const GltfValue& from, const char* member) const {
    if (index >= size()) {
        return from.wrong(std::string("names by ") + member + " " + name_ + "[" + std::to_string(index) +
                          "], which does not exist");
    }
    return at(index);
}

}  // namespace relief
