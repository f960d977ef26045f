#include "runtime/collider_textures.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "runtime/pass_state.h"

namespace relief {
namespace {

/// The three texel layouts that the shader samples, each in a texture array of its own.
struct Layout {
    const char* sampler;
    GLenum internal_format;
    GLenum format;
    GLenum type;
    std::size_t texel_size;
};
constexpr std::array<Layout, 3> kLayouts = {{
    {"u_relief_float", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"u_relief_fixed", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {"u_relief_front_back", GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8},
}};

std::size_t layoutOf(MapFormat format) {
    switch (format) {
        case MapFormat::kFloat32:
            return 0;
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            return 2;
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            return 1;
    }
    return 1;
}

/// Where a map's texel (0, 0) lies: in layer `layer`, and a cube's face f in layer `layer` + f.
struct Place {
    GLint x = 0;
    GLint y = 0;
    GLint layer = 0;
};

/// Fills the layers of one texture array with rectangles, shelf by shelf from the bottom up. Cubes take
/// stacks of six layers, other maps stacks of one.
class LayerPacker {
  public:
    LayerPacker(GLint width, GLint height) : width_(width), height_(height) {}

    Place add(GLint width, GLint height, GLint depth) {
        for (Stack& stack : stacks_) {
            if (stack.depth == depth && fits(stack, width, height)) {
                return take(stack, width, height);
            }
        }
        stacks_.push_back({layers_, depth, 0, 0, 0});
        layers_ += depth;
        return take(stacks_.back(), width, height);
    }
    [[nodiscard]] GLint layers() const { return layers_; }

  private:
    struct Stack {
        GLint layer;
        GLint depth;
        GLint x;  // next free column of the shelf
        GLint y;  // lower edge of the shelf
        GLint shelf_height;
    };

    bool fits(const Stack& stack, GLint width, GLint height) const {
        const bool on_shelf = stack.x + width <= width_ && stack.y + height <= height_;
        const bool on_next = stack.y + stack.shelf_height + height <= height_;
        return on_shelf || on_next;
    }
    Place take(Stack& stack, GLint width, GLint height) const {
        if (stack.x + width > width_ || stack.y + height > height_) {
            stack.y += stack.shelf_height;
            stack.x = 0;
            stack.shelf_height = 0;
        }
        const Place place{stack.x, stack.y, stack.layer};
        stack.x += width;
        stack.shelf_height = std::max(stack.shelf_height, height);
        return place;
    }

    GLint width_;
    GLint height_;
    GLint layers_ = 0;
    std::vector<Stack> stacks_;
};

/// One element of the shader's ReliefMap array, std140.
struct BlockMap {
    glm::vec4 row[3];
    glm::vec4 object_per_map;
    std::int32_t rect[4];
    std::int32_t info[4];
};
static_assert(sizeof(BlockMap) == 96);
constexpr std::size_t kBlockHead = 16;

BlockMap blockMap(const DepthMap& map, const Place& place) {
    constexpr int kKeepsFarthest = 1;
    constexpr int kEncloses = 2;
    constexpr int kEmptyIsOutside = 4;
    constexpr int kPlane = 8;
    BlockMap block{};
    std::copy(std::begin(map.object_to_map.row), std::end(map.object_to_map.row), std::begin(block.row));
    block.object_per_map = glm::vec4(
        map.object_per_map, standingRange(map.projection(), map.object_per_map, map.width, map.height));
    const std::int32_t rect[4] = {place.x, place.y, place.layer, static_cast<std::int32_t>(map.width)};
    const std::int32_t flags = (map.compare == Compare::kGreater ? kKeepsFarthest : 0) |
                               (map.encloses ? kEncloses : 0) | (map.empty_is_outside ? kEmptyIsOutside : 0) |
                               (map.decode == Decode::kPlane ? kPlane : 0);
    const std::int32_t info[4] = {static_cast<std::int32_t>(map.height),
                                  static_cast<std::int32_t>(map.format), flags, 0};
    std::memcpy(block.rect, rect, sizeof(rect));
    std::memcpy(block.info, info, sizeof(info));
    return block;
}

GlTexture makeArray(const Layout& layout, GLint width, GLint height, GLint layers) {
    GLuint name = 0;
    glGenTextures(1, &name);
    GlTexture texture(name);
    glBindTexture(GL_TEXTURE_2D_ARRAY, name);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
        glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
    }
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
        glTexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_CLAMP_TO_EDGE);
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(layout.internal_format), width, height, layers, 0,
                 layout.format, layout.type, nullptr);
    return texture;
}

GLint limit(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

}  // namespace

