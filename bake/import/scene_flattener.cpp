// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "bake/import/import_scene.h"
#include "bake/import/level.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Limits of bodies (formats/world).
constexpr double kPlaceMax = 1e15;
constexpr double kScaleMin = 1e-9;
constexpr double kScaleMax = 1e9;

/// Whether a world may contain the pose; false for NaN.
bool isPlaced(const glm::dvec3& offset, double scale) {
    return std::abs(offset.x) <= kPlaceMax && std::abs(offset.y) <= kPlaceMax &&
           std::abs(offset.z) <= kPlaceMax && scale >= kScaleMin && scale <= kScaleMax;
}

/// Collects the names of a file's triangles, and marks triangles that --as selects.
class NameMarks {
  public:
    explicit NameMarks(const ImportJob& job) : job_(job) {
        for (std::size_t i = 0; i < std::min(job.options.names.size(), kSelectedNamesMax); ++i) {
            marks_[job.options.names[i]] = static_cast<std::uint8_t>(i + 1);
        }
    }

    [[nodiscard]] bool any() const { return !marks_.empty(); }

    /// Records the names of some triangles.
    /// \param names  as stored in the file.
    /// \return the triangles' mark (TriangleMesh::marks); the largest if several names apply.
    std::uint8_t record(const std::vector<std::string>& names) {
        std::uint8_t mark = 0;
        for (std::size_t i = 0; any() && i < names.size(); ++i) {
            const std::string name = cleanUtf8(names[i], kSelectedNameBytesMax);
            // The file's own name, which some readers give to the root, is not listed.
            if (!name.empty() && name != job_.file_name && names_.size() < kNamesMax &&
                known_.insert(name).second) {
                names_.push_back(name);
            }
            if (const auto found = marks_.find(name); found != marks_.end()) {
                mark = std::max(mark, found->second);
                found_.insert(found->second);
            }
        }
        return mark;
    }

    /// Checks that every selected name was found. Errors: kUsage, with the existing names.
    [[nodiscard]] Result<void> checkAllFound() const {
        const std::vector<std::string>& selected = job_.options.names;
        const auto unmatched = std::ranges::find_if(
            selected, [&](const std::string& name) { return !found_.contains(marks_.at(name)); });
        if (unmatched == selected.end()) {
            return {};
        }
        std::string text = "no triangle has the name '" + cleanUtf8(*unmatched, kSelectedNameBytesMax) + "'";
        const std::vector<std::string_view> known(names_.begin(), names_.end());
        text += didYouMean(*unmatched, known);
        if (known.empty()) {
            return fail(ErrorCode::kUsage, text + "; the file has no names: use --as without a name");
        }
        text += text.ends_with("?") ? " Names: " : "; names: ";
        for (std::size_t i = 0; i < std::min(known.size(), kListedMax); ++i) {
            text += (i == 0 ? "'" : ", '") + cleanUtf8(known[i], kListedBytesMax) + "'";
        }
        return fail(ErrorCode::kUsage, text + (known.size() > kListedMax ? " and more" : ""));
    }

  private:
    /// Limits on the names kept for suggestions, and on the names that a message lists.
    static constexpr std::size_t kNamesMax = 1000;
    static constexpr std::size_t kListedMax = 20;
    static constexpr std::size_t kListedBytesMax = 80;

    const ImportJob& job_;
    std::map<std::string, std::uint8_t, std::less<>> marks_;  // of the selected names
    std::set<std::uint8_t> found_;                            // marks that were found
    std::vector<std::string> names_;                          // the first names in the file, in order
    std::set<std::string, std::less<>> known_;                // the same, for lookup
};

class Flattener {
  public:
    Flattener(ImportScene scene, const ImportJob& job) : scene_(std::move(scene)), job_(job), marks_(job) {}

