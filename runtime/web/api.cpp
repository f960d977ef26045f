// SPDX-License-Identifier: Apache-2.0
// Functions for relief.js in addition to those of runtime/c_api: scenes, and facts about a collider. Objects of this
// file are plain pointers. Functions return null or a negative number on failure; relief_error() has the reason.
// Functions that use GL need a current context and restore its state.
#include <emscripten.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/fields/json_value.h"
#include "formats/texel.h"
#include "formats/world/collider_info.h"
#include "runtime/c_api/call.h"
#include "runtime/c_api/objects.h"
#include "runtime/c_api/relief_runtime.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"
#include "runtime/web/player.h"

namespace relief {
namespace {

std::string g_text;  // the last returned string

const char* storeText(std::string text) {
    g_text = std::move(text);
    return g_text.c_str();
}

/// Serialises JSON with file names, which may be invalid UTF-8.
std::string lineOf(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Writes numbers and vectors as floats, and moves `out` behind them.
template <class... Values>
void writeRow(float*& out, const Values&... values) {
    const auto write = [&out](const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, glm::vec3>) {
            out = std::copy_n(&value.x, 3, out);
        } else {
            *out++ = static_cast<float>(value);
        }
    };
    (write(values), ...);
}

/// Returns the result of body(), or `failed`; restores the state of the context.
template <class T, class F>
T inPass(const char* function, T failed, const F& body) {
    return answer(function, failed, [&](const Call&) -> Result<T> {
        const PassState state;
        return body();
    });
}

}  // namespace
}  // namespace relief

using namespace relief;  // NOLINT: the C functions are outside of it

extern "C" {

/// Like relief_world_load(), but loads the coarse container of each collider that has one.
EMSCRIPTEN_KEEPALIVE relief_world* relief_world_load_coarse(const char* path) {
    return create<relief_world>(__func__, [&](const Call&) -> Result<WorldObject> {
        return WorldObject{WorldField(RELIEF_TRY(loadWorld(path, {}, WorldDetail::kCoarse)))};
    });
}

/// Returns JSON.
EMSCRIPTEN_KEEPALIVE const char* relief_collider_info(const relief_collider* collider) {
    return answer<const char*>(__func__, nullptr, [&](const Call& call) -> Result<const char*> {
        return storeText(colliderInfo(*RELIEF_TRY(call.object(collider, "collider"))).dump());
    });
}

/// Writes the decoded texels of a map, 8 floats each: depth and normal of the front surface, then of the back surface.
/// The depth is NaN if there is no surface. Row y = 0 comes first; the faces of a cube follow each other.
EMSCRIPTEN_KEEPALIVE int relief_collider_texels(const relief_collider* collider, int map, float* out) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        const Collider& of = *RELIEF_TRY(call.object(collider, "collider"));
        const DepthMap& from = of.maps[static_cast<std::size_t>(map)];
        const Surface none{std::numeric_limits<float>::quiet_NaN(), glm::vec3(0.0F)};
        const auto put = [&](const Surface& surface) { writeRow(out, surface.depth, surface.normal); };
        for (std::uint32_t face = 0; face < from.faceCount(); ++face) {
            for (std::uint32_t y = 0; y < from.height; ++y) {
                for (std::uint32_t x = 0; x < from.width; ++x) {
                    const Texel texel = decodeTexel(from.format, from.texelAt(face, x, y));
                    put(texel.front.value_or(none));
                    put(texel.back.value_or(none));
                }
            }
        }
        return 0;
    });
}

/// Writes the raw texels of a patch map: two 32-bit words each, low and high.
EMSCRIPTEN_KEEPALIVE int relief_collider_tree(const relief_collider* collider, int map, std::uint32_t* out) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        const Collider& of = *RELIEF_TRY(call.object(collider, "collider"));
        const std::vector<std::byte>& texels = of.maps[static_cast<std::size_t>(map)].texels;
        std::memcpy(out, texels.data(), texels.size());
        return 0;
    });
}

