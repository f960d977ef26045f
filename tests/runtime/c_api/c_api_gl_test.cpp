// SPDX-License-Identifier: Apache-2.0
// Every invalid argument of a function of relief_runtime.h gives an error that names it, and changes nothing else:
// every argument NULL, freed, of another kind, or out of range; every field of every structure not finite; every wrong
// size.
#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/c_api/stage.h"

namespace relief::c_api {
namespace {

#include "c_api_table.inc"

const std::string kDead = " is not a live relief_";
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

const std::set<std::pair<std::string, std::string>> kMayBeNull{
    {"relief_collider_free", "collider"},    {"relief_textures_free", "textures"},
    {"relief_particles_free", "particles"},  {"relief_renderer_free", "renderer"},
    {"relief_particles_create", "textures"}, {"relief_particles_create", "options"},
    {"relief_renderer_draw", "options"},     {"relief_world_free", "world"},
    {"relief_animation_free", "animation"},  {"relief_world_add", "box_size"},
    {"relief_emitter_free", "emitter"},      {"relief_emitter_create", "group"},
    {"relief_emitter_create", "material"},   {"relief_emitter_create_on", "material"},
};
const std::set<std::string> kNeedContext{
    "relief_particles_create",   "relief_particles_free",    "relief_particles_read",
    "relief_particles_set",      "relief_particles_step",    "relief_renderer_create",
    "relief_renderer_draw",      "relief_renderer_free",     "relief_textures_attach",
    "relief_textures_bind",      "relief_textures_create",   "relief_textures_create_world",
    "relief_textures_free",      "relief_textures_set_clip", "relief_textures_set_joints",
    "relief_textures_set_poses", "relief_textures_stream",   "relief_textures_stream_world",
};

class CApi : public testing::Test {
  protected:
    void TearDown() override { EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)); }

    /// Calls the function, and recreates the objects of the stage that it freed.
    Outcome call(Arguments arguments) {
        const Outcome outcome = arguments.function.call(arguments);
        if (arguments.function.frees() && arguments.other != 0) {
            stage_.forget(stage_.handle(arguments.function.arguments[0].type));
            stage_.revive();
        }
        return outcome;
    }
    void expectGood(const Function& function) {
        const std::uint64_t before = relief_error_count();
        EXPECT_NE(call({stage_, function}), Outcome::kFailure) << function.name << ": " << relief_error();
        EXPECT_EQ(relief_error_count(), before) << function.name << ": " << relief_error();
    }
    /// \param says  expected in the message, besides the function's name.
    void expectRefused(const Arguments& arguments, const std::string& says) {
        const std::string what = arguments.function.name + ", " + says;
        const std::uint64_t before = relief_error_count();
        EXPECT_NE(call(arguments), Outcome::kSuccess) << what;
        EXPECT_EQ(relief_error_count(), before + 1) << what << " was accepted";
        const std::string message = relief_error();
        EXPECT_EQ(message.find(arguments.function.name + "(): "), 0U) << what << ": " << message;
        EXPECT_NE(message.find(says), std::string::npos) << what << ": " << message;
        static const std::regex kCppNames("\\bk[A-Z]|::|\\n");
        EXPECT_FALSE(std::regex_search(message, kCppNames)) << message;
    }
    template <class F>
    void eachArgument(const F& f) {
        for (const Function& function : kFunctions) {
            for (std::size_t i = 0; i < function.arguments.size(); ++i) {
                f(function, i, function.arguments[i]);
            }
        }
    }
    /// Calls f with each function that reads this structure, and the argument's index.
    template <class F>
    void eachReader(const Structure& structure, const F& f) {
        eachArgument([&](const Function& function, std::size_t i, const Argument& argument) {
            if (argument.type == "const " + structure.name + "*") {
                f(function, i);
            }
        });
    }

    Stage stage_;
};

TEST_F(CApi, TableIsCompleteAndEveryFunctionWorks) {
    EXPECT_GE(kFunctions.size(), 55U);
    for (const Function& function : kFunctions) {
        expectGood(function);
    }
    for (const auto& [function, argument] : kMayBeNull) {
        bool found = false;
        eachArgument(
            [&, name = function, of = argument](const Function& one, std::size_t, const Argument& at) {
                found = found || (one.name == name && at.name == of);
            });
        EXPECT_TRUE(found) << function << " " << argument;
    }
}

