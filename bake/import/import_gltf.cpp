#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/import/gltf_data.h"
#include "bake/import/gltf_json.h"
#include "bake/import/import_readers.h"
#include "formats/base/text.h"

namespace relief {
namespace {

// --- the document ---

// Required extensions that are read or do not change positions.
constexpr std::array<std::string_view, 9> kKnown = {
    "KHR_mesh_quantization", "KHR_texture_transform", "KHR_technique_webgl",
    "KHR_techniques_webgl",  "KHR_texture_basisu",    "KHR_lights_punctual",
    "EXT_texture_webp",      "MSFT_texture_dds",      "EXT_mesh_gpu_instancing"};

Result<void> checkVersion(const GltfValue& document) {
    const std::optional<GltfValue> asset = RELIEF_TRY(document.object("asset"));
    const auto version = asset ? RELIEF_TRY(asset->get<std::string>("version")) : std::nullopt;
    if (!version) {
        return invalidInput("it names no glTF version");
    }
    const std::string least = RELIEF_TRY(asset->get<std::string>("minVersion", "2.0"));
    for (const auto& [text, any_minor] : {std::pair(*version, true), std::pair(least, false)}) {
        const std::vector<std::string_view> parts = split(text, '.');
        const std::optional<std::uint64_t> major = parseUnsigned(parts[0]);
        const std::optional<std::uint64_t> minor = parts.size() == 2 ? parseUnsigned(parts[1]) : std::nullopt;
        if (!major || !minor) {
            return asset->wrong("has '" + cleanUtf8(text, 20) +
                                "' where a version belongs; save it as glTF 2.0");
        }
        if (*major != 2 || (*minor > 0 && !any_minor)) {
            return fail(ErrorCode::kUnsupported,
                        "glTF of version '" + cleanUtf8(text, 20) + "' is not read; save it as glTF 2.0");
        }
    }
    return {};
}

Result<void> checkExtensions(const GltfValue& document, std::vector<std::string>& warnings) {
    using Names = std::vector<std::string>;
    for (const std::string& name : RELIEF_TRY(document.get<Names>("extensionsRequired", {}))) {
        const bool known = name.starts_with("KHR_materials_") || name.starts_with("KHR_xmp") ||
                           std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
        if (!known) {
            return fail(ErrorCode::kUnsupported, "it requires the extension '" + cleanUtf8(name, 100) +
                                                     "', which is not read; export it without");
        }
    }
    // Optional extensions that change the surface.
    for (const std::string& name : RELIEF_TRY(document.get<Names>("extensionsUsed", {}))) {
        if (name == "KHR_node_visibility") {
            warnings.emplace_back(
                "nodes that KHR_node_visibility hides are baked too; export it without them");
        }
    }
    return {};
}

// --- nodes ---

/// Tolerance of a rotation's length, as in the Khronos validator: the rounding of bytes.
constexpr double kUnitTolerance = 0.00674;
/// Of EXT_mesh_gpu_instancing, in a whole file.
constexpr std::uint64_t kInstancesMax = 1'000'000;
/// Tolerance of the last row of a matrix, 0 0 0 1.
constexpr float kRowTolerance = 1e-5F;

/// \param m  16 numbers, by columns. \return nullopt if its last row is not 0 0 0 1.
std::optional<Transform> affine(const float* m) {
    for (const int i : {3, 7, 11, 15}) {
        if (!(std::abs(m[i] - (i == 15 ? 1.0F : 0.0F)) <= kRowTolerance)) {
            return std::nullopt;
        }
    }
    return Transform{glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
                     {m[12], m[13], m[14]}};
}

glm::dmat3 rotationOf(const glm::dvec3& v, double w) {
    const double x = v.x;
    const double y = v.y;
    const double z = v.z;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

/// First scaled, then turned, then moved. \param node  for messages.
Result<Transform> placedBy(const GltfValue& node, const glm::vec3& t, const glm::vec4& q,
                           const glm::vec3& scale) {
    const double length =
        std::sqrt(double{q.x} * q.x + double{q.y} * q.y + double{q.z} * q.z + double{q.w} * q.w);
    if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
        return node.wrong("has a rotation that is no unit quaternion: its length is " +
                          shortest(static_cast<float>(length)));
    }
    Transform transform{rotationOf(glm::dvec3(q.x, q.y, q.z) / length, q.w / length), t};
    for (int i = 0; i < 3; ++i) {
        transform.linear[i] *= double{scale[i]};
    }
    return transform;
}

Result<Transform> transformOf(const GltfValue& node) {
    const std::vector<float> matrix = RELIEF_TRY(node.numbers("matrix", 16));
    const std::vector<float> t = RELIEF_TRY(node.numbers("translation", 3));
    const std::vector<float> q = RELIEF_TRY(node.numbers("rotation", 4));
    const std::vector<float> scale = RELIEF_TRY(node.numbers("scale", 3));
    if (!matrix.empty()) {
        if (!t.empty() || !q.empty() || !scale.empty()) {
            return node.wrong("has a matrix and a translation, rotation or scale; only one may be");
        }
        const std::optional<Transform> transform = affine(matrix.data());
        return transform ? Result<Transform>(*transform)
                         : node.wrong("has a matrix whose last row is not 0 0 0 1 (is it transposed?)");
    }
    return placedBy(node, t.empty() ? glm::vec3(0.0F) : glm::vec3(t[0], t[1], t[2]),
                    q.empty() ? glm::vec4(0, 0, 0, 1) : glm::vec4(q[0], q[1], q[2], q[3]),
                    scale.empty() ? glm::vec3(1.0F) : glm::vec3(scale[0], scale[1], scale[2]));
}

// --- primitives ---

enum Mode : std::uint64_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kStrip, kFan };
constexpr std::uint8_t kByTriangle = 1;
constexpr std::uint8_t kByOther = 2;
constexpr std::uint64_t kJointsMax = 65536;
/// Sets of joints: a vertex has at most sixteen.
constexpr std::size_t kSetsMax = 4;

std::uint64_t linesOf(std::uint64_t mode, std::uint64_t corners) {
    return mode == kLines ? corners / 2 : corners < 2 ? 0 : mode == kLineLoop ? corners : corners - 1;
}

/// The corners of a triangle, by number in its primitive. Every other triangle of a strip is flipped.
glm::uvec3 cornersOf(std::uint64_t mode, std::uint32_t i) {
    return mode == kFan         ? glm::uvec3(0, i + 1, i + 2)
           : mode == kTriangles ? glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2)
           : i % 2 == 0         ? glm::uvec3(i, i + 1, i + 2)
                                : glm::uvec3(i + 1, i, i + 2);
}

