// SPDX-License-Identifier: Apache-2.0
// Valid arguments for every function of relief_runtime.h, one of which a test can replace. call_table.py generates the
// tables from relief_runtime.h, so new functions are tested without being listed here.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "formats/world/world.h"
#include "runtime/c_api/relief_runtime.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/temporary_folder.h"

namespace relief::c_api {

inline constexpr std::size_t kItems = 4;  // births, points, …
inline constexpr std::size_t kWrong = 2;  // the item that is made invalid

/// Expects the last error to contain this.
inline void expectError(const std::string& part) {
    EXPECT_NE(std::string(relief_error()).find(part), std::string::npos) << relief_error();
}

/// The function that frees each kind of object.
struct Release {
    static void of(relief_collider* made) { relief_collider_free(made); }
    static void of(relief_textures* made) { relief_textures_free(made); }
    static void of(relief_particles* made) { relief_particles_free(made); }
    static void of(relief_world* made) { relief_world_free(made); }
    static void of(relief_animation* made) { relief_animation_free(made); }
    static void of(relief_emitter* made) { relief_emitter_free(made); }
    static void of(relief_renderer* made) { relief_renderer_free(made); }
};

/// Valid objects: a collider, textures, particles, a renderer and a world; and memory for all inputs and outputs.
class Stage {
  public:
    Stage() {
        context_ = required(GlContext::create(GlApi::kGl33Core));
        Collider box = analytic::frontBackCollider(analytic::box({-0.4, -0.2, -0.3}, {0.4, 0.2, 0.3}), 16);
        box.materials.list = {{"cloth"}, {"felt"}};
        AnimatedMesh tube = bendingTube(8, 6);
        tube.materials = {"cloth"};
        tube.triangle_materials.resize(tube.triangles.size(), 0);
        box.animation = writeAnimatedMesh(tube);
        EXPECT_TRUE(saveCollider(path_, box));
        bytes_ = required(writeContainer(box));
        writeWorld(box);
        program_ = required(makeProgram("base/quad.vert", "particles/rebase.frag"));
        color_ = makeTexture2D(GL_RGBA8, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE);
        depth_ = makeTexture2D(GL_DEPTH_COMPONENT24, 16, 16, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
        framebuffer_ = required(makeFramebuffer({color_.name()}, depth_.name()));
        fill();
        revive();
    }
    ~Stage() {
        std::apply([](auto*... one) { (Release::of(one), ...); },
                   std::tuple(renderer, particles, textures, world_textures, animated_textures, emitter,
                              animation, collider, world));
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// Recreates objects that were freed (NULL).
    void revive() {
        collider = collider != nullptr ? collider : relief_collider_load(path_.c_str());
        textures = textures != nullptr ? textures : relief_textures_create(collider);
        particles = particles != nullptr ? particles : relief_particles_create(textures, &options);
        renderer = renderer != nullptr ? renderer : relief_renderer_create(textures, collider);
        world = world != nullptr ? world : relief_world_load(world_path_.c_str());
        world_textures = world_textures != nullptr ? world_textures : relief_textures_create_world(world);
        animation = animation != nullptr ? animation : relief_animation_create(collider);
        if (animated_textures == nullptr) {
            relief_world* single = relief_world_create();
            EXPECT_EQ(relief_world_add(single, animation, poses, 64, nullptr), 0) << relief_error();
            animated_textures = relief_textures_create_world(single);
            relief_world_free(single);
        }
        emitter =
            emitter != nullptr ? emitter : relief_emitter_create_on(collider, nullptr, &emitter_options);
        ASSERT_TRUE(collider != nullptr && textures != nullptr && particles != nullptr &&
                    renderer != nullptr && world != nullptr && world_textures != nullptr &&
                    animation != nullptr && animated_textures != nullptr && emitter != nullptr)
            << relief_error();
    }
    /// Resets everything that a test may have changed to valid values.
    void fill() {
        options = {};
        options.size = sizeof(options);
        options.capacity = 64;
        options.gravity[1] = -1.0F;
        for (std::size_t i = 0; i < kItems; ++i) {
            births[i] = {};
            births[i].position[0] = 0.1F * static_cast<float>(i);
            births[i].position[1] = 1.0F;
            births[i].lifetime = 100.0F;
            for (std::size_t k = 0; k < 3; ++k) {
                points[3 * i + k] = 0.1F * static_cast<float>(i + k);
            }
        }
        for (std::uint32_t i = 0; i < kItems; ++i) {
            bodies[i] = i;
            poses[i] = {{0.0F, 0.0F, 0.0F}, {0.0F, 0.6F, 0.0F, 0.8F}};
            spheres[i] = {{0.0F, 0.0F, 0.0F}, 1.0F};
        }
        emitter_options = {};
        emitter_options.size = sizeof(emitter_options);
        emitter_options.rate = 500.0F;
        emitter_options.lifetime_min = emitter_options.lifetime_max = 1.0F;
        renderer_options = {};
        renderer_options.size = sizeof(renderer_options);
        view = {};
        view.size = sizeof(view);
        for (int k = 0; k < 4; ++k) {
            view.view[5 * k] = 1.0F;
        }
        view.view[14] = -4.0F;
        view.projection[0] = view.projection[5] = 2.0F;
        view.projection[10] = view.projection[11] = -1.0F;
        view.projection[14] = -0.2F;
        view.framebuffer = framebuffer_.name();
        view.width = view.height = 16;
    }

    /// A valid value for an argument of this type and name.
    template <class T>
    T good(const std::string& name) {
        if constexpr (std::is_same_v<T, const char*>) {
            return name == "node"         ? "box 1"
                   : name == "clip"       ? "bend"
                   : name == "group"      ? "middle"
                   : name == "material"   ? "cloth"
                   : name == "world_path" ? world_path_.c_str()
                                          : path_.c_str();
        } else if constexpr (std::is_same_v<T, const void*>) {
            return bytes_.data();
        } else if constexpr (std::is_same_v<T, size_t>) {
            static const std::set<std::string> kOne{"body", "clip", "material", "joint", "weight_count"};
            return name == "size"          ? bytes_.size()
                   : name == "joint_count" ? 2
                   : name == "gpu_bytes"   ? std::size_t{1} << 20
                   : kOne.contains(name)   ? 1
                                           : kItems;
        } else if constexpr (std::is_same_v<T, float>) {
            return 0.01F;
        } else if constexpr (std::is_same_v<T, uint32_t>) {
            return name == "body" ? 0 : name == "resolution" ? 64 : program_.name();
        } else if constexpr (std::is_same_v<T, const relief_pose*>) {
            return name == "pose" ? &poses[kWrong] : poses;
        } else if constexpr (std::is_same_v<T, double>) {
            return 0.25;
        } else if constexpr (std::is_same_v<T, const float*>) {
            return name == "matrices"   ? matrices
                   : name == "weights"  ? weights
                   : name == "box_size" ? box_size
                   : name == "normal"   ? normal
                                        : points;
        } else if constexpr (std::is_same_v<T, int>) {
            return 0;
        } else if constexpr (std::is_same_v<T, float*>) {
            return name == "min" ? low : high;
        } else if constexpr (std::is_same_v<T, const std::uint32_t*>) {
            return bodies;
        } else if constexpr (std::is_same_v<T, relief_textures*>) {
            return name == "world_textures"      ? world_textures
                   : name == "animated_textures" ? animated_textures
                                                 : textures;
        } else {
            return pointer(T{});
        }
    }
    /// The address of the item to invalidate in the structures of this type that good() returns; null if no function
    /// reads them.
    std::byte* structure(const std::string& name) {
        void* found = name == "relief_particles_options"  ? static_cast<void*>(&options)
                      : name == "relief_birth"            ? &births[kWrong]
                      : name == "relief_pose"             ? &poses[kWrong]
                      : name == "relief_sphere"           ? &spheres[kWrong]
                      : name == "relief_renderer_options" ? &renderer_options
                      : name == "relief_emitter_options"  ? &emitter_options
                      : name == "relief_view"             ? static_cast<void*>(&view)
                                                          : nullptr;
        return static_cast<std::byte*>(found);
    }
    /// The handle of an argument's type, as a number.
    [[nodiscard]] std::uintptr_t handle(const std::string& type) const {
        const auto names = [&](const char* kind) { return type.find(kind) != std::string::npos; };
        return names("animation")   ? reinterpret_cast<std::uintptr_t>(animation)
               : names("emitter")   ? reinterpret_cast<std::uintptr_t>(emitter)
               : names("collider")  ? reinterpret_cast<std::uintptr_t>(collider)
               : names("textures")  ? reinterpret_cast<std::uintptr_t>(textures)
               : names("particles") ? reinterpret_cast<std::uintptr_t>(particles)
               : names("world")     ? reinterpret_cast<std::uintptr_t>(world)
                                    : reinterpret_cast<std::uintptr_t>(renderer);
    }
    /// Call after the object was freed; revive() creates another.
    void forget(std::uintptr_t handle) {
        const auto drop = [handle](auto*& one) {
            one = reinterpret_cast<std::uintptr_t>(one) == handle ? nullptr : one;
        };
        const auto handles = std::tie(collider, textures, particles, renderer, world, animation, emitter);
        std::apply([&](auto&... one) { (drop(one), ...); }, handles);
    }

    relief_collider* collider = nullptr;
    relief_textures* textures = nullptr;
    relief_particles* particles = nullptr;
    relief_renderer* renderer = nullptr;
    relief_world* world = nullptr;
    relief_textures* world_textures = nullptr;
    relief_animation* animation = nullptr;
    relief_emitter* emitter = nullptr;
    relief_emitter_options emitter_options;
    relief_textures* animated_textures = nullptr;  // of a world that contains only the animation
    relief_particles_options options;
    relief_birth births[kItems];
    std::uint32_t bodies[kItems];
    std::uint32_t bodies_found[kItems];
    relief_pose poses[kItems];
    relief_sphere spheres[kItems];
    relief_pose pose;  // output
    relief_renderer_options renderer_options;
    relief_view view;
    relief_particle states[kItems];
    relief_sample samples[kItems];
    float points[3 * kItems];
    float matrices[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    float weights[1] = {0.0F};
    float box_size[3] = {3.0F, 3.0F, 3.0F};
    float normal[3] = {0.0F, 1.0F, 0.0F};
    float low[3];
    float high[3];

  private:
    /// One box per item, two units apart. The second is rotated and scaled by 2; the last has the name of the first.
    void writeWorld(const Collider& box) {
        World file;
        file.colliders = {
            {{path_.filename().string(), xxh3_128Hex(bytes_), box.texelBytes()}, "box", box.bounds, {}}};
        for (std::uint32_t i = 0; i < kItems; ++i) {
            file.bodies.push_back({.collider = 0,
                                   .node = "box " + std::to_string(i % 3),
                                   .position = {2.0F * static_cast<float>(i), 0.0F, 0.0F}});
        }
        file.bodies[1].rotation = {0.0F, 0.6F, 0.0F, 0.8F};
        file.bodies[1].scale = 2.0F;
        folder_.write("boxes.json", worldText(file));
    }

    /// The object to pass for an argument of type T. A new type in the header fails to compile until it is added here.
    template <class T>
    T pointer(T /*type*/) {
        using Thing = std::remove_const_t<std::remove_pointer_t<T>>;
        return std::get<Thing*>(std::tuple(collider, textures, world, particles, renderer, animation, emitter,
                                           &options, &births[0], &renderer_options, &emitter_options, &view,
                                           &states[0], &samples[0], &spheres[0], &pose, &bodies_found[0]));
    }

    std::unique_ptr<GlContext> context_;
    const test::TemporaryFolder folder_;
    const std::filesystem::path path_ = folder_.path() / "boxes.relief";
    const std::filesystem::path world_path_ = folder_.path() / "boxes.json";
    std::vector<std::byte> bytes_;
    GlProgram program_;
    GlTexture color_;
    GlTexture depth_;
    GlFramebuffer framebuffer_;
};

enum class Outcome : std::uint8_t { kNothing, kSuccess, kFailure };

template <class T>
Outcome outcomeOf(const T& returned) {
    if constexpr (std::is_same_v<T, relief_counts>) {
        return Outcome::kNothing;  // 0 is ambiguous
    } else if constexpr (std::is_same_v<T, const char*>) {
        return returned != nullptr ? Outcome::kNothing : Outcome::kFailure;  // "" is ambiguous
    } else if constexpr (std::is_pointer_v<T>) {
        Release::of(returned);
        return returned != nullptr ? Outcome::kSuccess : Outcome::kFailure;
    } else if constexpr (std::is_signed_v<T>) {
        return returned >= 0 ? Outcome::kSuccess : Outcome::kFailure;
    } else {
        return returned > 0 ? Outcome::kSuccess : Outcome::kNothing;  // 0 is ambiguous
    }
}

struct Argument {
    std::string name;
    std::string type;
    [[nodiscard]] bool isPointer() const { return type.back() == '*'; }
    [[nodiscard]] bool isHandle() const {
        static const std::regex kHandle(
            "(const )?relief_(collider|textures|particles|renderer|world|animation|emitter)\\*");
        return std::regex_match(type, kHandle);
    }
};

struct Arguments;
struct Function {
    std::string name;
    std::vector<Argument> arguments;
    Outcome (*call)(Arguments&);
    [[nodiscard]] bool frees() const { return name.ends_with("_free"); }
};

/// The stage's arguments, one of which is replaced.
struct Arguments {
    Stage& stage;
    const Function& function;
    std::size_t other = ~std::size_t{0};
    std::uint64_t whole = 0;  // the replacement as a pointer or an integer
    float real = 0.0F;        // the replacement as a float

    template <class T>
    T get(std::size_t i) {
        if (i != other) {
            return stage.good<T>(function.arguments[i].name);
        }
        if constexpr (std::is_pointer_v<T>) {
            return reinterpret_cast<T>(static_cast<std::uintptr_t>(whole));
        } else if constexpr (std::is_floating_point_v<T>) {
            return real;
        } else {
            return static_cast<T>(whole);
        }
    }
};

enum class NumberKind : std::uint8_t { kFloat, kInteger };
template <class T>
struct Number {
    static constexpr NumberKind kKind =
        std::is_floating_point_v<T> ? NumberKind::kFloat : NumberKind::kInteger;
};

struct Field {
    std::string name;
    NumberKind kind;
    std::size_t offset;
    std::size_t bytes;
    std::size_t count;
    bool array;
};

struct Structure {
    std::string name;
    std::size_t bytes;
    std::vector<Field> fields;
};

}  // namespace relief::c_api
