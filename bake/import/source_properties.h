// SPDX-License-Identifier: Apache-2.0
// Reads properties that assimp drops or misreads: units, axes, hidden nodes, levels of detail, and references to
// missing objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/import_job.h"
#include "formats/base/result.h"

namespace relief {

/// Suffix that patchedFbx() adds to a node's name while it removes the class "LodGroup", which has the same length.
inline constexpr std::string_view kLodGroupMark = "\x02LodGrp\x02";

/// Patches an FBX document, binary or text, without changing its length, so that assimp exposes hidden nodes and levels
/// of detail. Visibility becomes numeric metadata ("Visibility", "Visibility Inheritance"), and the names of LodGroup
/// nodes get the suffix kLodGroupMark. \return nullopt if the document needs no patch.
[[nodiscard]] std::optional<std::vector<std::byte>> patchedFbx(std::span<const std::byte> document);

/// Whether curves animate the visibility of nodes in an FBX document.
[[nodiscard]] bool fbxAnimatesVisibility(std::span<const std::byte> document);

/// The UnitScaleFactor of an FBX file, binary or text, of any numeric type.
struct FbxUnit {
    std::string text;             ///< as stored in the file
    std::optional<double> value;  ///< nullopt if it is not a finite number
};
/// Reads the unit. \return nullopt if there is none.
[[nodiscard]] std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document);

/// Reads the <asset> element of a COLLADA document in any encoding. Defaults: metres and +Y.
[[nodiscard]] SourceFrame colladaFrame(std::span<const std::byte> document);

struct ColladaNode {
    std::string name;     ///< the id, else the sid, as assimp names nodes; may be empty
    std::string label;    ///< the name for messages
    bool hidden = false;  ///< `visibility` is 0 or false in a <technique> of an <extra>
    /// Indices of its own children, then of the nodes that it instances.
    std::vector<std::uint32_t> children;
};
struct ColladaNodes {
    std::vector<ColladaNode> nodes;  ///< the visual scene first
    bool animates_visibility = false;
    std::optional<std::string> missing;  ///< a warning: instances of missing objects
};
/// Reads the nodes of the document's <scene>, also hidden ones; none if the document is not XML.
/// Errors: kUnsupported (an instance of an object in another file, with line and node).
[[nodiscard]] Result<ColladaNodes> readColladaNodes(std::span<const std::byte> document);

/// Names of the hidden objects of a 3DS file. Nodes have these names if the file has a keyframer.
[[nodiscard]] std::set<std::string> hiddenObjectsOf3ds(std::span<const std::byte> document);

}  // namespace relief