    Result<TriangleMesh> run() {
        RELIEF_TRY(prepare());
        if (!forEachUse([this](const SceneNode& node, const Transform& transform, std::uint8_t /*mark*/) {
                return count(node.parts, transform);
            })) {
            return tooManyTriangles(job_);
        }
        mesh_.positions.reserve(vertices_);
        mesh_.triangles.reserve(triangles_);
        mesh_.marks.reserve(marks_.any() ? triangles_ : 0);
        forEachUse([this](const SceneNode& node, const Transform& transform, std::uint8_t mark) {
            ++uses_;
            for (const std::uint32_t part : node.parts) {
                add(node, scene_.parts[part], transform, mark);
            }
            return true;
        });
        return finish();
    }

    Result<TriangleMesh> runLevel() {
        RELIEF_TRY(prepare());
        for (const Use& use : uses()) {
            RELIEF_TRY(place(use));
        }
        return finish();
    }

  private:
    enum class State : std::uint8_t { kUnseen, kOpen, kEmpty, kShown };

    /// A node of a level, or several nodes with the same index.
    struct Use {
        const SceneNode* node;
        std::vector<std::uint32_t> parts;
        Transform transform;
        std::uint8_t mark;
    };
    /// Identifies a mesh: its parts, its mark, the linear transform applied to it (columns), and its node's response.
    using MeshKey = std::tuple<std::vector<std::uint32_t>, std::uint8_t, std::array<double, 9>,
                               std::optional<SurfaceResponse>>;

    Result<void> prepare() {
        states_.resize(scene_.nodes.size());
        placed_.resize(scene_.parts.size());
        for (const std::uint32_t root : scene_.roots) {
            static_cast<void>(RELIEF_TRY(findShown(root)));
        }
        mesh_.warnings = std::move(scene_.warnings);
        RELIEF_TRY(countParts());
        const ImportOptions& options = job_.options;
        RELIEF_TRY(checkFrame(scene_.frame, options.unit, options.up));
        const FrameChange change = changeOf(scene_.frame, options.unit, options.up);
        mesh_.unit = change.unit;
        mesh_.warnings.insert(mesh_.warnings.end(), change.warnings.begin(), change.warnings.end());
        root_.linear = change.scale * change.turn;
        return {};
    }

    Result<TriangleMesh> finish() {
        if (mesh_.triangles.empty()) {
            return noTriangles(left_out_.any());
        }
        left_out_.warn(mesh_.warnings);
        RELIEF_TRY(marks_.checkAllFound());
        dropSingleLabel(mesh_);
        if (flat_ > 0) {
            mesh_.warnings.push_back(std::to_string(flat_) +
                                     " of its parts are scaled to 0 in some direction and have no volume");
        }
        return std::move(mesh_);
    }

    /// Merges nodes with the same index: the runs of an OBJ group.
    std::vector<Use> uses() {
        std::vector<Use> all;
        std::map<std::pair<std::uint32_t, std::uint8_t>, std::size_t> known;
        forEachUse([&](const SceneNode& node, const Transform& transform, std::uint8_t mark) {
            if (node.index) {
                const auto [found, added] = known.try_emplace({*node.index, mark}, all.size());
                if (!added) {
                    Use& use = all[found->second];
                    use.parts.insert(use.parts.end(), node.parts.begin(), node.parts.end());
                    return true;
                }
            }
            all.push_back({&node, node.parts, transform, mark});
            return true;
        });
        return all;
    }

    /// Adds a body, and its mesh if it is new.
    Result<void> place(const Use& use) {
        if (mesh_.level_bodies.size() == kLevelBodiesMax) {
            return fail(ErrorCode::kLimit, "it places more than " + std::to_string(kLevelBodiesMax) +
                                               " meshes; join some, or bake it in parts");
        }
        // Meshes are stored in the frame of the world, so a pose maps that frame to itself.
        const glm::dmat3 turned = use.transform.linear * glm::inverse(root_.linear);
        glm::dmat3 applied(1.0);
        std::optional<RigidPose> pose = rigidPose(turned);
        if (!pose) {
            const glm::dmat3 mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
            pose = rigidPose(turned * mirror);
            applied = pose ? mirror : turned;
        }
        const RigidPose rigid = pose.value_or(RigidPose{{0.0, 0.0, 0.0, 1.0}, 1.0});
        if (!isPlaced(use.transform.offset, rigid.scale)) {
            return invalidInput(
                "the node '" + cleanUtf8(use.node->shown, kSelectedNameBytesMax) +
                "' is beyond 1e15, or its scale is not between 1e-9 and 1e9; fix its transform");
        }
        const std::uint32_t mesh = RELIEF_TRY(meshOf(use, applied));
        const glm::dvec3& at = use.transform.offset;
        mesh_.level_bodies.push_back(
            {mesh, use.node->shown, {at.x, at.y, at.z}, rigid.rotation, rigid.scale});
        return {};
    }