TEST_F(CApi, EveryPointerMayBeNull) {
    eachArgument([&](const Function& function, std::size_t i, const Argument& argument) {
        if (!argument.isPointer()) {
            return;
        }
        Arguments arguments{stage_, function, i};
        if (kMayBeNull.contains({function.name, argument.name})) {
            const std::uint64_t before = relief_error_count();
            EXPECT_NE(call(arguments), Outcome::kFailure) << function.name;
            EXPECT_EQ(relief_error_count(), before) << function.name << ": " << relief_error();
        } else {
            expectRefused(arguments, argument.name + " is NULL");
        }
        expectGood(function);
    });
}

TEST_F(CApi, FreedAndInvalidHandlesAreRejected) {
    int at_all = 0;
    eachArgument([&](const Function& function, std::size_t i, const Argument& argument) {
        if (!argument.isHandle()) {
            return;
        }
        const std::uintptr_t number = stage_.handle(argument.type);
        const std::string other =
            argument.type.find("collider") == std::string::npos ? "collider" : "textures";
        expectRefused({stage_, function, i, stage_.handle(other)}, argument.name + kDead);
        for (const std::uintptr_t never :
             {reinterpret_cast<std::uintptr_t>(&number), ~std::uintptr_t{0}, std::uintptr_t{1},
              std::uintptr_t{8}, number ^ (std::uintptr_t{1} << (8 * sizeof(number) - 2)),
              number + (std::uintptr_t{1} << 30)}) {
            expectRefused({stage_, function, i, never}, argument.name + kDead);
        }
        for (const Function& one : kFunctions) {
            if (one.frees() && one.arguments[0].type == argument.type.substr(argument.type.find("relief_"))) {
                Arguments good{stage_, one};
                one.call(good);
                stage_.forget(number);
            }
        }
        stage_.revive();  // reuses the slot of the freed object
        EXPECT_NE(stage_.handle(argument.type), number);
        expectRefused({stage_, function, i, number}, argument.name + kDead);
        expectGood(function);
        ++at_all;
    });
    EXPECT_GE(at_all, 32);
}

TEST_F(CApi, WrongSizesAreRejected) {
    int at_all = 0;
    for (const Structure& structure : kStructures) {
        if (structure.fields.front().name != "size") {
            continue;
        }
        eachReader(structure, [&](const Function& function, std::size_t i) {
            for (const std::size_t size : {std::size_t{0}, std::size_t{3}, sizeof(std::size_t),
                                           structure.bytes - 4, structure.bytes - 1, structure.bytes + 1,
                                           structure.bytes + 8, std::size_t{4096}, ~std::size_t{0}}) {
                std::memcpy(stage_.structure(structure.name), &size, sizeof(size));
                expectRefused({stage_, function}, function.arguments[i].name + "->size is " +
                                                      std::to_string(size) + "; set it to sizeof(" +
                                                      structure.name + ")");
                ++at_all;
            }
            stage_.fill();
            expectGood(function);
        });
    }
    EXPECT_GE(at_all, 36);
}

TEST_F(CApi, EveryNumberOfEveryStructureIsValidated) {
    int at_all = 0;
    for (const Structure& structure : kStructures) {
        eachReader(structure, [&](const Function& function, std::size_t i) {
            std::byte* bytes = stage_.structure(structure.name);
            ASSERT_NE(bytes, nullptr) << structure.name;
            const std::string& given = function.arguments[i].name;
            const bool one_of_many = given == "births" || given == "poses" || given == "spheres";
            for (const Field& field : structure.fields) {
                for (std::size_t k = 0; field.name != "size" && k < field.count; ++k) {
                    std::byte* number = bytes + field.offset + k * field.bytes;
                    const std::string name = function.arguments[i].name +
                                             (one_of_many ? "[" + std::to_string(kWrong) + "]." : "->") +
                                             field.name + (field.array ? "[" + std::to_string(k) + "]" : "") +
                                             " is ";
                    if (field.kind == NumberKind::kFloat) {
                        const std::vector<float> first{kNan, 3e38F, -1.1e15F};
                        for (const float wrong : k == 0 ? first : std::vector<float>{kNan}) {
                            std::memcpy(number, &wrong, sizeof(wrong));
                            expectRefused({stage_, function}, name);
                        }
                    } else {
                        std::memset(number, 0xff, field.bytes);  // -1, or the largest value
                        expectRefused({stage_, function}, name);
                        number[field.bytes - 1] = std::byte{0x7f};
                        expectRefused({stage_, function}, name);
                    }
                    stage_.fill();
                    ++at_all;
                }
            }
            expectGood(function);
        });
    }
    EXPECT_GE(at_all, 13 + 13 + 8 + 5 + 36 + 7);
}

