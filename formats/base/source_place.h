// SPDX-License-Identifier: Apache-2.0
// Source position of a value read from a file.
#pragma once

#include <string>
#include <utility>

namespace relief {

/// A position such as "scene.toml:3:8", for messages. All positions compare equal, so comparisons ignore them.
struct SourcePlace {
    std::string text;

    SourcePlace& operator=(std::string place) {
        text = std::move(place);
        return *this;
    }
    friend bool operator==(const SourcePlace&, const SourcePlace&) { return true; }
};

}  // namespace relief