/// A joint that moves a vertex.
struct Influence {
    std::uint32_t joint;
    float weight;  ///< 0 or more
};

/// The joints of a primitive's vertices.
struct Influences {
    std::size_t per_vertex = 0;
    std::vector<Influence> all;  ///< per_vertex for each vertex, whose weights have a sum above 0
};

/// Whether the weights of every vertex are 0 or more, and have a sum above 0.
bool weigh(const Influences& influences) {
    for (std::size_t at = 0; at < influences.all.size(); at += influences.per_vertex) {
        double sum = 0.0;
        for (std::size_t k = at; k < at + influences.per_vertex; ++k) {
            const float weight = influences.all[k].weight;
            sum += weight >= 0.0F && weight <= 1e6F ? double{weight} : std::nan("");
        }
        if (!(sum >= 1e-6)) {
            return false;
        }
    }
    return true;
}

/// Reads JOINTS_0, WEIGHTS_0, JOINTS_1, … \param vertices  as many as the primitive has.
/// \return nullopt where there are none.
Result<std::optional<Influences>> readInfluences(const GltfValue& attributes, GltfBuffers& buffers,
                                                 std::uint64_t vertices) {
    std::vector<std::pair<std::vector<glm::vec4>, std::vector<glm::vec4>>> sets;
    for (std::size_t i = 0; i < kSetsMax; ++i) {
        const std::string joints = "JOINTS_" + std::to_string(i);
        const std::string weights = "WEIGHTS_" + std::to_string(i);
        const auto of_joints = RELIEF_TRY(attributes.named(joints.c_str(), "accessors"));
        const auto of_weights = RELIEF_TRY(attributes.named(weights.c_str(), "accessors"));
        if (!of_joints && !of_weights) {
            break;
        }
        if (!of_joints || !of_weights) {
            return attributes.wrong("have only one of " + joints + " and " + weights);
        }
        auto& [joint, weight] = sets.emplace_back();
        joint = RELIEF_TRY(readAccessor<glm::vec4>(*of_joints, GltfUse::kJoints, buffers, vertices));
        weight = RELIEF_TRY(readAccessor<glm::vec4>(*of_weights, GltfUse::kWeights, buffers, vertices));
        if (joint.size() != vertices || weight.size() != vertices) {
            return attributes.wrong("have other counts of " + joints + ", " + weights + " and positions");
        }
    }
    if (sets.empty()) {
        return std::nullopt;
    }
    Influences influences{4 * sets.size(), {}};
    for (std::uint64_t vertex = 0; vertex < vertices; ++vertex) {
        for (const auto& [joint, weight] : sets) {
            for (int k = 0; k < 4; ++k) {
                influences.all.push_back({static_cast<std::uint32_t>(joint[vertex][k]), weight[vertex][k]});
            }
        }
    }
    return weigh(influences)
               ? Result<std::optional<Influences>>(std::move(influences))
               : attributes.wrong(
                     "have weights that are less than 0, no numbers, or 0 for all joints of a vertex");
}