TEST_F(CApi, EveryNumberArgumentIsValidated) {
    eachArgument([&](const Function& function, std::size_t i, const Argument& argument) {
        if (argument.type == "float") {
            for (const float wrong : {kNan, kInfinity, -kInfinity, 0.0F, -1.0F, 1.1e9F}) {
                expectRefused({stage_, function, i, 0, wrong}, argument.name + " is ");
            }
        } else if (argument.type == "double") {
            for (const float wrong : {kNan, kInfinity, -kInfinity, 1.1e9F}) {
                expectRefused({stage_, function, i, 0, wrong}, argument.name + " is ");
            }
        } else if (argument.type == "const float*" && argument.name != "points") {
            float* first =
                const_cast<float*>(stage_.good<const float*>(argument.name));  // points into the stage
            for (const float wrong : {kNan, kInfinity, -kInfinity}) {
                const float right = std::exchange(*first, wrong);
                expectRefused({stage_, function}, argument.name + "[0] is ");
                *first = right;
            }
        } else if (argument.type == "const float*") {
            for (const float wrong : {kNan, kInfinity, -kInfinity}) {
                stage_.points[3 * kWrong + 1] = wrong;
                expectRefused({stage_, function},
                              argument.name + "[" + std::to_string(kWrong) + "] is not finite");
                EXPECT_TRUE(std::isnan(stage_.samples[kWrong].distance) && stage_.samples[kWrong].map == -1);
                EXPECT_TRUE(std::isfinite(stage_.samples[kItems - 1].distance))
                    << "the other samples are valid";
            }
            stage_.fill();
        } else if (!argument.isPointer()) {
            for (const std::uint64_t wrong : {~std::uint64_t{0}, std::uint64_t{INT64_MAX}}) {
                expectRefused({stage_, function, i, wrong}, argument.name + " is ");
            }
        }
        expectGood(function);
    });
}

TEST_F(CApi, FailedCallsWriteNan) {
    relief_collider_bounds(nullptr, stage_.low, stage_.high);
    relief_collider_query(nullptr, stage_.points, kItems, stage_.samples);
    for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(std::isnan(stage_.low[k]) && std::isnan(stage_.high[k]));
    }
    for (const relief_sample& sample : stage_.samples) {
        EXPECT_TRUE(std::isnan(sample.distance) && sample.map == -1 && sample.normal[0] == 0.0F);
    }
    EXPECT_STREQ(relief_collider_unit(nullptr), "");
    EXPECT_STREQ(relief_textures_glsl(nullptr), "");
    // With a count of zero, NULL arrays are valid.
    const std::uint64_t before = relief_error_count();
    relief_collider_query(stage_.collider, nullptr, 0, nullptr);
    EXPECT_EQ(relief_particles_spawn(stage_.particles, nullptr, 0), 0U);
    EXPECT_GE(relief_particles_read(stage_.particles, nullptr, 0), 0);
    EXPECT_EQ(relief_error_count(), before) << relief_error();
}

TEST_F(CApi, CallsWithoutAContextFail) {
    EGLDisplay display = eglGetCurrentDisplay();
    EGLContext context = eglGetCurrentContext();
    ASSERT_TRUE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT));
    for (const Function& function : kFunctions) {
        if (!kNeedContext.contains(function.name)) {
            if (!function.frees()) {
                expectGood(function);
            }
            continue;
        }
        Arguments good{stage_, function};
        EXPECT_NE(function.call(good), Outcome::kSuccess) << function.name;
        EXPECT_EQ(relief_error(),
                  function.name + "(): no OpenGL context is current; make yours current on this thread");
    }
    ASSERT_TRUE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
    for (const Function& function : kFunctions) {
        expectGood(function);  // failed calls freed nothing
    }
}

