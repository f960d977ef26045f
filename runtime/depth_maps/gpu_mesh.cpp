// SPDX-License-Identifier: Apache-2.0
#include "runtime/depth_maps/gpu_mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "formats/base/finite.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr GLuint kVertexAttribute = 0;

/// Returns log2 of the smallest power-of-two width for which the height does not exceed it.
int shiftFor(std::uint32_t count) {
    int shift = 0;
    while ((std::uint64_t{1} << (2 * shift)) < count) {
        ++shift;
    }
    return shift;
}

GLsizei rowsFor(std::uint32_t count, int shift) {
    return static_cast<GLsizei>((count + (1U << shift) - 1) >> shift);
}

Result<void> checkFinite(std::span<const glm::vec3> positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::vec3& p = positions[i];
        if (!isFinite(p)) {
            return fail(ErrorCode::kInvalidInput, "position " + std::to_string(i) +
                                                      " of a mesh is not finite; repair the mesh or the "
                                                      "program that moves it");
        }
    }
    return {};
}

struct Slots {
    std::vector<std::uint32_t> vertex;   // for each slot
    std::vector<glm::uvec3> corners;     // vertices of each triangle, its provoking corner last
    std::vector<std::uint32_t> indices;  // slots, three per triangle
};

/// Assigns each triangle its own corner: a vertex that no earlier triangle owns, if there is one.
Slots assignSlots(std::uint32_t vertices, std::span<const glm::uvec3> triangles) {
    Slots slots;
    slots.corners.reserve(triangles.size());
    slots.vertex.reserve(triangles.size() + vertices);
    std::vector<std::uint32_t> slot_of(vertices, kNone);
    for (const glm::uvec3& t : triangles) {
        const std::array<std::uint32_t, 3> corner = {t.x, t.y, t.z};
        std::size_t own = 2;
        for (std::size_t i = 0; i < 3; ++i) {
            if (slot_of[corner[i]] == kNone) {
                own = i;
                break;
            }
        }
        const auto slot = static_cast<std::uint32_t>(slots.vertex.size());
        slots.vertex.push_back(corner[own]);
        slot_of[corner[own]] = slot_of[corner[own]] == kNone ? slot : slot_of[corner[own]];
        slots.corners.emplace_back(corner[(own + 1) % 3], corner[(own + 2) % 3], corner[own]);
    }
    slots.indices.reserve(3 * triangles.size());
    const auto slotOf = [&](std::uint32_t vertex) {
        if (slot_of[vertex] == kNone) {
            slot_of[vertex] = static_cast<std::uint32_t>(slots.vertex.size());
            slots.vertex.push_back(vertex);
        }
        return slot_of[vertex];
    };
    for (std::size_t i = 0; i < slots.corners.size(); ++i) {
        slots.indices.push_back(slotOf(slots.corners[i].x));
        slots.indices.push_back(slotOf(slots.corners[i].y));
        slots.indices.push_back(static_cast<std::uint32_t>(i));
    }
    return slots;
}

tl::unexpected<Error> tooLarge(const std::string& what, std::uint64_t count, std::uint64_t most) {
    return fail(ErrorCode::kLimit, "a mesh of " + std::to_string(count) + " " + what +
                                       " exceeds the limit of this GL context, " + std::to_string(most) +
                                       "; simplify the mesh");
}

