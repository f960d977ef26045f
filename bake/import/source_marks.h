// SPDX-License-Identifier: Apache-2.0
// Properties of a file that assimp drops: which nodes are hidden or are levels of detail, and references to missing objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Ends the names of LodGroup nodes in the result of markedFbx(). As long as "LodGroup".
inline constexpr std::string_view kLodGroupMark = "\x02LodGrp\x02";

/// An FBX document of the same length, binary or text, of which assimp gives more: the visibility of nodes as metadata
/// ("Visibility", "Visibility Inheritance"), because their type becomes a number; and LodGroup nodes by their names, because
/// the class moves there. \return nullopt where there is nothing to change.
[[nodiscard]] std::optional<std::vector<std::byte>> markedFbx(std::span<const std::byte> document);

/// Whether curves animate the visibility of nodes of an FBX document.
[[nodiscard]] bool fbxAnimatesVisibility(std::span<const std::byte> document);

struct ColladaNode {
    std::string name;                     ///< the id or else the sid, as assimp names nodes; may be empty
    std::string label;                    ///< the name for messages
    bool hidden = false;                  ///< `visibility` 0 or false in a <technique> of an <extra>
    std::vector<std::uint32_t> children;  ///< indices of its own nodes, then of those that it instances
};
struct ColladaNodes {
    std::vector<ColladaNode> nodes;  ///< the visual scene first
    bool animates_visibility = false;
    std::optional<std::string> missing;  ///< a warning: instances of what does not exist
};
/// The nodes that the document's scene shows. A document that is no XML has none.
/// Errors: kUnsupported (an instance of an object in another file, with its line and node).
[[nodiscard]] Result<ColladaNodes> readColladaNodes(std::span<const std::byte> document);

/// Names of the hidden objects of a 3DS file. Nodes have them if the file has a keyframer.
[[nodiscard]] std::set<std::string> hiddenObjectsOf3ds(std::span<const std::byte> document);

}  // namespace relief
