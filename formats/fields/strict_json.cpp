// SPDX-License-Identifier: Apache-2.0
#include "formats/fields/strict_json.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

using PlainJson = nlohmann::json;

constexpr std::size_t kMessageBytesMax = 200;  // limit for a key or the parser's text in a message

/// Checks a text before it is parsed: with a callback, nlohmann's parser takes time quadratic in the length of an
/// array.
class Strictness : public nlohmann::detail::json_sax_acceptor<PlainJson> {
  public:
    explicit Strictness(const JsonLimits& limits) : limits_(limits) {}

    std::optional<Error> refused;

    bool null() { return count(); }
    bool boolean(bool) { return count(); }
    bool number_integer(PlainJson::number_integer_t) { return count(); }
    bool number_unsigned(PlainJson::number_unsigned_t) { return count(); }
    bool number_float(PlainJson::number_float_t, const std::string&) { return count(); }
    bool string(std::string&) { return count(); }
    bool start_object(std::size_t) { return begin(); }
    bool start_array(std::size_t) { return begin(); }
    bool end_object() { return end(); }
    bool end_array() { return end(); }
    bool key(std::string& name) {
        if (!keys_.back().insert(name).second) {
            refused = {
                ErrorCode::kInvalidInput,
                "its JSON has the key '" + cleanUtf8(name, kMessageBytesMax) + "' twice in one object"};
        }
        return !refused;
    }

  private:
    bool count() {
        if (++values_ > limits_.values) {
            refused = {ErrorCode::kLimit,
                       "its JSON has more than " + std::to_string(limits_.values) + " values"};
        }
        return !refused;
    }
    bool begin() {
        if (keys_.size() >= limits_.depth) {
            refused = {ErrorCode::kLimit,
                       "its JSON is nested more than " + std::to_string(limits_.depth) + " levels deep"};
        }
        keys_.emplace_back();
        return count();
    }
    bool end() {
        keys_.pop_back();
        return true;
    }

    JsonLimits limits_;
    std::size_t values_ = 0;
    std::vector<std::set<std::string>> keys_;  // of open objects
};

}  // namespace

Result<PlainJson> parseStrictJson(std::string_view text, const JsonLimits& limits) {
    if (text.find('\0') != std::string_view::npos) {
        return invalidInput("it is not valid JSON: it contains a zero byte");
    }
    Strictness strict(limits);
    PlainJson::sax_parse(text.begin(), text.end(), &strict);
    if (strict.refused) {
        return tl::unexpected<Error>(std::move(*strict.refused));
    }
    try {
        return PlainJson::parse(text.begin(), text.end());
    } catch (const PlainJson::exception& error) {  // also thrown for a number out of range
        const std::string_view words(error.what());
        return invalidInput("it is not valid JSON: " +
                            cleanUtf8(words.substr(words.find("] ") + 2), kMessageBytesMax));
    }
}

}  // namespace relief