/// Checks that this GL context's textures and draws support this many vertices and triangles.
Result<void> checkSize(std::size_t vertices, std::size_t triangles) {
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    GLint64 index_max = 0;
    glGetInteger64v(GL_MAX_ELEMENT_INDEX, &index_max);
    // One draw has 3 indices per triangle, counted in a GLsizei.
    const auto draw_max = static_cast<std::uint64_t>(std::numeric_limits<GLsizei>::max() / 3);
    std::uint64_t power = 1;  // a power of two: side of the largest usable texture
    while (2 * power <= static_cast<std::uint64_t>(side)) {
        power *= 2;
    }
    const std::uint64_t texels = power * power;
    const std::uint64_t most = std::min(texels, draw_max);
    if (vertices > most) {
        return tooLarge("vertices", vertices, most);
    }
    if (triangles > most) {
        return tooLarge("triangles", triangles, most);
    }
    // The number of slots is not known yet; this check bounds the memory for computing it.
    if (index_max > 0 && triangles > static_cast<std::uint64_t>(index_max)) {
        return tooLarge("triangles", triangles, static_cast<std::uint64_t>(index_max));
    }
    return {};
}

}  // namespace

Result<GpuMesh> GpuMesh::create(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    RELIEF_TRY(checkContext());
    if (triangles.empty() || positions.empty()) {
        return fail(ErrorCode::kInvalidInput, "a mesh without triangles cannot be rendered; add triangles");
    }
    RELIEF_TRY(checkSize(positions.size(), triangles.size()));
    RELIEF_TRY(checkFinite(positions));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3& t = triangles[i];
        if (std::max({t.x, t.y, t.z}) >= positions.size()) {
            return fail(ErrorCode::kInvalidInput,
                        "triangle " + std::to_string(i) + " of a mesh uses vertex " +
                            std::to_string(std::max({t.x, t.y, t.z})) + ", but there are only " +
                            std::to_string(positions.size()) + " vertices; repair the mesh");
        }
    }
    GpuMesh mesh;
    mesh.vertex_count_ = static_cast<std::uint32_t>(positions.size());
    mesh.triangle_count_ = static_cast<std::uint32_t>(triangles.size());
    const PassState state;
    RELIEF_TRY(mesh.createTextures(triangles));
    mesh.upload(positions.data());
    mesh.revision_ = 1;
    return mesh;
}

Result<void> GpuMesh::createTextures(std::span<const glm::uvec3> triangles) {
    Slots slots = assignSlots(vertex_count_, triangles);
    slot_count_ = static_cast<std::uint32_t>(slots.vertex.size());
    GLint64 index_max = 0;
    glGetInteger64v(GL_MAX_ELEMENT_INDEX, &index_max);
    if (index_max > 0 && slot_count_ > static_cast<std::uint64_t>(index_max)) {
        return tooLarge("corners", slot_count_, static_cast<std::uint64_t>(index_max));
    }
    vertex_shift_ = shiftFor(vertex_count_);
    triangle_shift_ = shiftFor(triangle_count_);
    const auto allocated = [&] {
        return checkAllocated("a mesh of " + std::to_string(triangle_count_) + " triangles", "simplify it");
    };
    clearGlErrors();
    for (GlTexture& positions : positions_) {
        positions = makeTexture2D(GL_RGB32F, 1 << vertex_shift_, rowsFor(vertex_count_, vertex_shift_),
                                  GL_RGB, GL_FLOAT);
    }
    const GLsizei rows = rowsFor(triangle_count_, triangle_shift_);
    std::vector<std::uint32_t> texels(std::size_t{4} * static_cast<std::size_t>(rows) << triangle_shift_, 0U);
    for (std::size_t i = 0; i < slots.corners.size(); ++i) {
        std::copy_n(&slots.corners[i].x, 3, &texels[4 * i]);
    }
    corners_ = makeTexture2D(GL_RGBA32UI, 1 << triangle_shift_, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                             texels.data());
    planes_ = makeTexture2D(GL_RGBA32UI, 1 << triangle_shift_, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT);
    RELIEF_TRY(allocated());
    planes_target_ = RELIEF_TRY(makeFramebuffer({planes_.name()}));
    planes_program_ = RELIEF_TRY(makeScreenProgram("depth_maps/triangle_plane.frag"));
    planes_program_.use();
    planes_program_.set("u_positions", 0);
    planes_program_.set("u_corners", 1);
    planes_program_.set("u_shift", vertex_shift_);

    slots_ = makeBuffer();
    indices_ = makeBuffer();
    array_ = makeVertexArray();
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, slots_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(slots.vertex.size() * sizeof(std::uint32_t)),
                 slots.vertex.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(kVertexAttribute);
    glVertexAttribIPointer(kVertexAttribute, 1, GL_UNSIGNED_INT, 0, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(slots.indices.size() * sizeof(std::uint32_t)), slots.indices.data(),
                 GL_STATIC_DRAW);
    return allocated();
}

