// SPDX-License-Identifier: Apache-2.0
#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "bake/import/source_properties.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Serves the mesh from memory, and the files that it references (material libraries) through ImportFiles. Read-only.
class ReadOnlyFiles final : public Assimp::IOSystem {
  public:
    /// Borrows both. \param mesh  the mesh's bytes.
    ReadOnlyFiles(ImportFiles& files, std::span<const std::byte> mesh) : files_(files), mesh_(mesh) {}

    bool Exists(const char* path) const override { return path != nullptr && files_.exists(path); }
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        if (path == nullptr || (mode != nullptr && std::strpbrk(mode, "wa+") != nullptr)) {
            return nullptr;
        }
        if (files_.isMesh(path)) {
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(mesh_.data()),
                                              mesh_.size());
        }
        const std::optional<std::vector<std::byte>> bytes = files_.open(path);
        if (!bytes) {
            return nullptr;
        }
        auto* const copy = new std::uint8_t[bytes->size()];
        std::memcpy(copy, bytes->data(), bytes->size());
        return new Assimp::MemoryIOStream(copy, bytes->size(), true);
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }
    // assimp's defaults would access the disk.
    bool CreateDirectory(const std::string& /*path*/) override { return false; }
    bool ChangeDirectory(const std::string& /*path*/) override { return false; }
    bool DeleteFile(const std::string& /*file*/) override { return false; }

  private:
    ImportFiles& files_;
    std::span<const std::byte> mesh_;
};

/// The first errors of an import on this thread, and warnings about omitted parts of the surface. Only this log reports
/// repairs by assimp's readers, such as the replacement of an out-of-range index.
thread_local std::vector<std::string> logged;

bool hasAny(std::string_view text, std::span<const std::string_view> words) {
    return std::ranges::any_of(
        words, [text](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

/// Phrases in assimp's warnings (BLEND, LWO, FBX) about omitted parts of the surface.
constexpr std::array<std::string_view, 7> kLeftOut = {
    "type is unsupported",   "unsupported primitive chunk", "unknown polygon type",   "unsupported ID",
    "unrecognized geometry", "not enough vertices",         "unexpected vertex setup"};
/// Topics that an import ignores.
constexpr std::array<std::string_view, 5> kNoSurface = {"aterial", "exture", "nimation", "angent", "inormal"};

class Listener final : public Assimp::Logger {
  public:
    bool attachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }
    bool detachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }

  protected:
    void OnVerboseDebug(const char* /*message*/) override {}
    void OnDebug(const char* /*message*/) override {}
    void OnInfo(const char* /*message*/) override {}
    void OnWarn(const char* message) override {
        if (hasAny(message, kLeftOut)) {
            OnError(message);
        }
    }
    void OnError(const char* message) override {
        constexpr std::size_t kErrorsMax = 4;
        const std::string line = oneCleanLine(message);
        if (logged.size() < kErrorsMax && !hasAny(line, kNoSurface) &&
            std::ranges::find(logged, line) == logged.end()) {
            logged.push_back(line);
        }
    }
};

void beginLogging() {
    [[maybe_unused]] static const bool kInstalled = [] {
        Assimp::DefaultLogger::set(new Listener);  // owned by assimp for the life of the process
        return true;
    }();
    logged.clear();
}

bool hasLogged(std::string_view words) {
    return std::ranges::any_of(
        logged, [words](const std::string& error) { return error.find(words) != std::string::npos; });
}

template <class T>
std::optional<T> metadata(const aiMetadata* data, const char* key) {
    T value{};
    return data != nullptr && data->Get(key, value) ? std::optional(value) : std::nullopt;
}

/// Reads the frame of an FBX file: unit in centimetres, axes as index and sign. assimp applies neither, reads 10,5 as
/// 10, and reads only numbers of type double.
SourceFrame fbxFrame(const ImportJob& job, const aiScene& scene) {
    SourceFrame frame{std::nullopt, std::nullopt};
    const FbxUnit unit = fbxUnit(job.bytes).value_or(FbxUnit{"1", 1.0});
    if (unit.value && *unit.value > 0.0) {
        frame.metres = 0.01 * *unit.value;
    } else {
        frame.unit_fault = "its UnitScaleFactor is " + unit.text + ", which is not a length";
    }
    const int axis = metadata<std::int32_t>(scene.mMetaData, "UpAxis").value_or(1);
    const int sign = metadata<std::int32_t>(scene.mMetaData, "UpAxisSign").value_or(1);
    if (axis >= 0 && axis <= 2) {
        frame.up = static_cast<UpAxis>(2 * axis + (sign < 0 ? 1 : 0));
    } else {
        frame.up_fault = "its UpAxis is " + std::to_string(axis) + ", which is not 0, 1 or 2";
    }
    return frame;
}

/// Reads the frame of a COLLADA file. assimp scales the root by the document's unit; removes that scale from `root`.
SourceFrame daeFrame(const ImportJob& job, aiMatrix4x4& root) {
    SourceFrame frame = colladaFrame(job.bytes);
    const double applied = double{root.a1};  // as rounded by assimp
    if (frame.metres && std::abs(applied / *frame.metres - 1.0) < 1e-5) {
        frame.metres = applied;
    }
    root = aiMatrix4x4();
    return frame;
}

/// Reads the frame of a 3DS file. assimp rotates the root, and divides it by the file's master scale, even if the scale
/// is invalid. Removes the rotation, and an invalid scale, from `root`.
SourceFrame frameOf3ds(aiMatrix4x4& root) {
    SourceFrame frame{std::nullopt, UpAxis::kPlusZ};
    const float scale = root.a1;
    root = aiMatrix4x4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1) * root;
    if (!(scale > 0.0F && std::isfinite(scale))) {
        frame.unit_fault = "its master scale is " + shortest(1.0F / scale) + ", which is not a scale";
        root = aiMatrix4x4();
    }
    return frame;
}

