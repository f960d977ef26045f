// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/depfile.h"

#include <set>

#include "formats/base/file_io.h"

namespace relief {
namespace {

constexpr std::string_view kEscaped = " #$:";

/// Escapes a name so that Make and Ninja read it unchanged. They treat backslashes before an escaped character
/// differently, and have no escape for some characters.
Result<std::string> escaped(const std::string& name, bool target) {
    const auto reject = [&](const std::string& what) {
        return fail(ErrorCode::kUnsupported, quotedPath(name) + " cannot be written to a depfile: " + what +
                                                 " is not portable between Make and Ninja; rename the file");
    };
    if (name.empty()) {
        return reject("an empty name");
    }
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            return reject("a control character");
        }
        if (c == ';' || c == '=' || (target && c == '%')) {
            return reject(std::string("'") + c + "'");
        }
        if (c == '\\' && (i + 1 == name.size() || kEscaped.find(name[i + 1]) != std::string_view::npos)) {
            return reject("a backslash in this place");
        }
        if (c == '$') {
            text += "$$";
        } else if (kEscaped.find(c) != std::string_view::npos) {
            text += '\\';
            text += c;
        } else {
            text += c;
        }
    }
    return text;
}

}  // namespace

Result<std::string> depfileText(const std::vector<std::string>& targets,
                                const std::vector<std::string>& inputs) {
    std::string text;
    for (const std::string& target : targets) {
        const std::string name = RELIEF_TRY(escaped(target, true));
        text += (text.empty() ? "" : " ") + name;
    }
    text += ":";
    std::string empty_rules;
    std::set<std::string> seen;
    for (const std::string& input : inputs) {
        if (!seen.insert(input).second) {
            continue;
        }
        const std::string name = RELIEF_TRY(escaped(input, false));
        text += " \\\n  " + name;
        if (seen.size() > 1) {
            empty_rules += name + ":\n";
        }
    }
    return text + "\n" + empty_rules;
}

Result<void> writeDepfile(const std::filesystem::path& path, const std::vector<std::string>& targets,
                          const std::vector<std::string>& inputs) {
    const std::string text = RELIEF_TRY(depfileText(targets, inputs));
    return writeText(path, text);
}

}  // namespace relief
