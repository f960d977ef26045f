// The names of a file's triangles, and which of them somebody asked for.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Is told every name that a triangle has: of its material, of its mesh, of the node that uses it and of all above that.
class NameMarks {
  public:
    /// \param asked      ImportOptions::names, borrowed; none: there is nothing to tell it.
    /// \param file_name  which some readers give to the topmost node: no message lists it.
    NameMarks(const std::vector<std::string>& asked, std::string file_name);

    [[nodiscard]] bool any() const { return !asked_.empty(); }

    /// \param raw     as the file has it; "" for none.
    /// \param listed  false for a name that the reader made up.
    /// \return what TriangleMesh::marks has of a triangle of this name alone; of several names, the largest counts.
    std::uint8_t meet(std::string_view raw, bool listed = true);

    /// Whether every name was met. \param shown  the file's name for messages.
    /// Errors: kUsage, with the names that were.
    [[nodiscard]] Result<void> allMet(const std::string& shown) const;

  private:
    const std::vector<std::string>& asked_;
    std::string file_name_;
    std::map<std::string, std::uint8_t, std::less<>> marks_;  // of the names that are asked for
    std::set<std::uint8_t> met_;                              // of these
    std::vector<std::string> names_;             // that were met, in that order, the first of them
    std::set<std::string, std::less<>> listed_;  // the same
};

}  // namespace relief
