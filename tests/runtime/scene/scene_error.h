// What a scene with a mistake must say.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_parser.h"

namespace relief {

/// `text` is no scene, and says so in one line that starts with `start` ("dir/scene.toml:3:1: …") and holds
/// `part`.
inline void expectSceneError(const std::string& text, const std::string& start, const std::string& part) {
    const auto scene = parseScene(text, "dir/scene.toml");
    ASSERT_FALSE(scene) << text;
    const std::string& message = scene.error().message;
    EXPECT_EQ(scene.error().code, ErrorCode::kInvalidInput);
    EXPECT_TRUE(message.starts_with(start)) << text << "\n" << message;
    EXPECT_NE(message.find(part), std::string::npos) << text << "\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace relief
