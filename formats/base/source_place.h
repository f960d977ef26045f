// SPDX-License-Identifier: Apache-2.0
// The place of a value in the file that it was read from.
#pragma once

#include <string>
#include <utility>

namespace relief {

/// "scene.toml:3:8", for messages. It is no part of the value: all places are equal.
struct SourcePlace {
    std::string text;

    SourcePlace& operator=(std::string place) {
        text = std::move(place);
        return *this;
    }
    friend bool operator==(const SourcePlace&, const SourcePlace&) { return true; }
};

}  // namespace relief
