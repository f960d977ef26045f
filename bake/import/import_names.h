// The names that a scene of assimp's gives to its triangles, and which of them somebody asked for.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// A triangle has the names of its material, of its mesh, and of the node that uses it and of all above that. OBJ's groups
/// and objects are nodes; a group of several names has each of them, and the line as a whole.
class NameMarks {
  public:
    /// \param scene      borrowed.
    /// \param asked      ImportOptions::names, borrowed; none: nothing is looked at.
    /// \param extension  of the file, lower case, without dot.
    /// \param file_name  which some readers give to the topmost node: no message lists it.
    NameMarks(const aiScene& scene, const std::vector<std::string>& asked, std::string_view extension,
              std::string file_name);

    [[nodiscard]] bool any() const { return !asked_.empty(); }

    /// As TriangleMesh::marks has it, for the triangles of a mesh. \param node  that uses it; null: none does.
    std::uint8_t of(const aiMesh& mesh, const aiNode* node);

    /// Whether every name was met. \param shown  the file's name for messages.
    /// Errors: kUsage, with the names that were.
    [[nodiscard]] Result<void> allMet(const std::string& shown) const;

  private:
    std::uint8_t meet(std::string_view raw);
    std::uint8_t meetNode(const aiNode& node);
    std::uint8_t meetMesh(const aiMesh& mesh, bool numbered);
    std::uint8_t meetMaterial(const aiMesh& mesh);

    const aiScene& scene_;
    const std::vector<std::string>& asked_;
    bool is_obj_;
    bool is_gltf_;
    std::string file_name_;
    std::map<std::string, std::uint8_t, std::less<>> marks_;  // of the names that are asked for
    std::set<std::uint8_t> met_;                              // of these
    std::vector<std::string> names_;               // that were met, in that order, the first of them
    std::set<std::string, std::less<>> listed_;    // the same
    std::map<const aiNode*, std::uint8_t> nodes_;  // with those above them
};

}  // namespace relief
