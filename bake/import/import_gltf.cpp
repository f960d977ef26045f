#include "bake/import/import_gltf.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/import/gltf_buffers.h"
#include "bake/import/gltf_json.h"
#include "bake/import/gltf_meshes.h"
#include "bake/import/gltf_nodes.h"
#include "bake/import/gltf_skin.h"
#include "bake/import/import_instances.h"
#include "bake/import/import_names.h"
#include "bake/import/import_parts.h"
#include "bake/import/polygon_mesh.h"
#include "formats/base/text.h"

namespace relief {
namespace {

// Required extensions that are read, or that change no position.
constexpr std::array<std::string_view, 9> kKnown = {
    "KHR_mesh_quantization", "KHR_draco_mesh_compression", "KHR_texture_transform",
    "KHR_technique_webgl",   "KHR_techniques_webgl",       "KHR_texture_basisu",
    "KHR_lights_punctual",   "EXT_texture_webp",           "MSFT_texture_dds"};

/// "2.0" -> 2, 0; nullopt for what is no version.
std::optional<std::pair<std::uint64_t, std::uint64_t>> versionOf(std::string_view text) {
    const std::vector<std::string_view> parts = split(text, '.');
    const std::optional<std::uint64_t> major = parseUnsigned(parts[0]);
    const std::optional<std::uint64_t> minor = parts.size() == 2 ? parseUnsigned(parts[1]) : std::nullopt;
    return major && minor ? std::optional(std::pair(*major, *minor)) : std::nullopt;
}

Result<void> checkVersion(const GltfValue& document) {
    const std::optional<GltfValue> asset = RELIEF_TRY(document.object("asset"));
    const std::optional<std::string> version = asset ? RELIEF_TRY(asset->text("version")) : std::nullopt;
    if (!version) {
        return invalidInput("it names no glTF version");
    }
    const std::string least = RELIEF_TRY(asset->text("minVersion")).value_or("2.0");
    const std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [text, minor_max] : {std::pair(*version, any), std::pair(least, std::uint64_t{0})}) {
        const auto number = versionOf(text);
        if (!number) {
            return asset->wrong("has '" + cleanUtf8(text, 20) +
                                "' where a version belongs; save it as glTF 2.0");
        }
        if (number->first != 2 || number->second > minor_max) {
            return fail(ErrorCode::kUnsupported,
                        "glTF of version '" + cleanUtf8(text, 20) + "' is not read; save it as glTF 2.0");
        }
    }
    return {};
}

Result<void> checkExtensions(const GltfValue& document, std::vector<std::string>& warnings) {
    for (const std::string& name : RELIEF_TRY(document.texts("extensionsRequired"))) {
        const bool known = name.starts_with("KHR_materials_") || name.starts_with("KHR_xmp") ||
                           std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
        if (!known) {
            return fail(ErrorCode::kUnsupported, "it requires the extension '" + cleanUtf8(name, 100) +
                                                     "', which is not read; export it without");
        }
    }
    // Optional extensions that change the surface.
    for (const std::string& name : RELIEF_TRY(document.texts("extensionsUsed"))) {
        if (name == "EXT_mesh_gpu_instancing") {
            warnings.emplace_back("instances by EXT_mesh_gpu_instancing are left out; export them as nodes");
        } else if (name == "KHR_node_visibility") {
            warnings.emplace_back(
                "nodes that KHR_node_visibility hides are baked too; export it without them");
        }
    }
    return {};
}

/// A node that shows a mesh.
struct Use {
    std::uint64_t node;
    std::uint64_t mesh;
    std::optional<std::uint64_t> skin;
    Transform transform;
};

/// All uses below the roots, parents before children. No recursion.
std::vector<Use> usesOf(const std::vector<GltfNode>& nodes, const std::vector<std::uint64_t>& roots,
                        const Transform& root) {
    std::vector<Use> uses;
    std::vector<std::pair<std::uint64_t, Transform>> pending;
    const auto push = [&pending](const std::vector<std::uint64_t>& below, const Transform& parent) {
        for (auto it = below.rbegin(); it != below.rend(); ++it) {
            pending.emplace_back(*it, parent);
        }
    };
    push(roots, root);
    while (!pending.empty()) {
        const auto [index, parent] = pending.back();
        pending.pop_back();
        const GltfNode& node = nodes[index];
        const Transform transform = parent * node.transform;
        if (node.mesh) {
            uses.push_back({index, *node.mesh, node.skin, node.skin ? root : transform});
        }
        push(node.children, transform);
    }
    return uses;
}

/// Marks of triangles by their names.
class GltfNames {
  public:
    /// \param nodes  borrowed, and so is the job.
    GltfNames(const std::vector<GltfNode>& nodes, const ImportJob& job)
        : nodes_(nodes),
          marks_(job.options.names, job.file_name),
          of_node_(marks_.any() ? nodes.size() : 0) {}