    Result<std::uint32_t> meshOf(const Use& use, const glm::dmat3& applied) {
        std::array<double, 9> columns{};
        std::copy_n(&applied[0][0], 9, columns.begin());
        const auto next = static_cast<std::uint32_t>(mesh_.level_meshes.size());
        const auto [found, added] =
            meshes_.try_emplace({use.parts, use.mark, columns, use.node->response}, next);
        if (!added) {
            return found->second;
        }
        const Transform transform{applied * root_.linear, glm::dvec3(0.0)};
        if (!count(use.parts, transform)) {
            return tooManyTriangles(job_);
        }
        if (next == kLevelMeshesMax) {
            return fail(ErrorCode::kLimit,
                        "it has more than " + std::to_string(kLevelMeshesMax) +
                            " distinct meshes, counting a mesh once for each non-uniform scale; join some");
        }
        LevelMesh mesh{use.node->shown, mesh_.positions.size(), mesh_.triangles.size()};
        for (const std::uint32_t part : use.parts) {
            const std::vector<std::string>& names = scene_.parts[part].names;
            if (part == use.parts.front() && !names.empty() && !names.front().empty()) {
                mesh.name = names.front();
            }
            add(*use.node, scene_.parts[part], transform, use.mark,
                static_cast<std::uint32_t>(mesh.positions));
        }
        mesh.positions = mesh_.positions.size() - mesh.positions;
        mesh.triangles = mesh_.triangles.size() - mesh.triangles;
        mesh_.level_meshes.push_back(std::move(mesh));
        ++uses_;
        return next;
    }

    [[nodiscard]] bool hasTriangles(const SceneNode& node) const {
        return std::ranges::any_of(
            node.parts, [this](std::uint32_t part) { return !scene_.parts[part].triangles.empty(); });
    }

    /// Returns whether a node or a descendant has triangles. Recursive; importers run on a deep stack.
    Result<bool> findShown(std::uint32_t index) {
        if (states_[index] == State::kOpen) {
            return invalidInput("an object contains itself; export it again");
        }
        if (states_[index] == State::kUnseen) {
            states_[index] = State::kOpen;
            const SceneNode& node = scene_.nodes[index];
            for (const std::uint32_t part : node.parts) {
                placed_[part] = true;
            }
            bool shown = hasTriangles(node);
            for (const std::uint32_t child : node.children) {
                shown = RELIEF_TRY(findShown(child)) || shown;
            }
            states_[index] = shown ? State::kShown : State::kEmpty;
        }
        return states_[index] == State::kShown;
    }

    Result<void> countParts() {
        MeshParts& counts = scene_.counts;
        const bool counted = counts.meshes > 0;
        for (std::size_t i = 0; i < scene_.parts.size() && !counted; ++i) {
            const bool filled = !scene_.parts[i].triangles.empty();
            counts.meshes += filled ? 1 : 0;
            counts.unplaced += filled && !placed_[i] ? 1 : 0;
        }
        if (const std::optional<std::string> refusal = partsError(counts)) {
            return invalidInput(*refusal);
        }
        mesh_.unused_vertices = counts.unused;
        warnAboutParts(counts, mesh_.warnings);
        return {};
    }