/// Reads the frame of a file, and removes assimp's conversion from the root of `scene`.
SourceFrame frameOf(AssimpFrame format, const ImportJob& job, aiScene& scene) {
    switch (format) {
        case AssimpFrame::k3ds:
            return frameOf3ds(scene.mRootNode->mTransformation);
        case AssimpFrame::kDae:
            return daeFrame(job, scene.mRootNode->mTransformation);
        case AssimpFrame::kFbx:
            return fbxFrame(job, scene);
        default:
            return {std::nullopt, std::nullopt, format == AssimpFrame::kMirrored};
    }
}

std::string nameOf(const aiString& text) {
    const std::string_view name(text.data, std::min<std::size_t>(text.length, sizeof(text.data)));
    // assimp's placeholders for missing names, and its suffix for split FBX nodes.
    const bool made_up = name == AI_DEFAULT_MATERIAL_NAME || (name.starts_with('<') && name.ends_with('>')) ||
                         name.find("_$AssimpFbx$_") != std::string_view::npos;
    return made_up ? std::string() : std::string(name.substr(0, name.find(kLodGroupMark)));
}

/// Converts a mesh. Some of assimp's readers keep invalid indices. \return nullopt if a face references a missing
/// vertex.
std::optional<PolygonMesh> polygonsOf(const aiMesh& mesh) {
    PolygonMesh polygons;
    if (!mesh.HasPositions()) {
        return polygons;
    }
    for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
        polygons.positions.emplace_back(v.x, v.y, v.z);
    }
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
        if (face.mNumIndices > 0) {
            polygons.sizes.push_back(face.mNumIndices);
        }
        for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
            if (index >= mesh.mNumVertices) {
                return std::nullopt;
            }
            polygons.corners.push_back(index);
        }
    }
    return polygons;
}

/// Gives each corner its own vertex, so that bakes of meshes with lines or points stay byte-identical.
void unshare(ScenePart& part) {
    std::vector<glm::vec3> positions;
    for (glm::uvec3& t : part.triangles) {
        const auto base = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {part.positions[t.x], part.positions[t.y], part.positions[t.z]});
        t = {base, base + 1, base + 2};
    }
    part.positions = std::move(positions);
}