    [[nodiscard]] const NameMarks& marks() const { return marks_; }

    std::uint8_t of(std::uint64_t node, const GltfMesh& mesh, const GltfPrimitive& primitive) {
        if (!marks_.any()) {
            return 0;
        }
        std::vector<std::uint64_t> chain;
        std::optional<std::uint64_t> above = node;
        for (; above && !of_node_[*above]; above = nodes_[*above].parent) {
            chain.push_back(*above);
        }
        std::uint8_t mark = above ? *of_node_[*above] : std::uint8_t{0};
        for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
            mark = std::max(mark, marks_.meet(nodes_[*it].name));
            of_node_[*it] = mark;
        }
        mark = std::max(mark, marks_.meet(mesh.name));
        return std::max(mark, marks_.meet(primitive.material));
    }

  private:
    const std::vector<GltfNode>& nodes_;
    NameMarks marks_;
    std::vector<std::optional<std::uint8_t>> of_node_;  // with those above it
};

std::vector<glm::uvec3> turned(std::vector<glm::uvec3> triangles) {
    for (glm::uvec3& t : triangles) {
        std::swap(t.y, t.z);
    }
    return triangles;
}

/// All that is wrong with the document, or its mesh. Errors of this class name no file: readGltf does.
class GltfReader {
  public:
    GltfReader(const ImportJob& job, ImportFiles& files, const glm::dmat3& linear)
        : job_(job), files_(files), root_{linear, glm::dvec3(0.0)} {}

    Result<void> open() {
        chunks_ = RELIEF_TRY(gltfChunks(job_.bytes));
        json_ = RELIEF_TRY(parseGltfJson(chunks_.json));
        const GltfValue document(json_);
        if (!document.isObject()) {
            return invalidInput("its JSON is no object");
        }
        warnings_ = chunks_.warnings;
        RELIEF_TRY(checkVersion(document));
        RELIEF_TRY(checkExtensions(document, warnings_));
        GltfBuffers buffers = RELIEF_TRY(GltfBuffers::open(document, chunks_, files_));
        nodes_ = RELIEF_TRY(readGltfNodes(document));
        const std::vector<std::uint64_t> roots = RELIEF_TRY(gltfRoots(document, nodes_));
        uses_ = usesOf(nodes_, roots, root_);
        RELIEF_TRY(readMeshes(document, buffers));
        return {};
    }

    /// Behind open().
    Result<TriangleMesh> flatten(TriangleMesh mesh) {
        mesh.warnings.insert(mesh.warnings.end(), warnings_.begin(), warnings_.end());
        mesh.unused_vertices = parts_.unused;
        MeshInstances instances(job_.shown, job_.triangle_max, std::move(mesh));
        for (const Use& use : uses_) {
            for (const GltfPrimitive& part : meshes_.at(use.mesh).primitives) {
                if (!instances.count(part.positions.size(), part.triangles.size(), use.transform)) {
                    return instances.tooMany();
                }
            }
        }
        GltfNames names(nodes_, job_);
        instances.begin(names.marks().any());
        for (const Use& use : uses_) {
            const GltfMesh& source = meshes_.at(use.mesh);
            for (const GltfPrimitive& part : source.primitives) {
                const std::uint8_t mark = names.of(use.node, source, part);
                instances.surface(
                    {static_cast<std::uint32_t>(use.node), nodes_[use.node].name, part.material});
                if (use.skin && part.influences) {
                    const GltfPose pose = posed(part.positions, *part.influences, skins_.at(*use.skin));
                    instances.add(pose.positions, pose.mirrored ? turned(part.triangles) : part.triangles,
                                  use.transform, mark);
                } else {
                    instances.add(part.positions, part.triangles, use.transform, mark);
                }
            }
        }
        return instances.finish(names.marks());
    }