TEST_F(CApi, FailuresKeepTheirFirstCause) {
    const char* const kMissing = "no such file.relief";
    EXPECT_EQ(relief_textures_create(relief_collider_load(kMissing)), nullptr);
    const std::string cause = relief_error();
    EXPECT_NE(cause.find(kMissing), std::string::npos) << cause;

    // Nobody checks this chain of calls: the last one still reports the first cause.
    relief_collider* collider = relief_collider_load(kMissing);
    relief_textures* textures = relief_textures_create(collider);
    relief_particles* particles = relief_particles_create(textures, &stage_.options);
    EXPECT_EQ(particles, nullptr) << "these particles would collide with nothing";
    EXPECT_EQ(relief_particles_spawn(particles, stage_.births, kItems), 0U);
    EXPECT_EQ(relief_particles_step(particles, 0.01F), -1);
    EXPECT_EQ(relief_renderer_create(textures, collider), nullptr);
    EXPECT_EQ(relief_error(), cause);

    // After the error was read, NULL is valid again.
    particles = relief_particles_create(textures, &stage_.options);
    EXPECT_NE(particles, nullptr) << relief_error();
    relief_particles_free(particles);
    // Also after an object of this kind was created.
    EXPECT_EQ(relief_textures_create(nullptr), nullptr);
    relief_textures_free(relief_textures_create(stage_.collider));
    particles = relief_particles_create(nullptr, &stage_.options);
    EXPECT_NE(particles, nullptr) << relief_error();
    relief_particles_free(particles);
    // Errors are per thread.
    std::thread([&] {
        EXPECT_STREQ(relief_error(), "");
        EXPECT_EQ(relief_error_count(), 0U);
        EXPECT_EQ(relief_collider_load(kMissing), nullptr);
    }).join();
    particles = relief_particles_create(nullptr, &stage_.options);
    EXPECT_NE(particles, nullptr) << relief_error();
    relief_particles_free(particles);
}

// Particles and renderers keep their dependencies alive: with freed collider and textures, results are bit-identical.
TEST_F(CApi, ObjectsMayBeFreedInAnyOrder) {
    relief_textures* doomed = relief_textures_create(stage_.collider);
    relief_particles* orphan = relief_particles_create(doomed, &stage_.options);
    relief_renderer* shown = relief_renderer_create(doomed, stage_.collider);
    ASSERT_TRUE(orphan != nullptr && shown != nullptr) << relief_error();
    relief_textures_free(doomed);
    relief_collider_free(stage_.collider);
    stage_.collider = nullptr;
    // New textures would reuse names freed too early.
    relief_collider* flat = relief_collider_load(stage_.good<const char*>("path"));
    relief_textures* others[8];
    for (relief_textures*& one : others) {
        one = relief_textures_create(flat);
    }
    relief_particle states[2][kItems];
    std::array<std::array<unsigned char, 16 * 16 * 4>, 2> pixels;
    for (int which = 0; which < 2; ++which) {
        relief_particles* particles = which == 0 ? stage_.particles : orphan;
        EXPECT_EQ(relief_particles_spawn(particles, stage_.births, kItems), kItems);
        for (int step = 0; step < 120; ++step) {
            ASSERT_EQ(relief_particles_step(particles, 1.0F / 60.0F), 0) << relief_error();
        }
        ASSERT_EQ(relief_particles_read(particles, states[which], kItems), static_cast<std::int64_t>(kItems));
        glBindFramebuffer(GL_FRAMEBUFFER, stage_.view.framebuffer);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        ASSERT_EQ(
            relief_renderer_draw(which == 0 ? stage_.renderer : shown, particles, nullptr, &stage_.view), 0);
        glReadPixels(0, 0, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, pixels[static_cast<std::size_t>(which)].data());
    }
    EXPECT_EQ(std::memcmp(states[0], states[1], sizeof(states[0])), 0);
    EXPECT_GT(states[1][0].collisions, 0U) << "missed the box";
    EXPECT_EQ(pixels[0], pixels[1]);
    for (relief_textures* one : others) {
        relief_textures_free(one);
    }
    relief_collider_free(flat);
    relief_particles_free(orphan);
    relief_renderer_free(shown);
    stage_.revive();
}

