#include "bake/import/import_names.h"

#include <algorithm>
#include <utility>

#include "bake/mesh/mesh.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Names that are remembered, to find the nearest to a wrong one, and those that a message lists.
constexpr std::size_t kNamesMax = 1000;
constexpr std::size_t kListedMax = 20;
constexpr std::size_t kListedBytesMax = 80;
/// What assimp adds to nodes of FBX that it splits.
constexpr std::string_view kHelperNode = "_$AssimpFbx$_";

/// What assimp calls what has no name.
bool isMadeUp(std::string_view name) {
    return name == AI_DEFAULT_MATERIAL_NAME || (name.starts_with('<') && name.ends_with('>')) ||
           name.find(kHelperNode) != std::string_view::npos;
}

std::string_view textOf(const aiString& text) {
    return {text.data, std::min<std::size_t>(text.length, sizeof(text.data))};
}

/// glTF's name of a mesh of several primitives, each of which assimp numbers: "door-1" -> "door".
std::string_view withoutNumber(std::string_view name) {
    const std::size_t digits = name.find_last_not_of("0123456789");
    return digits != std::string_view::npos && digits + 1 < name.size() && name[digits] == '-'
               ? name.substr(0, digits)
               : name;
}

}  // namespace

NameMarks::NameMarks(const aiScene& scene, const std::vector<std::string>& asked, std::string_view extension,
                     std::string file_name)
    : scene_(scene),
      asked_(asked),
      is_obj_(extension == "obj"),
      is_gltf_(extension == "gltf" || extension == "glb"),
      file_name_(std::move(file_name)) {
    for (std::size_t i = 0; i < std::min(asked.size(), kAskedNamesMax); ++i) {
        marks_[asked[i]] = static_cast<std::uint8_t>(i + 1);
    }
}

std::uint8_t NameMarks::of(const aiMesh& mesh, const aiNode* node) {
    std::vector<const aiNode*> chain;
    const aiNode* above = node;
    for (; above != nullptr && !nodes_.contains(above); above = above->mParent) {
        chain.push_back(above);
    }
    std::uint8_t mark = above != nullptr ? nodes_.at(above) : std::uint8_t{0};
    for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
        mark = std::max(mark, meetNode(**it));
        nodes_[*it] = mark;
    }
    const bool numbered = is_gltf_ && node != nullptr && node->mNumMeshes > 1;
    return std::max({mark, meetMesh(mesh, numbered), meetMaterial(mesh)});
}

std::uint8_t NameMarks::meet(std::string_view raw) {
    std::string name = cleanUtf8(raw, kAskedNameBytesMax);
    if (name.empty()) {
        return 0;
    }
    const bool is_listed = name != file_name_ && !isMadeUp(name);
    if (is_listed && names_.size() < kNamesMax && listed_.insert(name).second) {
        names_.push_back(name);
    }
    const auto found = marks_.find(name);
    if (found == marks_.end()) {
        return 0;
    }
    met_.insert(found->second);
    return found->second;
}

std::uint8_t NameMarks::meetNode(const aiNode& node) {
    const std::string_view name = textOf(node.mName);
    std::uint8_t mark = meet(name);
    if (is_obj_) {
        std::string_view rest = name;
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            mark = std::max(mark, meet(word));
        }
    }
    return mark;
}

std::uint8_t NameMarks::meetMesh(const aiMesh& mesh, bool numbered) {
    const std::string_view name = textOf(mesh.mName);
    return meet(numbered ? withoutNumber(name) : name);
}

std::uint8_t NameMarks::meetMaterial(const aiMesh& mesh) {
    aiString name;
    return mesh.mMaterialIndex < scene_.mNumMaterials &&
                   scene_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) == AI_SUCCESS
               ? meet(textOf(name))
               : std::uint8_t{0};
}

Result<void> NameMarks::allMet(const std::string& shown) const {
    const auto unmet = std::find_if(asked_.begin(), asked_.end(), [&](const std::string& name) {
        const auto found = marks_.find(name);
        return found == marks_.end() || !met_.contains(found->second);
    });
    if (unmet == asked_.end()) {
        return {};
    }
    std::string text = shown + " names no triangles '" + cleanUtf8(*unmet, kAskedNameBytesMax) + "'";
    const std::vector<std::string_view> known(names_.begin(), names_.end());
    text += didYouMean(*unmet, known);
    if (known.empty()) {
        return fail(ErrorCode::kUsage, text + ", nor anything else; leave the name out");
    }
    text += text.ends_with("?") ? " It has " : "; it has ";
    for (std::size_t i = 0; i < std::min(known.size(), kListedMax); ++i) {
        text += (i == 0 ? "'" : ", '") + cleanUtf8(known[i], kListedBytesMax) + "'";
    }
    return fail(ErrorCode::kUsage, text + (known.size() > kListedMax ? " and more" : ""));
}

}  // namespace relief
