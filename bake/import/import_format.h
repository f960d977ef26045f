// The formats of mesh files as a table, and the format of a file by its first bytes, whatever its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// The code that reads a format (mesh_import.cpp).
enum class MeshReader : std::uint8_t { kAssimp, kGltf, kObj, kOff, kPly, kRaw, kStl, kAmf, k3mf };

/// How assimp hands the units and axes of a file on (mesh_import.cpp).
enum class AssimpFrame : std::uint8_t {
    kAsIs,
    kMirrored,  ///< it has turned z round
    kZUp,       ///< it has turned the file's z to +y
    k3ds,
    kDae,
    kDxf,
    kFbx,
};

/// One format of mesh files; a new one is a row of kRows (import_format.cpp), and a reader if assimp does not read it.
struct MeshFormat {
    std::string_view extension;  ///< lower case, without its dot
    MeshReader reader = MeshReader::kAssimp;
    AssimpFrame frame = AssimpFrame::kAsIs;
    std::array<std::string_view, 2> signatures{};  ///< bytes that no other format begins with
    std::string_view packed{};                     ///< the beginning of an archive that files may be in
    std::string_view alias{};  ///< of the format by its other name, whose row has all the rest
    bool narrow = false;       ///< text of eight bits; XML states its own encoding
    bool own_words = false;    ///< its text may look like that of other formats
    bool whole = false;        ///< refers to no other files
};

/// The formats that are read; the first kNamedFormats are those that a message names.
[[nodiscard]] std::span<const MeshFormat> meshFormats();
inline constexpr std::size_t kNamedFormats = 11;

/// \param extension  in any case, without its dot. \return nullptr: there is no such format.
[[nodiscard]] const MeshFormat* meshFormat(std::string_view extension);

/// The extension of the format that the contents have beyond doubt, such as "glb", "stl" or "dae". nullopt: there is none, or
/// it is that of `extension`.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> otherFormat(std::string_view extension,
                                                     std::span<const std::byte> bytes);

/// The kind of a file that is no mesh, with the cure: packed, text in UTF-16, a picture, a web page, a placeholder of Git.
/// nullopt: nothing of that kind.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> noMeshAtAll(std::string_view extension,
                                                     std::span<const std::byte> bytes);

}  // namespace relief
