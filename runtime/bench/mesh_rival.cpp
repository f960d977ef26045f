// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "runtime/bench/rival_step.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr std::size_t kTextureWidth = 4096;

struct Layout {
    GLenum internal_format, format, type;
};
constexpr Layout kWords4{GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
constexpr Layout kWords1{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
constexpr Layout kFloats4{GL_RGBA32F, GL_RGBA, GL_FLOAT};

/// Adds a texture that is kTextureWidth texels wide. Pads the last row with zeros.
template <class Texel>
Result<void> upload(Rival& rival, const char* sampler, const Layout& layout, std::vector<Texel> texels) {
    const std::size_t rows = (texels.size() + kTextureWidth - 1) / kTextureWidth;
    RELIEF_TRY(checkTextureSize(kTextureWidth, rows, "the triangles", "use a mesh with fewer triangles"));
    texels.resize(rows * kTextureWidth, Texel(0));
    rival.textures.push_back(
        {sampler, makeTexture2D(layout.internal_format, GLsizei{kTextureWidth}, static_cast<GLsizei>(rows),
                                layout.format, layout.type, texels.data())});
    return {};
}

}  // namespace

Result<Rival> makeMeshRival(const MeshTree& tree, bool keeps) {
    const PassState state;
    Rival rival;
    rival.shader = {"bench/mesh_step.frag", "#define RELIEF_TREE_WIDTH " + std::to_string(kTextureWidth) +
                                                "\n#define RELIEF_TREE_STACK " +
                                                std::to_string(std::max(tree.stack, 1U)) + "\n" +
                                                (keeps ? "#define RELIEF_KEPT\n" : "")};
    rival.keeps = keeps;
    rival.bytes = tree.bytes();
    clearGlErrors();
    RELIEF_TRY(upload(rival, "u_nodes", kWords4, tree.nodes));
    RELIEF_TRY(upload(rival, "u_triangles", kWords4, tree.triangles));
    RELIEF_TRY(upload(rival, "u_vertices", kWords1, tree.vertices));
    RELIEF_TRY(upload(rival, "u_normals", kFloats4, tree.normals));
    RELIEF_TRY(checkAllocated("the triangles", "use a mesh with fewer triangles"));
    rival.set = [box = tree.box](const GlProgram& program) {
        program.set("u_box_min", box.min);
        program.set("u_box_max", box.max);
    };
    return rival;
}

}  // namespace relief