    /// Calls visit(node, transform of its parts, mark) for nodes with triangles, parents first, until it returns false.
    /// \return whether all nodes were visited.
    template <class Visit>
    bool forEachUse(const Visit& visit) {
        struct Pending {
            std::uint32_t node;
            Transform parent;
            std::uint8_t mark;
        };
        std::vector<Pending> pending;
        const auto push = [&](const std::vector<std::uint32_t>& nodes, const Transform& parent,
                              std::uint8_t mark) {
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
                if (states_[*node] == State::kShown) {
                    pending.push_back({*node, parent, mark});
                }
            }
        };
        left_out_ = {};
        push(scene_.roots, root_, 0);
        while (!pending.empty()) {
            const Pending next = pending.back();
            pending.pop_back();
            const SceneNode& node = scene_.nodes[next.node];
            const Transform transform = node.transform ? next.parent * *node.transform : next.parent;
            const bool skips =
                hasTriangles(node) && left_out_.leaveOut(node.is_shown, node.shown, job_.options.hidden);
            const std::uint8_t mark = skips ? next.mark : std::max(next.mark, marks_.record(node.names));
            if (!skips && !node.parts.empty() && !visit(node, node.posed ? root_ : transform, mark)) {
                return false;
            }
            push(node.children, transform, mark);
        }
        return true;
    }

    bool count(const std::vector<std::uint32_t>& parts, const Transform& transform) {
        for (const std::uint32_t part : parts) {
            triangles_ += scene_.parts[part].triangles.size();
            vertices_ += scene_.parts[part].triangles.empty() ? 0 : scene_.parts[part].positions.size();
            flat_ += transform.flattens() ? 1 : 0;
        }
        return triangles_ <= job_.triangle_max && vertices_ <= 3 * job_.triangle_max;
    }

    /// Adds a part; mirroring transforms flip its triangles. \param first  index of the position that becomes index 0.
    void add(const SceneNode& node, const ScenePart& part, const Transform& transform, std::uint8_t mark,
             std::uint32_t first = 0) {
        if (part.triangles.empty()) {
            return;
        }
        const auto base = static_cast<std::uint32_t>(mesh_.positions.size()) - first;
        for (const glm::vec3& position : part.positions) {
            mesh_.positions.emplace_back(transform.apply(position));
        }
        const bool mirrors = transform.mirrors();
        for (const glm::uvec3& t : part.triangles) {
            mesh_.triangles.emplace_back(base + t.x, base + (mirrors ? t.z : t.y),
                                         base + (mirrors ? t.y : t.z));
        }
        mesh_.marks.resize(marks_.any() ? mesh_.triangles.size() : 0,
                           std::max(mark, marks_.record(part.names)));
        const SurfaceResponse response = node.response.value_or(SurfaceResponse());
        mesh_.labels.resize(
            mesh_.triangles.size(),
            labelOf({node.index.value_or(uses_), cleanUtf8(node.shown, kSelectedNameBytesMax),
                     cleanUtf8(part.material.empty() ? response.name : part.material, kSelectedNameBytesMax),
                     response.restitution, response.friction}));
    }

    std::uint32_t labelOf(const SurfaceName& name) {
        std::vector<SurfaceName>& names = mesh_.surface_names;
        const auto next = static_cast<std::uint32_t>(names.size());
        if (const auto found = labels_.find(name); found != labels_.end() || next == kSurfaceNamesMax) {
            return found != labels_.end() ? found->second : kSurfaceNamesMax - 1;
        }
        names.push_back(next + 1 < kSurfaceNamesMax ? name : SurfaceName());
        return labels_[name] = next;
    }

    ImportScene scene_;
    const ImportJob& job_;
    NameMarks marks_;
    Transform root_;
    SkippedObjects left_out_;
    std::vector<State> states_;  // by node
    std::vector<bool> placed_;   // by part
    TriangleMesh mesh_;
    std::uint64_t vertices_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t flat_ = 0;
    std::uint32_t uses_ = 0;
    std::map<SurfaceName, std::uint32_t> labels_;  // index into TriangleMesh::surface_names
    std::map<MeshKey, std::uint32_t> meshes_;      // index into TriangleMesh::level_meshes
};

}  // namespace

Result<TriangleMesh> flatten(ImportScene scene, const ImportJob& job) {
    return Flattener(std::move(scene), job).run();
}

Result<TriangleMesh> flattenLevel(ImportScene scene, const ImportJob& job) {
    return Flattener(std::move(scene), job).runLevel();
}

}  // namespace relief