// --- particles

/// \param text     a scene file, or a JSON object with the same keys.
/// \param path     path of the file in the emscripten file system, ending in .toml; otherwise the name of the object in
///                 messages.
/// \param shaded   1: the collider shades particles.
/// \param fetches  1: the page fetches the colliders of a streamed world and passes them to relief_player_give().
EMSCRIPTEN_KEEPALIVE Player* relief_player_create(const char* text, const char* path, int shaded,
                                                  int fetches) {
    return inPass<Player*>(__func__, nullptr,
                           [&] { return createPlayer(text, path, shaded != 0, fetches != 0); });
}

EMSCRIPTEN_KEEPALIVE void relief_player_free(Player* player) {
    delete player;
}

/// Records the new hits of each step, starting with the next, for relief_player_next_hits(). Returns 0, or -1 on failure.
/// \param min_speed  minimum approach speed of recorded hits.
EMSCRIPTEN_KEEPALIVE int relief_player_list_hits(Player* player, float min_speed) {
    return inPass(__func__, -1, [&]() -> Result<int> {
        RELIEF_TRY(player->simulation->listHits(min_speed, [=](const StepEvents& events) -> Result<void> {
            StepEvents& hits = player->hits.emplace_back(events);
            std::erase_if(hits.events, [min_speed](const ParticleEvent& one) {
                return !one.hit || one.lasts || one.speed < min_speed;
            });
            return {};
        }));
        return 0;
    });
}

/// Writes step, time, dropped events and number of hits of the next step whose hits are available.
/// \return 0 if there is no such step, otherwise 1.
EMSCRIPTEN_KEEPALIVE int relief_player_next_hits(const Player* player, double* out) {
    if (player->hits.empty()) {
        return 0;
    }
    const StepEvents& next = player->hits.front();
    const double row[4] = {static_cast<double>(next.tag), next.time, static_cast<double>(next.dropped),
                           static_cast<double>(next.events.size())};
    std::memcpy(out, row, sizeof(row));
    return 1;
}

/// Writes the hits of the step of relief_player_next_hits() and removes that step. 16 floats each: position, seconds
/// before the end of the step, velocity, approach speed, normal, body, material, type, 1 if the particle dies, low 24
/// bits of the id.
EMSCRIPTEN_KEEPALIVE void relief_player_hits(Player* player, float* out) {
    const StepEvents& step = player->hits.front();
    for (const ParticleEvent& one : step.events) {
        writeRow(out, one.position, step.time - one.time, one.velocity, one.speed, one.normal, one.body,
                 one.material, one.type, one.death, one.id & 0xffffffU);
    }
    player->hits.pop_front();
}

/// Advances the scene. Returns the number of lines for relief_player_warnings(), or -1 on failure.
EMSCRIPTEN_KEEPALIVE int relief_player_step(Player* player, float dt) {
    return inPass(__func__, -1, [&]() -> Result<int> {
        RELIEF_TRY(player->simulation->step(dt));
        RELIEF_TRY(checkGpu("stepping particles"));
        return player->takeWarnings();
    });
}

/// Returns a JSON list of warnings since the last call: colliders of a streamed world that failed to load.
EMSCRIPTEN_KEEPALIVE const char* relief_player_warnings(Player* player) {
    player->takeWarnings();
    return storeText(lineOf(Json(std::exchange(player->warnings, {}))));
}

/// Sets the points around which a streamed world has full detail: 4 floats each, position and radius. Returns 0, or -1
/// on failure.
EMSCRIPTEN_KEEPALIVE int relief_player_near(Player* player, const float* balls, int count) {
    return answer(__func__, -1, [&](const Call&) -> Result<int> {
        if (!player->loaded.scene.stream) {
            return fail(ErrorCode::kUsage, "setPointsOfInterest() needs a streamed world; use streamWorld()");
        }
        player->near.clear();
        for (int i = 0; i < count; ++i, balls += 4) {
            player->near.push_back({{balls[0], balls[1], balls[2]}, balls[3]});
        }
        player->setPoints();
        return 0;
    });
}