/// The part in that pose, flipped if most of it is mirrored.
ScenePart posed(ScenePart part, const Influences& influences, const std::vector<Transform>& joints) {
    double mirrored = 0.0;
    std::vector<bool> mirrors;
    for (const Transform& joint : joints) {
        mirrors.push_back(joint.mirrors());
    }
    const Influence* by = influences.all.data();
    for (glm::vec3& position : part.positions) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t k = 0; k < influences.per_vertex; ++k, ++by) {
            if (by->weight > 0.0F) {
                sum += double{by->weight} * joints[by->joint].apply(position);
                weights += double{by->weight};
                mirrored += mirrors[by->joint] ? double{by->weight} : -double{by->weight};
            }
        }
        position = sum / weights;
    }
    for (glm::uvec3& t : part.triangles) {
        t = mirrored > 0.0 ? glm::uvec3(t.x, t.z, t.y) : t;
    }
    return part;
}

class GltfReader {
  public:
    GltfReader(const ImportJob& job, const GltfChunks& chunks, const GltfValue& document, ImportFiles& files)
        : triangle_max_(job.triangle_max), document_(document), buffers_(chunks, files) {}

    Result<ImportScene> run() {
        scene_.frame = {1.0, UpAxis::kPlusY};
        RELIEF_TRY(checkVersion(document_));
        RELIEF_TRY(checkExtensions(document_, scene_.warnings));
        RELIEF_TRY(readNodes());
        RELIEF_TRY(readRoots());
        RELIEF_TRY(readShown());
        for (const auto& [key, vertices] : vertices_) {
            scene_.counts.vertices += vertices.uses.size();
            for (const std::uint8_t use : vertices.uses) {
                scene_.counts.unused += (use & kByTriangle) == 0 ? 1 : 0;
                scene_.counts.loose += use == 0 ? 1 : 0;
            }
        }
        if (!skins_.empty()) {
            warn(all_jointed_ ? "it is skinned; baked in the pose that its nodes have"
                              : "it is skinned; parts without joints are baked as they are modelled, without "
                                "their skeleton");
        }
        return std::move(scene_);
    }

  private:
    /// The members of a node that SceneNode lacks.
    struct Node {
        GltfValue place;
        std::optional<std::uint32_t> parent{};
        std::optional<GltfValue> mesh{};
        std::optional<GltfValue> skin{};
    };
    struct Primitive {
        ScenePart part;
        std::optional<Influences> influences;  ///< of the part's positions; read only for skins
        std::map<std::uint64_t, std::uint32_t>
            placed;  ///< index of a scene's part, by skin + 1, or 0 for none
    };
    /// Identifies the vertices of an accessor: exporters make many accessors of one view.
    using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, bool, std::uint64_t>;
    struct Vertices {
        std::vector<glm::vec3> positions;
        std::vector<std::uint8_t> uses;
    };

    void warn(const std::string& text) {
        if (std::find(scene_.warnings.begin(), scene_.warnings.end(), text) == scene_.warnings.end()) {
            scene_.warnings.push_back(text);
        }
    }

