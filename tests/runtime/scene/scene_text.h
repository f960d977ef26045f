// SPDX-License-Identifier: Apache-2.0
// Scene texts of tests, and errors in them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/scene/scene.h"
#include "tests/results.h"

namespace relief {

/// A collider; the lines after it start at line 3.
inline const std::string kSceneHead = "[[collider]]\nfile = \"a.relief\"\n";

inline Result<Scene> sceneOf(const std::string& text) {
    return parseScene(text, "dir/scene.toml");
}

/// The scene of a text that must be valid.
inline Scene goodScene(const std::string& text) {
    SCOPED_TRACE(text);
    return required(sceneOf(text));
}

/// The scene of one collider and these lines.
inline Scene sceneWith(const std::string& more) {
    return goodScene(kSceneHead + more);
}

inline Bounds unitBounds() {
    return {{-1.0F, 0.0F, -0.5F}, {1.0F, 1.0F, 0.5F}};
}

/// \param names  the key, or other text that identifies the error at its position.
template <class T>
void expectErrorOf(const Result<T>& result, const std::string& place, const std::string& names = "") {
    expectError(result, ErrorCode::kInvalidInput, place);
    expectError(result, ErrorCode::kInvalidInput, names);
}

struct SceneError {
    std::string text;
    std::string place;  ///< line and column of its error, "3:1"
    std::string names;  ///< the key, or other text that identifies the error at that position
};

/// Each text after the head is rejected with a one-line message.
inline void expectErrors(const std::string& head, const std::vector<SceneError>& errors) {
    for (const auto& [text, place, names] : errors) {
        SCOPED_TRACE(head + text);
        expectErrorOf(sceneOf(head + text), "dir/scene.toml:" + place + ": ", names);
    }
}

}  // namespace relief