TEST_F(CApi, FailedSetOrSpawnChangesNothing) {
    relief_particles_options wrong = stage_.options;
    wrong.gravity[1] = 5.0F;
    wrong.ground_height = kNan;
    EXPECT_EQ(relief_particles_set(stage_.particles, &wrong), -1);
    stage_.births[kWrong].velocity[0] = kNan;
    EXPECT_EQ(relief_particles_spawn(stage_.particles, stage_.births, kItems), 0U);
    EXPECT_EQ(relief_particles_counts(stage_.particles).born, 0U);
    stage_.fill();
    EXPECT_EQ(relief_particles_spawn(stage_.particles, stage_.births, 1), 1U);
    EXPECT_EQ(relief_particles_step(stage_.particles, 0.25F), 0);
    EXPECT_EQ(relief_particles_step(stage_.particles, 0.25F), 0);
    EXPECT_EQ(relief_particles_read(stage_.particles, stage_.states, kItems), 1);
    EXPECT_EQ(stage_.states[0].velocity[1], -0.5F) << "gravity is still 1 downwards";
}

TEST_F(CApi, WorldsMatchTheirBodies) {
    ASSERT_EQ(relief_world_body_count(stage_.world), kItems);
    std::uint32_t found[] = {9, 9, 9};
    EXPECT_EQ(relief_world_find(stage_.world, "box 0", found, 1), 2U);
    EXPECT_EQ(found[0], 0U);
    EXPECT_EQ(found[1], 9U) << "beyond the array";
    EXPECT_EQ(relief_world_find(stage_.world, "box 0", found, 3), 2U);
    EXPECT_EQ(found[1], 3U);
    EXPECT_EQ(found[2], 9U) << "beyond the last body";
    EXPECT_EQ(relief_world_find(stage_.world, "box 4", found, 2), 0U);
    expectError("'box 4'");
    EXPECT_STREQ(relief_world_node(stage_.world, 2), "box 2");
    relief_pose pose;
    ASSERT_EQ(relief_world_pose(stage_.world, 1, &pose), 0);
    EXPECT_EQ(pose.position[0], 2.0F);
    EXPECT_EQ(pose.rotation[1], 0.6F);
    EXPECT_EQ(relief_world_pose(stage_.world, kItems, &pose), -1);
    EXPECT_TRUE(std::isnan(pose.position[0]) && std::isnan(pose.rotation[3]));
    relief_world_bounds(stage_.world, stage_.low, stage_.high);
    EXPECT_NEAR(stage_.low[0], -0.4F, 1e-6F);
    EXPECT_NEAR(stage_.high[0], 6.4F, 1e-6F);
    EXPECT_NEAR(stage_.high[1], 0.4F, 1e-6F) << "of the second body, which is scaled by 2";

    const float points[] = {0.0F, 0.1F, 0.0F, 2.0F, 0.3F, 0.0F, 6.0F, 0.5F, 0.0F};
    relief_sample samples[3];
    relief_world_query(stage_.world, points, 3, samples);
    for (std::int32_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(samples[i].distance, i == 2 ? 0.3F : -0.1F, 1e-4F);
        EXPECT_EQ(samples[i].map, i == 2 ? 3 : i) << "the body index";
        EXPECT_NEAR(samples[i].normal[1], 1.0F, 1e-3F);
    }

    relief_particles* particles = relief_particles_create(stage_.world_textures, &stage_.options);
    ASSERT_NE(particles, nullptr) << relief_error();
    for (std::size_t i = 0; i < kItems; ++i) {
        stage_.births[i].position[0] = 2.0F * static_cast<float>(i);
        stage_.births[i].position[1] = 1.2F;
    }
    ASSERT_EQ(relief_particles_spawn(particles, stage_.births, kItems), kItems);
    const std::uint32_t body = 3;
    for (int step = 0; step < 180; ++step) {
        const bool moves = step < 60;  // the body moves aside, so nothing is below the last particle
        const relief_pose to{{6.0F + 0.05F * static_cast<float>(step), 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F, 1.0F}};
        ASSERT_EQ(relief_textures_set_poses(stage_.world_textures, moves ? &body : nullptr,
                                            moves ? &to : nullptr, moves ? 1 : 0),
                  0);
        ASSERT_EQ(relief_particles_step(particles, 1.0F / 60.0F), 0) << relief_error();
    }
    ASSERT_EQ(relief_particles_read(particles, stage_.states, kItems), static_cast<std::int64_t>(kItems));
    for (std::size_t i = 0; i < kItems; ++i) {
        EXPECT_EQ(stage_.states[i].collisions > 0, i != body)
            << "the particle collides unless its body moved aside";
        EXPECT_EQ(stage_.states[i].position[0], stage_.births[i].position[0]) << "falls straight down";
    }
    relief_particles_free(particles);
}

