// Arrays of tables in a scene file: [[type]], [[camera.key]].
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/scene/scene_table.h"

namespace relief {

/// The tables of the array `key` in `table`; none if it is absent. Throws SceneError.
[[nodiscard]] inline std::vector<const toml::table*> arrayOfTables(SceneTable& table, std::string_view key,
                                                                   std::size_t most) {
    std::vector<const toml::table*> tables;
    const toml::node* node = table.find(key);
    if (node == nullptr) {
        return tables;
    }
    const std::string wanted = "tables, each as in [[" + table.full(key) + "]]";
    if (!node->is_array()) {
        table.wrongType(*node, key, wanted);
    }
    for (const toml::node& one : *node->as_array()) {
        if (!one.is_table()) {
            table.wrongType(one, key, wanted);
        }
        if (tables.size() == most) {
            table.failAt(
                one, "more than " + std::to_string(most) + " of [[" + table.full(key) + "]]; remove some");
        }
        tables.push_back(one.as_table());
    }
    return tables;
}

}  // namespace relief
