// SPDX-License-Identifier: Apache-2.0
// Defines an import request: units of length, axes, options and limits; and declares the importer's entry point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

enum class UpAxis : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };

template <>
inline constexpr std::array<std::string_view, 6> kWordsOf<UpAxis>{"+x", "-x", "+y", "-y", "+z", "-z"};

inline constexpr std::array<std::string_view, 8> kLengthUnits{"m", "cm", "mm", "um", "km", "in", "ft", "yd"};

/// Returns the length of a unit in metres; nullopt if the unit is unknown.
[[nodiscard]] std::optional<double> metresPer(std::string_view unit);

/// Returns the rotation that maps `up` to +Y, exactly (its entries are 0, 1 and −1): a quarter turn about z for ±x, a
/// quarter turn about x for ±z, and a half turn about x for −y.
[[nodiscard]] glm::dmat3 rotationToUp(UpAxis up);

/// Length unit and axes of a source file.
struct SourceFrame {
    std::optional<double> metres;  ///< per unit of the file
    std::optional<UpAxis> up;
    /// The file is left-handed; assimp has already negated z.
    bool mirrored = false;
    /// An invalid unit or axis in the file, as a clause: "its unit is -1 m". "": none.
    std::string unit_fault{};
    std::string up_fault{};
};

/// Fails if the file's unit or axis is invalid and the caller does not override it.
/// Errors, without the file name: kInvalidInput, naming the option to use.
[[nodiscard]] Result<void> checkFrame(const SourceFrame& source, std::string_view unit,
                                      std::optional<UpAxis> up);

struct FrameChange {
    double scale = 1.0;
    glm::dmat3 turn{1.0};
    std::string unit;  ///< "m", or "" if unknown
    /// About overrides by the caller; without the file name.
    std::vector<std::string> warnings;
};

/// Computes the conversion to metres and +Y up.
/// \param unit  one of kLengthUnits, or "" for the file's unit.
/// \param up    nullopt for the file's axis.
[[nodiscard]] FrameChange changeOf(const SourceFrame& source, std::string_view unit,
                                   std::optional<UpAxis> up);

/// Treatment of geometry that the file hides: hidden objects and lower levels of detail.
enum class HiddenMode : std::uint8_t { kSkip, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<HiddenMode>{"skip", "keep"};

struct ImportOptions {
    /// Length unit of the source, one of kLengthUnits; the mesh is converted to metres. "": the file's unit. If the
    /// file has none, lengths are unchanged and the mesh's unit is "".
    std::string unit;
    /// Up axis of the source; the mesh is rotated so that this axis becomes +Y. nullopt: the file's axis. If the
    /// file has none, axes are unchanged.
    std::optional<UpAxis> up;
    HiddenMode hidden = HiddenMode::kSkip;
    /// Names that mark triangles (TriangleMesh::marks): of nodes, including their descendants, of meshes, of materials,
    /// and of OBJ groups and objects. Clean UTF-8 (cleanUtf8); at most kSelectedNamesMax names of at most
    /// kSelectedNameBytesMax bytes. Names in the file are cleaned and truncated in the same way. If a name matches no
    /// triangle, the import fails (kUsage) and lists the existing names.
    std::vector<std::string> names{};
    bool materials = true;  ///< in a level, meshes that differ only in materials stay separate
};

struct ImportLimits {
    std::uint64_t memory = 4'000'000'000;  ///< bytes for the importer, in addition to its code and the file
    std::uint32_t seconds = 60;            ///< limit on processor time and on wall time; at least 1
    /// Maximum number of triangles, counting each instance; 1 to kTriangleMax. A bake takes about 160 bytes for each.
    std::uint64_t triangles = 20'000'000;
};

/// Excludes `names` and `materials`, set elsewhere.
void fields(FieldVisitor& visit, ImportOptions& options);
void fields(FieldVisitor& visit, ImportLimits& limits);

enum class ImportKind : std::uint8_t {
    kMesh,
    kLevel,     ///< each distinct mesh once, with its bodies (level.h)
    kAnimated,  ///< TriangleMesh::animation, from a glTF file
    kClips,     ///< the same with only nodes and clips
};
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<ImportKind>{"mesh", "level", "animated", "clips"};

struct ImportJob {
    std::string shown;      ///< the path for messages (quotedPath)
    std::string file_name;  ///< without its folder
    std::string extension;  ///< lower case, without the dot
    std::span<const std::byte> bytes;
    int folder = -1;  ///< descriptor of the file's folder; -1: no other files can be read
    ImportOptions options;
    std::uint64_t triangle_max = kTriangleMax;  ///< ImportLimits::triangles
    ImportKind kind = ImportKind::kMesh;
};

/// Reads the mesh; defined in the library bake_assimp. \return the input of ImportSource::finish. Errors: those of
/// importMesh.
[[nodiscard]] Result<TriangleMesh> importRaw(const ImportJob& job);

}  // namespace relief