/// Returns the next collider to fetch as JSON: its number, and its file relative to the folder of the world; "null" if
/// there is none.
EMSCRIPTEN_KEEPALIVE const char* relief_player_next(Player* player) {
    const auto next = player->source != nullptr ? player->source->next() : std::nullopt;
    return storeText(
        next ? lineOf({{"collider", *next}, {"file", player->loaded.world.colliders[*next].file}}) : "null");
}

/// Passes the bytes of a container that relief_player_next() returned.
EMSCRIPTEN_KEEPALIVE int relief_player_give(Player* player, int collider, const std::byte* bytes, int size) {
    return answer(__func__, -1, [&](const Call&) -> Result<int> {
        player->source->give(static_cast<std::size_t>(collider), {bytes, static_cast<std::size_t>(size)});
        return 0;
    });
}

/// Reports that a fetch failed, and why.
EMSCRIPTEN_KEEPALIVE int relief_player_refuse(Player* player, int collider, const char* reason) {
    return answer(__func__, -1, [&](const Call&) -> Result<int> {
        player->source->refuse(static_cast<std::size_t>(collider), reason);
        return 0;
    });
}

/// Uploads all requested colliders that have arrived. Returns the number of pending fetches, or -1 on failure.
EMSCRIPTEN_KEEPALIVE int relief_player_load(Player* player) {
    return inPass(__func__, -1, [&]() -> Result<int> {
        RELIEF_TRY(player->simulation->load());
        RELIEF_TRY(checkGpu("uploading colliders"));
        return player->source != nullptr ? static_cast<int>(player->source->underWay()) : 0;
    });
}

/// \param emitters  1: the emitters restart.
EMSCRIPTEN_KEEPALIVE int relief_player_change(Player* player, const char* text, const char* path,
                                              int emitters) {
    return inPass(__func__, -1, [&] { return changePlayer(*player, text, path, emitters != 0); });
}

/// Queues births in addition to those of the emitters: 8 floats each, position, velocity, lifetime, type. Returns the
/// number accepted.
EMSCRIPTEN_KEEPALIVE int relief_player_spawn(Player* player, const float* births, int count) {
    return answer(__func__, -1, [&](const Call&) -> Result<int> {
        std::vector<Birth> list;
        for (int i = 0; i < count; ++i, births += 8) {
            if (!(births[7] >= 0.0F && births[7] <= static_cast<float>(kBirthTypeMax))) {
                return fail(ErrorCode::kUsage,
                            "birth " + std::to_string(i) + ": there is no type " + std::to_string(births[7]));
            }
            list.push_back({{births[0], births[1], births[2]},
                            {births[3], births[4], births[5]},
                            births[6],
                            static_cast<std::uint32_t>(births[7])});
        }
        return static_cast<int>(RELIEF_TRY(player->simulation->spawn(list)));
    });
}

/// Draws the particles to the pixels (0, 0) … (width - 1, height - 1) of a framebuffer.
/// \param meshes    1: draws the meshes of render.meshes instead, overwriting the framebuffer.
/// \param matrices  view matrix, then projection matrix, column-major.
/// \param srgb      1: the framebuffer stores sRGB values.
EMSCRIPTEN_KEEPALIVE int relief_player_draw(Player* player, int meshes, const float* matrices,
                                            int framebuffer, int width, int height, int srgb) {
    const RenderTarget target{static_cast<GLuint>(framebuffer), width, height, srgb != 0};
    const CameraMatrices camera(glm::make_mat4(matrices), glm::make_mat4(matrices + 16));
    return inPass(__func__, -1,
                  [&] { return (meshes != 0 ? drawPlayerMeshes : drawPlayer)(*player, camera, target); });
}