    Result<void> readNodes() {
        const std::vector<GltfValue> places = RELIEF_TRY(document_.objects("nodes"));
        for (const GltfValue& place : places) {
            nodes_.push_back({place});
        }
        scene_.nodes.resize(places.size());
        for (const GltfValue& place : places) {
            const auto index = static_cast<std::uint32_t>(place.index());
            SceneNode& node = scene_.nodes[index];
            node.index = index;
            node.shown = RELIEF_TRY(place.get<std::string>("name", ""));
            node.names = {node.shown};
            node.transform = RELIEF_TRY(transformOf(place));
            nodes_[index].mesh = RELIEF_TRY(place.named("mesh", "meshes"));
            nodes_[index].skin = RELIEF_TRY(place.named("skin", "skins"));
            for (const std::uint64_t child :
                 RELIEF_TRY(place.get<std::vector<std::uint64_t>>("children", {}))) {
                const std::string name = "nodes[" + std::to_string(child) + "]";
                if (child >= places.size()) {
                    return place.wrong("names a child, " + name + ", that does not exist");
                }
                // n nodes could show it 2ⁿ times.
                if (std::exchange(nodes_[child].parent, index)) {
                    return invalidInput(name + " has two parents; nodes must form trees");
                }
                node.children.push_back(static_cast<std::uint32_t>(child));
            }
        }
        // Each node has at most one parent, so a node that no root reaches is part of a ring.
        std::vector<std::uint32_t> open;
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (!nodes_[i].parent) {
                open.push_back(i);
            }
        }
        std::size_t reached = 0;
        for (; !open.empty(); ++reached) {
            const std::vector<std::uint32_t>& children = scene_.nodes[open.back()].children;
            open.pop_back();
            open.insert(open.end(), children.begin(), children.end());
        }
        return reached == nodes_.size()
                   ? Result<void>()
                   : invalidInput("its nodes are their own parents; nodes must form trees");
    }

    /// Of the scene that the file shows: the first by default.
    Result<void> readRoots() {
        const std::vector<GltfValue> scenes = RELIEF_TRY(document_.objects("scenes"));
        const std::uint64_t shown = RELIEF_TRY(document_.get<std::uint64_t>("scene", 0));
        if (scenes.empty()) {
            return invalidInput("it has no scene, and so shows nothing; export it with a scene");
        }
        const GltfValue scene = RELIEF_TRY(document_.at(shown, "scenes", "scene"));
        std::set<std::uint64_t> seen;
        for (const std::uint64_t root : RELIEF_TRY(scene.get<std::vector<std::uint64_t>>("nodes", {}))) {
            if (root >= nodes_.size() || nodes_[root].parent || !seen.insert(root).second) {
                return scene.wrong("names nodes[" + std::to_string(root) +
                                   "], which does not exist, has a parent or is named twice");
            }
            scene_.roots.push_back(static_cast<std::uint32_t>(root));
        }
        return {};
    }

    /// The meshes of the nodes below the roots, in the order in which the scene shows them.
    Result<void> readShown() {
        std::vector<std::uint32_t> shown;
        std::set<std::uint64_t> skinned;
        std::vector<std::uint32_t> pending(scene_.roots.rbegin(), scene_.roots.rend());
        while (!pending.empty()) {
            const std::uint32_t index = pending.back();
            pending.pop_back();
            const std::vector<std::uint32_t>& children = scene_.nodes[index].children;
            pending.insert(pending.end(), children.rbegin(), children.rend());
            if (nodes_[index].mesh) {
                shown.push_back(index);
                if (nodes_[index].skin) {
                    skinned.insert(nodes_[index].mesh->index());
                }
            }
        }
        for (const std::uint32_t index : shown) {
            const GltfValue& mesh = *nodes_[index].mesh;
            if (!meshes_.contains(mesh.index())) {
                RELIEF_TRY(readMesh(mesh, skinned.contains(mesh.index())));
            }
        }
        for (const std::uint32_t index : shown) {
            RELIEF_TRY(placeMesh(nodes_[index], scene_.nodes[index]));
            RELIEF_TRY(placeInstances(nodes_[index], index));
        }
        scene_.counts.meshes = RELIEF_TRY(document_.objects("meshes")).size();
        scene_.counts.unplaced = scene_.counts.meshes - meshes_.size();
        return {};
    }

    Result<void> placeMesh(const Node& from, SceneNode& node) {
        const std::uint64_t key = from.skin ? from.skin->index() + 1 : 0;
        node.posed = from.skin.has_value();
        if (from.skin && !skins_.contains(key)) {
            skins_[key] = RELIEF_TRY(readSkin(*from.skin));
        }
        for (Primitive& primitive : meshes_[from.mesh->index()]) {
            all_jointed_ = all_jointed_ && (!from.skin || primitive.influences);
            const auto [found, added] =
                primitive.placed.try_emplace(key, static_cast<std::uint32_t>(scene_.parts.size()));
            node.parts.push_back(found->second);
            if (!added) {
                continue;
            }
            if (!from.skin || !primitive.influences) {
                scene_.parts.push_back(primitive.part);
                continue;
            }
            const std::vector<Transform>& joints = skins_[key];
            for (const Influence& by : primitive.influences->all) {
                if (by.weight > 0.0F && by.joint >= joints.size()) {
                    return from.mesh->wrong("has vertices that are moved by a joint which its skin, skins[" +
                                            std::to_string(from.skin->index()) + "], does not have");
                }
            }
            scene_.parts.push_back(posed(primitive.part, *primitive.influences, joints));
        }
        return {};
    }

    /// EXT_mesh_gpu_instancing: the node's mesh becomes that of a child for each instance, before its own children.
    Result<void> placeInstances(const Node& from, std::uint32_t index) {
        const std::optional<GltfValue> extensions = RELIEF_TRY(from.place.object("extensions"));
        const std::optional<GltfValue> instancing =
            extensions ? RELIEF_TRY(extensions->object("EXT_mesh_gpu_instancing")) : std::nullopt;
        const std::optional<GltfValue> attributes =
            instancing ? RELIEF_TRY(instancing->object("attributes")) : std::nullopt;
        if (!attributes) {
            return instancing ? Result<void>(instancing->wrong("has no attributes")) : Result<void>();
        }
        if (from.skin) {
            warn("instances of a skinned mesh are left out; export them as nodes");
            return {};
        }
        const auto moves =
            RELIEF_TRY(instanceValues<glm::vec3>(*attributes, "TRANSLATION", GltfUse::kVectors));
        const auto turns =
            RELIEF_TRY(instanceValues<glm::vec4>(*attributes, "ROTATION", GltfUse::kRotations));
        const auto scales = RELIEF_TRY(instanceValues<glm::vec3>(*attributes, "SCALE", GltfUse::kVectors));
        const std::size_t count = std::max({moves.size(), turns.size(), scales.size()});
        for (const std::size_t size : {moves.size(), turns.size(), scales.size()}) {
            if (size != count && size != 0) {
                return attributes->wrong("have other counts of TRANSLATION, ROTATION and SCALE");
            }
        }
        if (count == 0) {
            return attributes->wrong("have none of TRANSLATION, ROTATION and SCALE");
        }
        instances_ += count;
        std::vector<std::uint32_t> children;
        for (std::size_t i = 0; i < count; ++i) {
            SceneNode node;
            node.transform = RELIEF_TRY(placedBy(*attributes, moves.empty() ? glm::vec3(0.0F) : moves[i],
                                                 turns.empty() ? glm::vec4(0, 0, 0, 1) : turns[i],
                                                 scales.empty() ? glm::vec3(1.0F) : scales[i]));
            node.shown = scene_.nodes[index].shown;
            node.index = static_cast<std::uint32_t>(scene_.nodes.size());
            node.parts = scene_.nodes[index].parts;
            children.push_back(*node.index);
            scene_.nodes.push_back(std::move(node));
        }
        SceneNode& node = scene_.nodes[index];
        node.parts.clear();
        node.children.insert(node.children.begin(), children.begin(), children.end());
        return {};
    }

    /// Empty where there is no such attribute.
    template <class T>
    Result<std::vector<T>> instanceValues(const GltfValue& attributes, const char* name, GltfUse use) {
        const std::optional<GltfValue> accessor = RELIEF_TRY(attributes.named(name, "accessors"));
        return accessor ? readAccessor<T>(*accessor, use, buffers_, kInstancesMax - instances_)
                        : Result<std::vector<T>>(std::vector<T>());
    }

    /// The transform of each joint of a skin, of vertices as they are modelled.
    Result<std::vector<Transform>> readSkin(const GltfValue& skin) {
        const auto joints = RELIEF_TRY(skin.get<std::vector<std::uint64_t>>("joints", {}));
        if (joints.empty() || joints.size() > kJointsMax) {
            return skin.wrong("has no joints, or more than " + std::to_string(kJointsMax));
        }
        // Identity by default.
        std::vector<glm::mat4> bounds(joints.size(), glm::mat4(1.0F));
        if (const auto inverse = RELIEF_TRY(skin.named("inverseBindMatrices", "accessors"))) {
            bounds = RELIEF_TRY(readAccessor<glm::mat4>(*inverse, GltfUse::kMatrices, buffers_, kJointsMax));
        }
        if (bounds.size() < joints.size()) {
            return skin.wrong("has fewer inverseBindMatrices than joints");
        }
        std::vector<Transform> transforms;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            static_cast<void>(RELIEF_TRY(skin.at(joints[i], "nodes", "joints")));
            const std::optional<Transform> bound = affine(&bounds[i][0][0]);
            if (!bound) {
                return skin.wrong("has inverseBindMatrices whose last row is not 0 0 0 1");
            }
            Transform place = *scene_.nodes[joints[i]].transform;
            for (auto above = nodes_[joints[i]].parent; above; above = nodes_[*above].parent) {
                place = *scene_.nodes[*above].transform * place;
            }
            transforms.push_back(place * *bound);
        }
        return transforms;
    }

    /// \param skinned  whether a node places it with a skin.
    Result<void> readMesh(const GltfValue& mesh, bool skinned) {
        std::vector<Primitive>& primitives = meshes_[mesh.index()];
        const std::string name = RELIEF_TRY(mesh.get<std::string>("name", ""));
        for (const GltfValue& place : RELIEF_TRY(mesh.objects("primitives"))) {
            Primitive primitive = RELIEF_TRY(readPrimitive(place, skinned));
            if (!primitive.part.triangles.empty()) {
                primitive.part.names = {name, primitive.part.material};
                primitives.push_back(std::move(primitive));
            }
        }
        return {};
    }

    Result<Primitive> readPrimitive(const GltfValue& place, bool skinned) {
        const std::optional<GltfValue> attributes = RELIEF_TRY(place.object("attributes"));
        const std::uint64_t mode = RELIEF_TRY(place.get<std::uint64_t>("mode", kTriangles));
        if (!attributes || mode > kFan) {
            return place.wrong(attributes ? "has a mode that is not 0 to 6" : "has no attributes");
        }
        if (!RELIEF_TRY(place.objects("targets")).empty()) {
            warn("it is morphed; baked as it is modelled, without its targets");
        }
        Primitive out;
        if (const auto material = RELIEF_TRY(place.named("material", "materials"))) {
            out.part.material = RELIEF_TRY(material->get<std::string>("name", ""));
        }
        const std::optional<GltfValue> accessor = RELIEF_TRY(attributes->named("POSITION", "accessors"));
        if (!accessor) {
            warn("a primitive without positions is left out");
            return out;
        }
        Vertices& used = *RELIEF_TRY(vertices(*accessor));
        RELIEF_TRY(readTriangles(place, mode, used, out.part));
        const std::vector<std::uint32_t> kept = compact(used.positions, out.part);
        if (skinned) {
            const std::optional<Influences> all =
                RELIEF_TRY(readInfluences(*attributes, buffers_, used.positions.size()));
            if (all) {
                out.influences.emplace().per_vertex = all->per_vertex;
            }
            for (std::size_t i = 0; all && i < kept.size(); ++i) {
                const auto from = all->all.begin() + static_cast<std::ptrdiff_t>(all->per_vertex * kept[i]);
                out.influences->all.insert(out.influences->all.end(), from,
                                           from + static_cast<std::ptrdiff_t>(all->per_vertex));
            }
        }
        return out;
    }

    Result<Vertices*> vertices(const GltfValue& accessor) {
        const bool plain = accessor.has("bufferView") && !accessor.has("sparse");
        const std::uint64_t view = plain ? RELIEF_TRY(accessor.number("bufferView")) : 0;
        const std::uint64_t offset = RELIEF_TRY(accessor.get<std::uint64_t>("byteOffset", 0));
        const std::uint64_t count = RELIEF_TRY(accessor.number("count"));
        const std::uint64_t type = RELIEF_TRY(accessor.number("componentType"));
        const bool normalized = RELIEF_TRY(accessor.get("normalized", false));
        const auto [found, added] =
            vertices_.try_emplace({view, offset, count, type, normalized, plain ? 0 : accessor.index() + 1});
        if (added) {
            found->second.positions = RELIEF_TRY(readAccessor<glm::vec3>(
                accessor, GltfUse::kPositions, buffers_, 3 * triangle_max_ - vertex_count_));
            found->second.uses.resize(found->second.positions.size(), 0);
            vertex_count_ += found->second.positions.size();
        }
        return &found->second;
    }

    /// \param vertices  of the primitive.
    Result<void> readTriangles(const GltfValue& place, std::uint64_t mode, Vertices& vertices,
                               ScenePart& part) {
        // Without indices, the vertices in their order.
        const std::optional<GltfValue> accessor = RELIEF_TRY(place.named("indices", "accessors"));
        std::vector<std::uint32_t> indices;
        if (accessor) {
            indices = RELIEF_TRY(
                readAccessor<std::uint32_t>(*accessor, GltfUse::kIndices, buffers_, 3 * triangle_max_));
            RELIEF_TRY(checkIndices(*accessor, indices, vertices.positions.size()));
        }
        const std::uint64_t corners = accessor ? indices.size() : vertices.positions.size();
        const auto vertexOf = [&](std::uint32_t corner) { return accessor ? indices[corner] : corner; };
        const bool surface = mode >= kTriangles;
        for (std::uint32_t i = 0; i < corners; ++i) {
            vertices.uses[vertexOf(i)] |= surface ? kByTriangle : kByOther;
        }
        scene_.counts.points += mode == kPoints ? corners : 0;
        scene_.counts.lines += surface || mode == kPoints ? 0 : linesOf(mode, corners);
        if (!surface) {
            return {};
        }
        if (mode == kTriangles && corners % 3 != 0) {
            return place.wrong("has " + std::to_string(corners) + " corners, which is no multiple of 3");
        }
        const std::uint64_t count = mode == kTriangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
        if (count > triangle_max_ - scene_.counts.polygons) {
            return place.wrong("is beyond the limit of " + std::to_string(triangle_max_) +
                                   " triangles for all meshes; simplify the mesh, or raise --max-triangles",
                               ErrorCode::kLimit);
        }
        scene_.counts.polygons += count;
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::uvec3 corner = cornersOf(mode, i);
            part.triangles.emplace_back(vertexOf(corner.x), vertexOf(corner.y), vertexOf(corner.z));
        }
        return {};
    }

    static Result<void> checkIndices(const GltfValue& accessor, const std::vector<std::uint32_t>& indices,
                                     std::size_t vertices) {
        const std::uint64_t type = RELIEF_TRY(accessor.number("componentType"));
        const std::uint32_t restart = type == 5121 ? 0xFF : type == 5123 ? 0xFFFF : 0xFFFFFFFF;
        for (const std::uint32_t vertex : indices) {
            if (vertex == restart) {
                return accessor.wrong(
                    "holds the index " + std::to_string(restart) +
                    ", which is not allowed: it means a restart; export it with wider indices");
            }
            if (vertex >= vertices) {
                return accessor.wrong("holds the index " + std::to_string(vertex) +
                                      " of a vertex that does not exist: there are " +
                                      std::to_string(vertices));
            }
        }
        return {};
    }

    std::uint64_t triangle_max_;
    const GltfValue& document_;
    GltfBuffers buffers_;
    ImportScene scene_;
    std::vector<Node> nodes_;  // beside those of the scene
    std::map<std::uint64_t, std::vector<Primitive>> meshes_;
    std::map<std::uint64_t, std::vector<Transform>> skins_;  // transforms of their joints, by number + 1
    bool all_jointed_ = true;
    std::map<Key, Vertices> vertices_;
    std::uint64_t vertex_count_ = 0;
    std::uint64_t instances_ = 0;  // of EXT_mesh_gpu_instancing
};

}  // namespace

Result<ImportScene> readGltf(const ImportJob& job, ImportFiles& files) {
    GltfChunks chunks = RELIEF_TRY(gltfChunks(job.bytes));
    const nlohmann::json json = RELIEF_TRY(parseGltfJson(chunks.json));
    if (!json.is_object()) {
        return invalidInput("its JSON is no object");
    }
    const GltfValue document(json);
    Result<ImportScene> scene = GltfReader(job, chunks, document, files).run();
    if (scene) {
        scene->warnings.insert(scene->warnings.begin(), chunks.warnings.begin(), chunks.warnings.end());
    }
    return scene;
}

}  // namespace relief
