// SPDX-License-Identifier: Apache-2.0
#include "bake/import/animated_import.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Name length in bytes that leaves space for a unique number.
constexpr std::size_t kBareNameMax = kAnimatedNameMax - 8;
constexpr std::size_t kNamesListed = 5;

/// Whether a program can pose the mesh without clips: it has a skin or morph targets.
bool canBePosed(const AnimatedMesh& mesh) {
    return !mesh.weights.empty() || mesh.influences.size() > mesh.positions.size() ||
           std::ranges::any_of(mesh.joints, [](const MeshJoint& joint) { return joint.bind != Affine{}; });
}

/// Maps the nodes of one mesh to the nodes of another mesh by name.
class NodeMatch {
  public:
    NodeMatch(const AnimatedMesh& from, const AnimatedMesh& mesh) : from_(from), mesh_(mesh) {
        for (std::uint32_t i = 0; i < mesh.nodes.size(); ++i) {
            if (!mesh.nodes[i].name.empty()) {
                by_name_.try_emplace(mesh.nodes[i].name, i);
            }
        }
    }

    /// Returns nullopt if no node matches, or if the channel cannot move it.
    std::optional<std::uint32_t> nodeOf(const ClipChannel& channel) {
        const MeshNode& from = from_.nodes[channel.node];
        const auto found = by_name_.find(from.name);
        if (found != by_name_.end()) {
            const MeshNode& node = mesh_.nodes[found->second];
            const bool movable = channel.member == NodeMember::kWeights ? node.weights == from.weights
                                                                        : !node.matrix.has_value();
            if (movable) {
                return found->second;
            }
        }
        if (std::ranges::find(unknown_, from.name) == unknown_.end()) {
            unknown_.push_back(from.name);
        }
        return std::nullopt;
    }

    [[nodiscard]] bool allKnown() const { return unknown_.empty(); }
    /// Lists unmatched names: "'a', 'b' and 3 more".
    [[nodiscard]] std::string unknown() const {
        std::string text;
        for (std::size_t i = 0; i < std::min(unknown_.size(), kNamesListed); ++i) {
            text += (i == 0 ? "'" : ", '") + unknown_[i] + "'";
        }
        return unknown_.size() > kNamesListed
                   ? text + " and " + std::to_string(unknown_.size() - kNamesListed) + " more"
                   : text;
    }

  private:
    const AnimatedMesh& from_;
    const AnimatedMesh& mesh_;
    std::map<std::string, std::uint32_t, std::less<>> by_name_;
    std::vector<std::string> unknown_;
};

Result<void> addFile(const std::string& file, const ImportLimits& limits, AnimatedImport& all) {
    AnimatedImport clips = RELIEF_TRY(importAnimatedFileInWorker(file, ImportKind::kClips, {}, limits));
    TriangleMesh& from = clips.rest;
    std::vector<std::string> warnings;
    RELIEF_TRY(withPrefix("cannot add the clips of " + quotedPath(file),
                          addClipsOf(clips.mesh, all.mesh, warnings)));
    for (const std::string& warning : warnings) {
        from.warnings.push_back(from.name + ": " + warning);
    }
    TriangleMesh& rest = all.rest;
    rest.warnings.insert(rest.warnings.end(), from.warnings.begin(), from.warnings.end());
    rest.dependencies.insert(rest.dependencies.end(), from.dependencies.begin(), from.dependencies.end());
    rest.dependency_hashes.insert(rest.dependency_hashes.end(), from.dependency_hashes.begin(),
                                  from.dependency_hashes.end());
    return {};
}

}  // namespace

void addClip(AnimatedMesh& mesh, MeshClip clip, std::vector<std::string>& warnings) {
    const std::string name = cleanUtf8(clip.name, kBareNameMax);
    clip.name = name;
    for (int number = 2; std::ranges::find(mesh.clips, clip.name, &MeshClip::name) != mesh.clips.end();
         ++number) {
        clip.name = name + " " + std::to_string(number);
    }
    if (clip.name != name) {
        warnings.push_back("another clip has the name '" + name + "'; this one is renamed to '" + clip.name +
                           "'");
    }
    mesh.clips.push_back(std::move(clip));
}

Result<void> addClipsOf(const AnimatedMesh& from, AnimatedMesh& mesh, std::vector<std::string>& warnings) {
    if (from.clips.empty()) {
        return invalidInput("it has no animation; export it with one");
    }
    NodeMatch match(from, mesh);
    std::size_t added = 0;
    for (const MeshClip& clip : from.clips) {
        MeshClip matched{clip.name, clip.seconds, {}};
        std::set<std::pair<std::uint32_t, NodeMember>> moved;
        for (const ClipChannel& channel : clip.channels) {
            const std::optional<std::uint32_t> node = match.nodeOf(channel);
            if (node && moved.emplace(*node, channel.member).second) {
                matched.channels.push_back(channel);
                matched.channels.back().node = *node;
            }
        }
        if (matched.channels.empty()) {
            continue;
        }
        if (mesh.clips.size() == kMeshClipsMax) {
            return fail(ErrorCode::kLimit, "its clips exceed the limit of " + std::to_string(kMeshClipsMax) +
                                               " for all files; leave some out");
        }
        ++added;
        addClip(mesh, std::move(matched), warnings);
    }
    if (added == 0) {
        return invalidInput("none of its animated nodes has the name of a node of the mesh: " +
                            match.unknown() + "; use clips of the same skeleton");
    }
    if (!match.allKnown()) {
        warnings.push_back("left out channels of nodes that the mesh does not have: " + match.unknown());
    }
    return {};
}

Result<AnimatedImport> importAnimatedInWorker(const fs::path& path,
                                              const std::vector<std::string>& clip_files,
                                              const ImportOptions& options, const ImportLimits& limits) {
    AnimatedImport all = RELIEF_TRY(importAnimatedFileInWorker(path, ImportKind::kAnimated, options, limits));
    for (const std::string& file : clip_files) {
        RELIEF_TRY(addFile(file, limits, all));
    }
    if (all.mesh.clips.empty() && !canBePosed(all.mesh)) {
        return invalidInput(quotedPath(path) +
                            ": nothing in it moves: no skin, no morph target and no animation; bake it "
                            "without --animated, or add --clips");
    }
    if (all.mesh.clips.empty()) {
        all.rest.warnings.push_back(all.rest.name +
                                    ": it has no animation, so it moves only if a program poses it; to "
                                    "add animations from other files, use --clips");
    }
    RELIEF_TRY(validate(all.mesh));
    return all;
}

}  // namespace relief
