#include "bake/shape/shape_options.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bake/mesh/mesh.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::span kAsNames = kWordsOf<ShapeAs>;
/// What a name is recorded by as it is, beside all beyond ASCII.
constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+/:,-";
/// Before a default thickness, of which each part takes its own.
constexpr std::string_view kByPart = "auto=";
constexpr std::string_view kHex = "0123456789ABCDEF";

bool isPlain(char c) {
    return static_cast<unsigned char>(c) >= 0x80 || kPlain.find(c) != std::string_view::npos;
}

std::string encoded(std::string_view name) {
    std::string text;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        text += isPlain(c) ? std::string(1, c) : std::string{'%', kHex[byte / 16], kHex[byte % 16]};
    }
    return text;
}

/// nullopt for what encoded() does not write.
std::optional<std::string> decoded(std::string_view text) {
    std::string name;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view hex = text.substr(i, 3);
        const std::size_t high = hex.size() == 3 ? kHex.find(hex[1]) : std::string_view::npos;
        const std::size_t low = hex.size() == 3 ? kHex.find(hex[2]) : std::string_view::npos;
        if (isPlain(text[i])) {
            name += text[i];
        } else if (text[i] == '%' && high != std::string_view::npos && low != std::string_view::npos) {
            name += static_cast<char>(16 * high + low);
            i += 2;
        } else {
            return std::nullopt;
        }
    }
    return cleanUtf8(name, kAskedNameBytesMax) == name ? std::optional(name) : std::nullopt;
}

bool isNamed(const ShapeOptions& options, std::string_view name) {
    return std::any_of(options.named.begin(), options.named.end(),
                       [&](const NamedShape& named) { return named.name == name; });
}

}  // namespace

std::string_view shapeAsName(ShapeAs as) {
    return wordOf(as);
}

std::optional<ShapeAs> parseShapeAs(std::string_view name) {
    return fromWord<ShapeAs>(name);
}

std::vector<std::string> ShapeOptions::names() const {
    std::vector<std::string> names;
    for (const NamedShape& shape : named) {
        names.push_back(shape.name);
    }
    return names;
}

Result<ShapeOptions> parseShapeOptions(const std::vector<std::string>& words) {
    ShapeOptions options;
    bool said = false;
    for (const std::string& word : words) {
        const std::size_t equals = word.rfind('=');
        const bool is_named = equals != std::string::npos;
        const std::string kind = is_named ? word.substr(equals + 1) : word;
        // As the file's names are made: what an error message lists can be typed.
        const std::string name = cleanUtf8(word.substr(0, is_named ? equals : 0));
        const std::optional<ShapeAs> as = parseShapeAs(kind);
        const auto wrong = [&](const std::string& why) {
            return fail(ErrorCode::kUsage,
                        "--as is '" + cleanUtf8(word, 2 * kAskedNameBytesMax) + "' but " + why);
        };
        if (!as) {
            return wrong((is_named ? "what follows the last = must be one of " : "must be one of ") +
                         listed(kAsNames) + (is_named ? "" : ", or NAME= and one of them") +
                         didYouMean(kind, kAsNames));
        }
        if (!is_named) {
            if (said) {
                return wrong("another --as says " + std::string(shapeAsName(options.as)) +
                             " for all that has no name; leave one out");
            }
            options.as = *as;
            said = true;
            continue;
        }
        if (name.empty()) {
            return wrong("before the = must be a name of the mesh file; leave out the = for all of it");
        }
        if (name.size() > kAskedNameBytesMax) {
            return wrong("a name has at most " + std::to_string(kAskedNameBytesMax) + " bytes; shorten it");
        }
        if (isNamed(options, name)) {
            return wrong("another --as has the same name; leave one out");
        }
        if (options.named.size() == kAskedNamesMax) {
            return fail(ErrorCode::kLimit, "--as names more than " + std::to_string(kAskedNamesMax) +
                                               "; use a node above them, or another default");
        }
        options.named.push_back({name, *as});
    }
    return options;
}

std::string recordedShape(const ShapeOptions& options) {
    std::string text;
    if (options.as != ShapeAs::kAuto) {
        text.append(" --as ").append(shapeAsName(options.as));
    }
    for (const NamedShape& named : options.named) {
        text.append(" --as ").append(encoded(named.name)).append("=").append(shapeAsName(named.as));
    }
    if (options.thickness > 0.0) {
        text += " --thickness " + std::string(options.thickness_by_part ? kByPart : "") +
                shortest(static_cast<float>(options.thickness));
    }
    return text;
}

bool readRecordedShape(std::string_view option, std::string_view value, ShapeOptions& options) {
    if (option == "--thickness") {
        const bool by_part = value.starts_with(kByPart);
        const std::optional<float> thickness = parseFloat(value.substr(by_part ? kByPart.size() : 0));
        if (!thickness || !(*thickness > 0.0F)) {
            return false;
        }
        options.thickness = double{*thickness};
        options.thickness_by_part = by_part;
        return true;
    }
    const std::size_t equals = value.find('=');
    const bool is_named = equals != std::string_view::npos;
    const std::optional<ShapeAs> as = parseShapeAs(is_named ? value.substr(equals + 1) : value);
    if (option != "--as" || !as) {
        return false;
    }
    if (!is_named) {
        options.as = *as;
        return true;
    }
    const std::optional<std::string> name = decoded(value.substr(0, equals));
    if (!name || name->empty() || isNamed(options, *name) || options.named.size() == kAskedNamesMax) {
        return false;
    }
    options.named.push_back({*name, *as});
    return true;
}

ShapeOptions shapeOptionsOf(std::string_view container_options, const ShapeOptions& otherwise) {
    ShapeOptions options = otherwise;
    for (std::string_view word = takeWord(container_options); !word.empty();
         word = takeWord(container_options)) {
        if (word == "--as" || word == "--thickness") {
            static_cast<void>(readRecordedShape(word, takeWord(container_options), options));
        }
    }
    return options;
}

}  // namespace relief
