// The keys of a TOML table as a person reads them.
#pragma once

#include <algorithm>
#include <vector>

#include "runtime/toml.h"

namespace relief {

/// The keys of a table in the order of the file, so that the first mistake is the one reported.
inline std::vector<const toml::key*> keysInOrder(const toml::table& table) {
    std::vector<const toml::key*> keys;
    for (const auto& [key, node] : table) {
        keys.push_back(&key);
    }
    std::sort(keys.begin(), keys.end(), [](const toml::key* a, const toml::key* b) {
        const toml::source_position& p = a->source().begin;
        const toml::source_position& q = b->source().begin;
        return p.line != q.line ? p.line < q.line : p.column < q.column;
    });
    return keys;
}

}  // namespace relief