  private:
    /// Those that are shown.
    Result<void> readMeshes(const GltfValue& document, GltfBuffers& buffers) {
        const GltfList list = RELIEF_TRY(document.objects("meshes"));
        GltfMeshes meshes(document, buffers, job_.triangle_max);
        std::set<std::uint64_t> skinned;
        for (const Use& use : uses_) {
            if (use.skin) {
                skinned.insert(use.mesh);
            }
        }
        for (const Use& use : uses_) {
            if (!meshes_.contains(use.mesh)) {
                const GltfValue place = RELIEF_TRY(list.at(use.mesh));
                meshes_[use.mesh] = RELIEF_TRY(meshes.read(place, skinned.contains(use.mesh)));
            }
        }
        const std::uint64_t unplaced = list.size() - meshes_.size();
        parts_ = meshes.parts();
        if (const std::optional<std::string> refusal = partsRefusal(parts_)) {
            return invalidInput(*refusal);
        }
        warnings_.insert(warnings_.end(), meshes.warnings().begin(), meshes.warnings().end());
        RELIEF_TRY(readSkins(document, buffers));
        if (unplaced > 0) {
            warnings_.push_back("left out " + std::to_string(unplaced) + " of its " +
                                std::to_string(list.size()) + " meshes: its scene does not show them");
        }
        warnOfParts(parts_, warnings_);
        return {};
    }

    /// Those of meshes that are shown.
    Result<void> readSkins(const GltfValue& document, GltfBuffers& buffers) {
        bool whole = true;
        std::set<std::pair<std::uint64_t, std::uint64_t>> seen;
        for (const Use& use : uses_) {
            if (!use.skin || !seen.insert({use.mesh, *use.skin}).second) {
                continue;
            }
            if (!skins_.contains(*use.skin)) {
                skins_[*use.skin] = RELIEF_TRY(readSkin(document, *use.skin, nodes_, buffers));
            }
            const std::size_t joints = skins_[*use.skin].size();
            for (const GltfPrimitive& part : meshes_.at(use.mesh).primitives) {
                whole = whole && part.influences;
                const auto lost = [joints](const GltfInfluence& by) {
                    return by.weight > 0.0F && by.joint >= joints;
                };
                if (part.influences &&
                    std::any_of(part.influences->all.begin(), part.influences->all.end(), lost)) {
                    return invalidInput("meshes[" + std::to_string(use.mesh) +
                                        "] has vertices that are moved by a joint which its skin, skins[" +
                                        std::to_string(*use.skin) + "], does not have");
                }
            }
        }
        if (!skins_.empty()) {
            warnings_.emplace_back(
                whole ? "it is skinned; baked in the pose that its nodes have"
                      : "it is skinned; parts without joints, or compressed by Draco, are baked as "
                        "they are modelled, without their skeleton");
        }
        return {};
    }

    const ImportJob& job_;
    ImportFiles& files_;
    Transform root_;
    GltfChunks chunks_;
    nlohmann::json json_;
    std::vector<GltfNode> nodes_;
    std::vector<Use> uses_;
    std::map<std::uint64_t, GltfMesh> meshes_;
    std::map<std::uint64_t, std::vector<Transform>> skins_;  // what their joints do
    MeshParts parts_;
    std::vector<std::string> warnings_;
};

}  // namespace

Result<TriangleMesh> readGltf(const ImportJob& job, ImportFiles& files, const glm::dmat3& linear,
                              TriangleMesh mesh) {
    GltfReader reader(job, files, linear);
    if (const Result<void> opened = reader.open(); !opened) {
        return unreadable(job.shown, opened.error());
    }
    return reader.flatten(std::move(mesh));
}

}  // namespace relief