/// Returns false if a face references a missing vertex.
bool addMeshes(const aiScene& source, ImportScene& scene) {
    for (const aiMesh* mesh : std::span(source.mMeshes, source.mNumMeshes)) {
        const std::optional<PolygonMesh> polygons = polygonsOf(*mesh);
        if (!polygons) {
            return false;
        }
        const MeshParts counts = partsOf(*polygons);
        for (const auto count : {&MeshParts::polygons, &MeshParts::lines, &MeshParts::points,
                                 &MeshParts::vertices, &MeshParts::unused, &MeshParts::loose}) {
            scene.counts.*count += counts.*count;
        }
        ScenePart part = triangulatePolygons(*polygons);
        if (counts.lines + counts.points > 0) {
            unshare(part);
        }
        aiString material;
        if (mesh->mMaterialIndex < source.mNumMaterials) {
            source.mMaterials[mesh->mMaterialIndex]->Get(AI_MATKEY_NAME, material);
        }
        part.material = nameOf(material);
        part.names = {nameOf(mesh->mName), part.material};
        scene.parts.push_back(std::move(part));
    }
    return true;
}

/// Whether a property of an FBX node exists and is 0, in any numeric type.
bool isZero(const aiNode& node, const char* property) {
    const auto is = [&](auto zero) { return metadata<decltype(zero)>(node.mMetaData, property) == zero; };
    return is(false) || is(std::int32_t{0}) || is(0.0F) || is(0.0);
}

std::span<aiNode* const> childrenOf(const aiNode& node) {
    return {node.mChildren, node.mNumChildren};
}

/// Nodes that the file hides by other means than FBX properties.
struct HiddenNodes {
    std::map<const aiNode*, std::string> labels;  ///< names for messages
    std::vector<std::string> unmatched;           ///< hidden objects without a node
};

HiddenNodes nodesOf(const aiNode& root, const std::set<std::string>& names) {
    HiddenNodes hidden;
    std::set<std::string> unmatched = names;
    std::vector<const aiNode*> pending{&root};
    while (!pending.empty()) {
        const aiNode* const node = pending.back();
        pending.pop_back();
        if (const std::string name = node->mName.C_Str(); names.contains(name)) {
            hidden.labels.emplace(node, name);
            unmatched.erase(name);
        }
        for (const aiNode* child : childrenOf(*node)) {
            if (child != nullptr) {
                pending.push_back(child);
            }
        }
    }
    hidden.unmatched.assign(unmatched.begin(), unmatched.end());
    return hidden;
}

/// Finds the hidden nodes by walking assimp's tree and the document's in parallel, because names may be missing or
/// ambiguous. assimp keeps the order, and drops instances that it cannot resolve.
HiddenNodes nodesOf(const aiNode& root, const std::vector<ColladaNode>& document) {
    HiddenNodes hidden;
    if (std::ranges::none_of(document, &ColladaNode::hidden)) {
        return hidden;
    }
    std::vector<bool> matched(document.size());
    std::vector<std::pair<const aiNode*, std::uint32_t>> pending{{&root, 0}};
    while (!pending.empty()) {
        const auto [node, index] = pending.back();
        pending.pop_back();
        matched[index] = true;
        if (document[index].hidden) {
            hidden.labels.emplace(node, document[index].label);
        }
        auto next = document[index].children.begin();
        for (const aiNode* child : childrenOf(*node)) {
            if (child == nullptr) {
                continue;
            }
            const std::string_view name = child->mName.C_Str();
            next = std::find_if(next, document[index].children.end(), [&](std::uint32_t other) {
                const std::string& written = document[other].name;
                return written.empty() ? name.starts_with("$ColladaAutoName$_") : name == written;
            });
            if (next == document[index].children.end()) {
                break;
            }
            pending.emplace_back(child, *next++);
        }
    }
    for (std::size_t i = 0; i < document.size(); ++i) {
        if (document[i].hidden && !matched[i]) {
            hidden.unmatched.push_back(document[i].label);
        }
    }
    return hidden;
}

