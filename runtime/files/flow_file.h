// Flow fields from files: OpenEXR images and raw volumes. The only file of the player that knows OpenEXR.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/scene_limits.h"
#include "runtime/air/flow_field.h"

namespace relief {

/// The key of the scene that names the file, for each: file, files, raw.
enum class FlowFileKind : int {
    kImage,   ///< one EXR image: a flow in the plane of x and y, the same at every z
    kSlices,  ///< numbered EXR images, from the lowest z up
    kRaw,     ///< little-endian 32-bit floats; x fastest, then y, then z
};

/// A scene's [flow].
///
/// Images have float or half channels R and G, the velocity along x and y, and may have B, along z; the
/// bottom row lies at the lowest y, as a viewer shows it.
struct FlowFile {
    FlowFileKind kind = FlowFileKind::kImage;
    std::filesystem::path path;  ///< kSlices: its file name holds one %d, %2d, %02d …, counting from 0 or 1
    std::string origin;          ///< "scene.toml:3:8: flow.raw: ", put before every message; may be empty
    std::array<std::uint32_t, 3> size{};  ///< kRaw: nodes along x, y, z
    std::uint32_t components = 3;         ///< kRaw: floats a node, 3 or 2 (then without any z)
    glm::vec3 box_min{0.0F};
    glm::vec3 box_max{1.0F};
    FlowOutside outside = FlowOutside::kZero;
    float gain = 1.0F;
};
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<FlowFileKind>{"file", "files", "raw"};

template <class Visitor, FieldsOf<FlowFile> F>
void fields(Visitor& visit, F& flow) {
    const FieldFile path{flow.path, flow.origin};
    visit("file", path,
          {"EXR image: channels R, G and maybe B are the velocity along x, y, z; its bottom row lies "
           "at the lowest y",
           {},
           {},
           "one of the three is required"});
    visit("files", path,
          {"EXR slices, as \"flow_%03d.exr\", numbered from 0 or 1, the lowest z first",
           {},
           {},
           "none",
           {.instead_of = "file"}});
    visit("raw", path,
          {"Little-endian 32-bit floats, x fastest, then y, then z",
           {},
           {},
           "none",
           {.instead_of = "file files"}});
    visit("size", flow.size,
          {"Nodes of the raw volume, 2²⁴ at most",
           "[nx, ny, nz]",
           {1.0, FlowField::kSideMax},
           "required by raw",
           {.needs = "raw"}});
    visit("components", flow.components, {"Floats a node", {}, {2.0, 3.0}, {}, {.needs = "raw"}});
    visit("box_min", flow.box_min,
          {"Lower corner of the flow's box", "[x, y, z]", kPointRange, {}, kRequired});
    visit("box_max", flow.box_max,
          {"Upper corner of the flow's box", "[x, y, z]", kPointRange, {}, kRequired});
    visit("outside", flow.outside,
          {"Velocity outside of the box: 0, or that of the nearest point of the box"});
    visit("gain", flow.gain, {"Factor of every velocity", {}, within(1e6), {}, {.not_zero = true}});
}

/// The largest velocity taken, in either direction: object units a second.
inline constexpr float kFlowSpeedMax = 1e6F;

/// Whether a file name holds exactly one number for kSlices, of 9 digits at most.
[[nodiscard]] bool hasSliceNumber(const std::string& name);

/// The files of a flow that are there: those with its number, or the one.
[[nodiscard]] std::vector<std::filesystem::path> flowPaths(const FlowFile& file);

/// Reads a flow; the files may be hostile.
/// Errors, with the file's name: kIo, kInvalidInput (not EXR, channels missing, a wrong length, slices of
/// different sizes or with a gap, a velocity that is not finite or above kFlowSpeedMax), kLimit (see
/// FlowField).
[[nodiscard]] Result<FlowField> loadFlow(const FlowFile& file);

}  // namespace relief