/// Uploads the current positions.
/// \param data  pointer to memory or, with a pixel unpack buffer bound, an offset into it.
void GpuMesh::upload(const void* data) {
    const std::uint32_t width = 1U << vertex_shift_;
    const std::uint32_t rows = vertex_count_ >> vertex_shift_;
    const std::uint32_t rest = vertex_count_ - rows * width;
    useTexture(0, positions_[current_]);
    if (rows > 0) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(rows),
                        GL_RGB, GL_FLOAT, data);
    }
    if (rest > 0) {
        const std::size_t done = std::size_t{rows} * width * sizeof(glm::vec3);
        // An offset may be a null pointer, on which arithmetic is undefined.
        const auto* const from = reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(data) + done);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(rows), static_cast<GLsizei>(rest), 1, GL_RGB,
                        GL_FLOAT, from);
    }
}

Result<void> GpuMesh::setPositions(std::span<const glm::vec3> positions) {
    if (positions.size() != vertex_count_) {
        return fail(ErrorCode::kUsage, std::to_string(positions.size()) + " positions for a mesh of " +
                                           std::to_string(vertex_count_) +
                                           " vertices; keep the number of vertices, or create another mesh");
    }
    RELIEF_TRY(checkFinite(positions));
    const PassState state;
    current_ = 1 - current_;
    moved_ = true;
    upload(positions.data());
    ++revision_;
    return {};
}

Result<void> GpuMesh::setPositions(GLuint buffer, std::size_t offset) {
    if (buffer == 0 || glIsBuffer(buffer) != GL_TRUE) {
        return fail(ErrorCode::kUsage, "positions of a mesh were set from " + std::to_string(buffer) +
                                           ", which is not a buffer; use one that has been bound");
    }
    if (offset % sizeof(float) != 0) {
        return fail(ErrorCode::kUsage, "positions of a mesh were set to start at byte " +
                                           std::to_string(offset) + " of a buffer; use a multiple of 4");
    }
    const PassState state;
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
    GLint64 size = 0;
    glGetBufferParameteri64v(GL_PIXEL_UNPACK_BUFFER, GL_BUFFER_SIZE, &size);
    const std::uint64_t needed = std::uint64_t{vertex_count_} * sizeof(glm::vec3);
    const auto room = static_cast<std::uint64_t>(size);
    if (offset > room || room - offset < needed) {
        return fail(ErrorCode::kUsage, "positions of a mesh take " + std::to_string(needed) +
                                           " bytes from byte " + std::to_string(offset) +
                                           " on, but the buffer has " + std::to_string(size) +
                                           "; use a larger one");
    }
    current_ = 1 - current_;
    moved_ = true;
    upload(reinterpret_cast<const void*>(offset));
    ++revision_;
    return {};
}

void GpuMesh::settle() {
    moved_ = false;
}

GLuint GpuMesh::previousPositions() const {
    return moved_ ? positions_[1 - current_].name() : positions();
}

GLuint GpuMesh::planes() {
    if (planes_revision_ != revision_) {
        planes_revision_ = revision_;
        useTexture(0, positions());
        useTexture(1, corners());
        planes_program_.drawScreen(planes_target_.name(), 1 << triangle_shift_,
                                   rowsFor(triangle_count_, triangle_shift_));
    }
    return planes_.name();
}

void GpuMesh::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangle_count_), GL_UNSIGNED_INT, nullptr);
}

}  // namespace relief