/// Whether the file hides this node and its descendants, ignoring ancestors.
bool hidesBelow(const aiNode& node, const HiddenNodes& hidden) {
    return isZero(node, "Visibility") || hidden.labels.contains(&node);
}

/// Whether the file hides this node, ignoring ancestors. FBX's Show applies only to the node itself.
bool isHidden(const aiNode& node, const HiddenNodes& hidden) {
    return isZero(node, "Show") || hidesBelow(node, hidden);
}

bool hasMeshes(const aiNode& node) {
    return node.mNumMeshes > 0 || std::ranges::any_of(childrenOf(node), [](const aiNode* child) {
               return child != nullptr && hasMeshes(*child);
           });
}

/// Finds all levels of a LodGroup except the most detailed level, which is the first shown level.
std::set<const aiNode*> lowerLevels(const aiNode& group, const HiddenNodes& hidden) {
    std::set<const aiNode*> levels;
    if (std::string_view(group.mName.C_Str()).find(kLodGroupMark) == std::string_view::npos) {
        return levels;
    }
    bool first = true;
    for (const aiNode* child : childrenOf(group)) {
        if (child != nullptr && hasMeshes(*child) && !isHidden(*child, hidden) &&
            !std::exchange(first, false)) {
            levels.insert(child);
        }
    }
    return levels;
}

void addNodes(const aiScene& source, const HiddenNodes& hidden, ImportScene& scene) {
    struct Pending {
        const aiNode* node;
        std::uint32_t parent;
        Shown above;
    };
    std::vector<Pending> pending{{source.mRootNode, 0, Shown::kYes}};
    std::set<const aiNode*> lower_levels;
    while (!pending.empty()) {
        const auto [from, parent, above] = pending.back();
        pending.pop_back();
        const auto index = static_cast<std::uint32_t>(scene.nodes.size());
        const aiMatrix4x4& m = from->mTransformation;
        SceneNode node{
            Transform{glm::dmat3(m.a1, m.b1, m.c1, m.a2, m.b2, m.c2, m.a3, m.b3, m.c3), {m.a4, m.b4, m.c4}}};
        node.names = {nameOf(from->mName)};
        node.index = index;
        const bool free = above == Shown::kHidden && isZero(*from, "Visibility Inheritance");
        const Shown below = above != Shown::kYes && !free ? above
                            : lower_levels.contains(from) ? Shown::kLowerLevel
                            : hidesBelow(*from, hidden)   ? Shown::kHidden
                                                          : Shown::kYes;
        node.is_shown = below == Shown::kYes && isZero(*from, "Show") ? Shown::kHidden : below;
        if (index > 0) {  // the root represents the file
            const auto label = hidden.labels.find(from);
            node.shown = label != hidden.labels.end() ? label->second
                         : node.names[0].empty()      ? scene.nodes[parent].shown
                                                      : node.names[0];
            scene.nodes[parent].children.push_back(index);
        }
        for (const unsigned mesh : std::span(from->mMeshes, from->mNumMeshes)) {
            if (mesh < scene.parts.size()) {
                node.parts.push_back(mesh);
            }
        }
        scene.nodes.push_back(std::move(node));
        lower_levels.merge(lowerLevels(*from, hidden));
        for (unsigned i = from->mNumChildren; i > 0; --i) {
            if (from->mChildren[i - 1] != nullptr) {
                pending.push_back({from->mChildren[i - 1], index, below});
            }
        }
    }
    scene.roots = {0};
    if (!hidden.unmatched.empty()) {  // a 3DS file without a keyframer
        const std::size_t count = hidden.unmatched.size();
        const std::string them = count == 1 ? "it" : "them";
        scene.warnings.push_back("could not leave out " + std::to_string(count) + " hidden object" +
                                 (count == 1 ? "" : "s") + firstName(hidden.unmatched.front(), count) +
                                 ", because no node represents " + them + "; remove " + them);
    }
}