Result<ColliderTextures> ColliderTextures::create(const Collider& collider) {
    if (collider.maps.empty()) {
        return fail(ErrorCode::kUnsupported, "a collider without maps has nothing to collide with");
    }
    const auto block_max = static_cast<std::size_t>(limit(GL_MAX_UNIFORM_BLOCK_SIZE));
    const std::size_t map_max = (block_max - kBlockHead) / sizeof(BlockMap);
    if (collider.maps.size() > map_max) {
        return fail(ErrorCode::kLimit, "the collider has " + std::to_string(collider.maps.size()) +
                                           " maps, this GL takes " + std::to_string(map_max) +
                                           "; bake it with fewer");
    }

    // One array a layout, its layers as large as the largest of its maps.
    std::array<GLint, 3> width{};
    std::array<GLint, 3> height{};
    const GLint size_max = limit(GL_MAX_TEXTURE_SIZE);
    for (const DepthMap& map : collider.maps) {
        const auto w = static_cast<GLint>(map.width);
        const auto h = static_cast<GLint>(map.height);
        if (std::max(w, h) > size_max) {
            return fail(ErrorCode::kLimit, "a map has " + std::to_string(w) + "x" + std::to_string(h) +
                                               " texels, this GL takes " + std::to_string(size_max) +
                                               " along a side; bake it with a smaller size");
        }
        const std::size_t layout = layoutOf(map.format);
        width[layout] = std::max(width[layout], w);
        height[layout] = std::max(height[layout], h);
    }
    std::array<LayerPacker, 3> packers = {LayerPacker{width[0], height[0]}, LayerPacker{width[1], height[1]},
                                          LayerPacker{width[2], height[2]}};
    std::vector<Place> places;
    std::vector<BlockMap> blocks;
    for (const DepthMap& map : collider.maps) {
        places.push_back(packers[layoutOf(map.format)].add(static_cast<GLint>(map.width),
                                                           static_cast<GLint>(map.height),
                                                           static_cast<GLint>(map.faceCount())));
        blocks.push_back(blockMap(map, places.back()));
    }

    const PassState state;                 // row lengths and skips among it: texels are tightly packed
    while (glGetError() != GL_NO_ERROR) {  // of the caller, not ours
    }
    ColliderTextures result;
    const std::array<GlTexture*, 3> arrays = {&result.float_maps_, &result.fixed_maps_,
                                              &result.front_back_maps_};
    const GLint layer_max = limit(GL_MAX_ARRAY_TEXTURE_LAYERS);
    glActiveTexture(GL_TEXTURE0);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        if (packers[i].layers() > layer_max) {
            return fail(ErrorCode::kLimit, "the collider's maps need " + std::to_string(packers[i].layers()) +
                                               " texture layers, this GL takes " + std::to_string(layer_max) +
                                               "; bake it with fewer maps");
        }
        // A layout that no map uses still gets one texel, for a sampler must have something bound.
        const GLint layers = std::max(packers[i].layers(), 1);
        *arrays[i] = makeArray(kLayouts[i], std::max(width[i], 1), std::max(height[i], 1), layers);
        result.bytes_ += kLayouts[i].texel_size * static_cast<std::size_t>(width[i]) *
                         static_cast<std::size_t>(height[i]) * static_cast<std::size_t>(packers[i].layers());
    }
    for (std::size_t m = 0; m < collider.maps.size(); ++m) {
        const DepthMap& map = collider.maps[m];
        const std::size_t i = layoutOf(map.format);
        glBindTexture(GL_TEXTURE_2D_ARRAY, arrays[i]->name());
        // The faces of a cube follow each other in the payload as the layers do in the array.
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, places[m].x, places[m].y, places[m].layer,
                        static_cast<GLsizei>(map.width), static_cast<GLsizei>(map.height),
                        static_cast<GLsizei>(map.faceCount()), kLayouts[i].format, kLayouts[i].type,
                        map.texels.data());
    }

    result.block_ = makeBuffer();
    std::vector<std::byte> bytes(kBlockHead + blocks.size() * sizeof(BlockMap));
    const auto count = static_cast<std::int32_t>(blocks.size());
    std::memcpy(bytes.data(), &count, sizeof(count));
    std::memcpy(bytes.data() + kBlockHead, blocks.data(), blocks.size() * sizeof(BlockMap));
    glBindBuffer(GL_UNIFORM_BUFFER, result.block_.name());
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);

    if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
        return fail(error == GL_OUT_OF_MEMORY ? ErrorCode::kLimit : ErrorCode::kFailure,
                    "uploading the collider's " + std::to_string(result.bytes_) +
                        " bytes of maps failed (GL error " + std::to_string(error) + ")");
    }
    result.map_count_ = static_cast<int>(blocks.size());
    result.defines_ = "#define RELIEF_MAP_CAPACITY " + std::to_string(blocks.size()) + "\n";
    // What no map needs is left out of the shader: a GL may run every branch for every map.
    const auto defineIf = [&](const char* name, auto&& needed) {
        if (std::any_of(collider.maps.begin(), collider.maps.end(), needed)) {
            result.defines_ += std::string("#define RELIEF_HAS_") + name + "\n";
        }
    };
    defineIf("FLOAT", [](const DepthMap& map) { return map.format == MapFormat::kFloat32; });
    defineIf("FIXED", [](const DepthMap& map) { return map.format == MapFormat::kFixed8; });
    defineIf("CUBE", [](const DepthMap& map) { return map.format == MapFormat::kCube8; });
    defineIf("FRONT_BACK", [](const DepthMap& map) { return isFrontBack(map.format); });
    defineIf("PLANE", [](const DepthMap& map) { return map.decode == Decode::kPlane; });
    defineIf("PROJECTED", [](const DepthMap& map) { return map.decode == Decode::kProjected; });
    return result;
}

void ColliderTextures::attach(const GlProgram& program, const Binding& binding) const {
    glUseProgram(program.name());
    for (std::size_t i = 0; i < kLayouts.size(); ++i) {
        glUniform1i(glGetUniformLocation(program.name(), kLayouts[i].sampler),
                    binding.first_unit + static_cast<GLint>(i));
    }
    const GLuint index = glGetUniformBlockIndex(program.name(), "ReliefCollider");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program.name(), index, static_cast<GLuint>(binding.uniform_block));
    }
}

void ColliderTextures::bind(const Binding& binding) const {
    const std::array<GLuint, 3> names = {float_maps_.name(), fixed_maps_.name(), front_back_maps_.name()};
    for (std::size_t i = 0; i < names.size(); ++i) {
        glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + binding.first_unit + static_cast<int>(i)));
        glBindTexture(GL_TEXTURE_2D_ARRAY, names[i]);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

}  // namespace relief