/// Returns JSON.
EMSCRIPTEN_KEEPALIVE const char* relief_player_info(const Player* player) {
    return storeText(describePlayer(*player).dump());
}

/// Returns the GL name of a state texture. \param which  0: positions, 1: velocities, 2: births.
EMSCRIPTEN_KEEPALIVE int relief_player_texture(const Player* player, int which) {
    const ParticleSystem& particles = player->simulation->particles();
    const GlTexture& texture = which == 0   ? particles.positions()
                               : which == 1 ? particles.velocities()
                                            : particles.births();
    return static_cast<int>(texture.name());
}

/// Writes the current mesh of a deforming collider: GL names of the position and corner textures, their shifts, and the
/// number of triangles. Returns 0 if the collider does not deform.
EMSCRIPTEN_KEEPALIVE int relief_player_mesh(const Player* player, int body, int* out) {
    const GpuMesh* mesh = player->simulation->mesh(static_cast<std::size_t>(body));
    if (mesh == nullptr) {
        return 0;
    }
    out[0] = static_cast<int>(mesh->positions());
    out[1] = static_cast<int>(mesh->corners());
    out[2] = mesh->vertexShift();
    out[3] = mesh->triangleShift();
    out[4] = static_cast<int>(mesh->triangleCount());
    return 1;
}

/// Returns clips, joints and morph targets of an animated collider as JSON; "null" for other colliders.
EMSCRIPTEN_KEEPALIVE const char* relief_player_animation(const Player* player, int body) {
    const AnimatedMesh* mesh = player->simulation->animatedMesh(static_cast<std::size_t>(body));
    if (mesh == nullptr) {
        return "null";
    }
    Json clips = Json::array();
    for (const MeshClip& clip : mesh->clips) {
        clips.push_back({{"name", clip.name}, {"duration", clip.seconds}});
    }
    Json joints = Json::array();
    for (const MeshJoint& joint : mesh->joints) {
        joints.push_back(mesh->nodes[joint.node].name);
    }
    return storeText(Json{{"clips", clips}, {"joints", joints}, {"weights", mesh->weights.size()}}.dump());
}

/// Sets the pose of an animated collider: matrices of 16 floats, column-major, and weights. Without matrices, its clip
/// continues. Returns 0, or -1 on failure.
EMSCRIPTEN_KEEPALIVE int relief_player_pose(Player* player, int body, const float* matrices, int joints,
                                            const float* weights, int weight_count) {
    return inPass(__func__, -1, [&]() -> Result<int> {
        std::optional<MeshPose> pose;
        if (joints > 0) {
            pose.emplace(MeshPose{{}, {weights, weights + weight_count}});
            for (const float* at = matrices; at < matrices + 16 * joints; at += 16) {
                Affine& joint = pose->joints.emplace_back();
                for (int row = 0; row < 3; ++row) {
                    joint.row[row] = {at[row], at[row + 4], at[row + 8], at[row + 12]};
                }
            }
        }
        RELIEF_TRY(player->simulation->setPose(static_cast<std::size_t>(body), std::move(pose)));
        return 0;
    });
}

/// Reads the particles back, which waits for the GPU. Returns the number of live particles, or -1 on failure.
EMSCRIPTEN_KEEPALIVE int relief_player_read(Player* player) {
    return inPass(__func__, -1, [&]() -> Result<int> {
        player->read = RELIEF_TRY(player->simulation->particles().readState());
        return static_cast<int>(player->read.size());
    });
}

/// Writes the particles of relief_player_read(), 12 floats each: position, age, velocity, lifetime, type, steps in
/// contact, contact in the last step, low 24 bits of the id.
EMSCRIPTEN_KEEPALIVE void relief_player_states(const Player* player, float* out) {
    for (const ParticleState& one : player->read) {
        writeRow(out, one.position, one.age, one.velocity, one.lifetime, one.type, one.collisions,
                 one.contact, one.id & 0xffffffU);
    }
}

}  // extern "C"