TEST_F(CApi, AnimatedCollidersPlayClips) {
    ASSERT_EQ(relief_animation_clip_count(stage_.animation), 2U);
    EXPECT_STREQ(relief_animation_clip_name(stage_.animation, 0), "bend");
    EXPECT_EQ(relief_animation_clip_duration(stage_.animation, 0), 2.0F);
    EXPECT_EQ(relief_animation_joint_count(stage_.animation), 2U);
    EXPECT_STREQ(relief_animation_joint_name(stage_.animation, 1), "middle");
    EXPECT_EQ(relief_animation_weight_count(stage_.animation), 1U);

    const relief_pose pose{{0.0F, 0.0F, 3.0F}, {0.0F, 0.0F, 0.0F, 1.0F}};
    const std::int64_t added = relief_world_add(stage_.world, stage_.animation, &pose, 192, nullptr);
    ASSERT_EQ(added, static_cast<std::int64_t>(kItems)) << relief_error();
    EXPECT_EQ(relief_world_body_count(stage_.world), kItems + 1);
    const auto body = static_cast<std::uint32_t>(added);
    ASSERT_EQ(relief_world_pose(stage_.world, body, &stage_.pose), 0);
    EXPECT_EQ(stage_.pose.position[2], 3.0F);
    EXPECT_STREQ(relief_world_node(stage_.world, body), "");
    relief_world_bounds(stage_.world, stage_.low, stage_.high);
    EXPECT_GE(stage_.high[1], 2.0F);
    relief_textures* textures = relief_textures_create_world(stage_.world);
    ASSERT_NE(textures, nullptr) << relief_error();

    stage_.options.capacity = 512;
    stage_.options.gravity[1] = -3.0F;
    relief_particles* particles = relief_particles_create(textures, &stage_.options);
    // In the plane in which the tube bends, above its upper half once that is horizontal.
    std::vector<relief_birth> births(500);
    for (std::size_t i = 0; i < births.size(); ++i) {
        births[i] = {{-1.2F + 0.002F * static_cast<float>(i), 2.2F, 3.0F}, {}, 9.0F, 0};
    }
    ASSERT_EQ(relief_particles_spawn(particles, births.data(), births.size()), births.size())
        << relief_error();
    double time = 0.0;
    for (int step = 0; step < 60; ++step) {
        time += 1.0 / 60.0;
        ASSERT_EQ(relief_textures_set_clip(textures, body, "bend", time), 0) << relief_error();
        ASSERT_EQ(relief_textures_set_poses(textures, nullptr, nullptr, 0), 0) << relief_error();
        ASSERT_EQ(relief_particles_step(particles, 1.0F / 60.0F), 0) << relief_error();
    }
    std::vector<relief_particle> states(births.size());
    ASSERT_EQ(relief_particles_read(particles, states.data(), states.size()), 500);
    // At rest the tube is upright, and no particle would hit it.
    EXPECT_GT(std::ranges::count_if(states, [](const relief_particle& one) { return one.collisions > 0; }),
              200);

    EXPECT_EQ(relief_textures_set_clip(textures, 0, "bend", 0.0), -1) << "a box has no clips";
    EXPECT_EQ(relief_textures_set_clip(textures, body, "run", 0.0), -1);
    EXPECT_EQ(relief_textures_set_joints(textures, body, stage_.matrices, 1, stage_.weights, 1), -1);
    stage_.matrices[0] = 50.0F;
    EXPECT_EQ(relief_textures_set_joints(textures, body, stage_.matrices, 2, stage_.weights, 1), -1);
    stage_.matrices[0] = 1.0F;
    EXPECT_EQ(relief_textures_set_joints(textures, body, stage_.matrices, 2, stage_.weights, 1), 0)
        << relief_error();
    EXPECT_EQ(relief_textures_set_poses(textures, &body, &pose, 1), 0) << relief_error();
    relief_particles_free(particles);
    relief_textures_free(textures);
}

