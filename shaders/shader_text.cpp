// SPDX-License-Identifier: Apache-2.0
#include "shaders/shader_text.h"

#include <algorithm>
#include <set>
#include <vector>

#include "shaders/shader_sources.h"

namespace relief {
namespace {

/// Replaces lines `//!include NAME` by the file's text, once per file, and `//!layer NAME` likewise in builds with that
/// layer.
Result<std::string> resolveIncludes(std::string_view name, std::vector<std::string>& included) {
    const std::string_view source = shaderSource(name);
    if (source.empty()) {
        return fail(ErrorCode::kFailure, "shader '" + std::string(name) + "' is not embedded in this build");
    }
    constexpr std::string_view kDirective = "//!include ";
    constexpr std::string_view kLayer = "//!layer ";
    std::string text;
    std::size_t at = 0;
    while (at < source.size()) {
        const std::size_t end = std::min(source.find('\n', at), source.size());
        const std::string_view line = source.substr(at, end - at);
        at = end + 1;
        const bool layer = line.starts_with(kLayer);
        if (!layer && !line.starts_with(kDirective)) {
            text.append(line).push_back('\n');
            continue;
        }
        const std::string child(line.substr((layer ? kLayer : kDirective).size()));
        if (layer && shaderSource(child).empty()) {
            continue;
        }
        if (std::find(included.begin(), included.end(), child) == included.end()) {
            included.push_back(child);
            std::string nested = RELIEF_TRY(resolveIncludes(child, included));
            text += nested;
        }
    }
    return text;
}

/// Adds the names in a text that start with RELIEF_.
void addNames(std::string_view text, std::set<std::string_view>& names) {
    constexpr std::string_view kStart = "RELIEF_";
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    for (std::size_t at = text.find(kStart); at != std::string_view::npos; at = text.find(kStart, at)) {
        const std::size_t end = std::min(text.find_first_not_of(kLetters, at), text.size());
        names.insert(text.substr(at, end - at));
        at = end;
    }
}

/// Returns the definitions in shaderConstants() that a shader uses. A definition may use earlier ones.
std::string constantsOf(std::string_view shader) {
    constexpr std::string_view kDefine = "#define ";
    std::set<std::string_view> used;
    addNames(shader, used);
    std::string text;
    std::string_view rest = shaderConstants();
    while (!rest.empty()) {
        const std::size_t start = rest.substr(0, rest.size() - 1).rfind('\n') + 1;  // npos + 1 is 0
        const std::string_view line = rest.substr(start);
        const std::string_view name =
            line.substr(kDefine.size(), line.find(' ', kDefine.size()) - kDefine.size());
        if (used.contains(name)) {
            addNames(line, used);
            text.insert(0, line);
        }
        rest = rest.substr(0, start);
    }
    return text;
}

}  // namespace

Result<std::string> includedShader(std::string_view file) {
    std::vector<std::string> included;
    return resolveIncludes(file, included);
}

Result<std::string> shaderText(std::string_view file) {
    const std::string text = RELIEF_TRY(includedShader(file));
    return constantsOf(text) + text;
}

}  // namespace relief