/// Keeps only the readers for the extension, so that the contents do not affect the choice.
void keepReadersOf(const std::string& extension, Assimp::Importer& importer) {
    std::vector<Assimp::BaseImporter*> others;
    for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
        const std::string_view claimed = importer.GetImporterInfo(i)->mFileExtensions;
        const std::vector<std::string_view> extensions = split(claimed, ' ');
        if (std::ranges::find(extensions, extension) == extensions.end()) {
            others.push_back(importer.GetImporter(i));
        }
    }
    for (Assimp::BaseImporter* other : others) {
        importer.UnregisterLoader(other);
        delete other;
    }
}

/// Returns assimp's message, and the refused files. Throws std::bad_alloc if assimp ran out of memory.
tl::unexpected<Error> readError(const Assimp::Importer& importer, const ImportFiles& files) {
    if (const std::exception_ptr& thrown = importer.GetException(); thrown != nullptr) {
        try {
            std::rethrow_exception(thrown);
        } catch (const std::bad_array_new_length&) {  // an invalid size in the file
        } catch (const std::bad_alloc&) {
            throw;
        } catch (...) {  // the message follows below
        }
    }
    const std::string words = oneCleanLine(importer.GetErrorString());
    std::string text = words.empty() ? "its contents do not match its extension" : words;
    for (const std::string& refused : files.refused()) {
        text += "; it refers to " + refused;
    }
    return invalidInput(text + "; repair the file or export it again");
}

}  // namespace

Result<ImportScene> readWithAssimp(AssimpFrame format, const ImportJob& job, ImportFiles& files) {
    beginLogging();
    const ColladaNodes collada =
        format == AssimpFrame::kDae ? RELIEF_TRY(readColladaNodes(job.bytes)) : ColladaNodes();
    Assimp::Importer importer;
    keepReadersOf(job.extension, importer);
    const std::optional<std::vector<std::byte>> marked =
        format == AssimpFrame::kFbx ? patchedFbx(job.bytes) : std::nullopt;
    importer.SetIOHandler(new ReadOnlyFiles(files, marked ? *marked : files.meshBytes()));
    // Otherwise assimp creates a placeholder mesh for files that contain only bones.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // applied below
    // Owned by the importer; the cast is safe because the object is not constant.
    auto* const source = const_cast<aiScene*>(importer.ReadFile(job.file_name, 0));
    if (hasLogged("UnitScaleFactor must be non-zero")) {
        return invalidInput("its UnitScaleFactor is 0, which is not a length; export it again with a unit");
    }
    if (source == nullptr || source->mRootNode == nullptr) {
        return readError(importer, files);
    }
    ImportScene scene;
    if (!addMeshes(*source, scene) || hasLogged("out of range") || hasLogged("out-of-range")) {
        return invalidInput("a face uses a vertex that does not exist");
    }
    scene.frame = frameOf(format, job, *source);
    addNodes(*source,
             format == AssimpFrame::k3ds ? nodesOf(*source->mRootNode, hiddenObjectsOf3ds(job.bytes))
                                         : nodesOf(*source->mRootNode, collada.nodes),
             scene);
    if (collada.missing) {
        scene.warnings.push_back("left out missing objects: " + *collada.missing);
    }
    if (collada.animates_visibility || (format == AssimpFrame::kFbx && fbxAnimatesVisibility(job.bytes))) {
        scene.warnings.emplace_back(kAnimatedVisibility);
    }
    const std::span meshes(source->mMeshes, source->mNumMeshes);
    if (std::ranges::any_of(meshes, &aiMesh::HasBones)) {
        scene.warnings.emplace_back("it is skinned; baked as modelled, without its skeleton");
    }
    if (std::ranges::any_of(meshes, [](const aiMesh* mesh) { return mesh->mNumAnimMeshes > 0; })) {
        scene.warnings.emplace_back("it has morph targets; baked as modelled, without them");
    }
    for (const std::string& error : logged) {
        scene.warnings.push_back("the importer reports: " + error);
    }
    return scene;
}

}  // namespace relief