// A collider is uploaded when a sphere reaches it. A missing one is reported once.
TEST_F(CApi, WorldsAreStreamed) {
    std::mt19937 random(5);
    const test::TemporaryFolder folder;
    World world;
    const auto write = [&](const std::string& name) {
        Collider collider;
        collider.bounds = {glm::vec3(0.0F), glm::vec3(1.0F)};
        collider.maps = {test::randomPatches(random)};
        const std::vector<std::byte> bytes = writeContainer(collider).value();
        EXPECT_TRUE(writeFile(folder.path() / name, bytes));
        return WorldFile{name, xxh3_128Hex(bytes), collider.texelBytes()};
    };
    for (const std::uint32_t i : {0U, 1U}) {
        world.colliders.push_back({write("fine " + std::to_string(i)),
                                   "",
                                   {glm::vec3(0.0F), glm::vec3(1.0F)},
                                   write("coarse " + std::to_string(i))});
        world.bodies.push_back(
            {.collider = i, .position = {10.0F + 10.0F * static_cast<float>(i), 0.0F, 0.0F}});
    }
    const std::string path = folder.write("world.json", worldText(world)).string();
    std::filesystem::remove(folder.path() / "fine 1");

    relief_textures* textures = relief_textures_stream_world(path.c_str(), 1U << 20U);
    ASSERT_NE(textures, nullptr) << relief_error();
    relief_sphere sphere{{10.0F, 0.0F, 0.0F}, 1.0F};
    EXPECT_EQ(relief_textures_stream(textures, &sphere, 1, 1), 0);
    EXPECT_STREQ(relief_textures_warning(textures), "");
    sphere.radius = 30.0F;
    EXPECT_EQ(relief_textures_stream(textures, &sphere, 1, 1), 1);
    EXPECT_NE(std::string(relief_textures_warning(textures)).find("fine 1"), std::string::npos);
    EXPECT_STREQ(relief_textures_warning(textures), "");
    EXPECT_EQ(relief_textures_stream(textures, &sphere, 1, 0), 1);
    const std::uint32_t body = 1;
    EXPECT_EQ(relief_textures_set_poses(textures, &body, stage_.poses, 1), 0) << relief_error();
    relief_particles* particles = relief_particles_create(textures, &stage_.options);
    EXPECT_EQ(relief_particles_step(particles, 0.01F), 0) << relief_error();
    relief_particles_free(particles);
    relief_textures_free(textures);
    sphere.radius = 0.0F;
    EXPECT_EQ(relief_textures_stream(stage_.world_textures, &sphere, 1, 0), -1);
    EXPECT_EQ(relief_textures_stream_world(path.c_str(), 0), nullptr);
    EXPECT_EQ(relief_textures_stream_world(path.c_str(), 64), nullptr);
}

TEST_F(CApi, InvalidPosesAndWorldsAreRejected) {
    const auto refused = [&](relief_textures* textures, const std::string& what) {
        EXPECT_EQ(relief_textures_set_poses(textures, stage_.bodies, stage_.poses, kItems), -1) << what;
        expectError(what);
        stage_.fill();
    };
    stage_.bodies[kWrong] = kItems;
    refused(stage_.world_textures, "bodies[2]");
    stage_.poses[kWrong].rotation[1] = 0.9F;
    refused(stage_.world_textures, "poses[2].rotation");
    refused(stage_.textures, "single collider");
    EXPECT_EQ(relief_renderer_create(stage_.world_textures, stage_.collider), nullptr);
    EXPECT_EQ(relief_world_load("no such world.json"), nullptr);
    EXPECT_EQ(relief_world_load(stage_.good<const char*>("path")), nullptr) << "a container is not a world";
}

TEST_F(CApi, ThreadsAreIndependent) {
    relief_sample expected[kItems];
    relief_collider_query(stage_.collider, stage_.points, kItems, expected);
    std::vector<std::thread> threads;
    std::array<int, 4> wrong{};
    for (int& faults : wrong) {
        threads.emplace_back([&] {
            for (int round = 0; round < 60; ++round) {
                relief_collider* own = relief_collider_load(stage_.good<const char*>("path"));
                relief_sample samples[kItems];
                for (const relief_collider* one : {static_cast<const relief_collider*>(own),
                                                   static_cast<const relief_collider*>(stage_.collider)}) {
                    relief_collider_query(one, stage_.points, kItems, samples);
                    faults += std::memcmp(samples, expected, sizeof(samples)) != 0 ? 1 : 0;
                }
                relief_collider_free(own);
                faults += relief_error_count() != static_cast<std::uint64_t>(round) ? 1 : 0;
                EXPECT_EQ(relief_collider_map_count(own), 0U);  // an error
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(wrong, (std::array<int, 4>{}));
}

}  // namespace
}  // namespace relief::c_api
