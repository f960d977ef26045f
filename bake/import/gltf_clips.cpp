// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "bake/import/animated_import.h"
#include "formats/base/enum_words.h"
#include "formats/base/text.h"

namespace relief {

template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<NodeMember>{"translation", "rotation", "scale",
                                                                      "weights"};
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<KeyCurve>{"STEP", "LINEAR", "CUBICSPLINE"};

namespace {

/// Limit per accessor.
constexpr std::uint64_t kKeysMax = 10'000'000;
/// Tolerance of a quaternion's length; beyond it, the quaternion is invalid.
constexpr double kRotationTolerance = 0.1;

class ClipReader {
  public:
    ClipReader(GltfBuffers& buffers, const std::vector<std::optional<std::uint32_t>>& nodes,
               AnimatedMesh& mesh, std::vector<std::string>& warnings)
        : buffers_(buffers), nodes_(nodes), mesh_(mesh), warnings_(warnings) {}

    Result<void> read(const GltfValue& place) {
        MeshClip clip;
        clip.name = RELIEF_TRY(place.get<std::string>("name", ""));
        clip.name = clip.name.empty() ? "clip " + std::to_string(place.index()) : clip.name;
        const std::vector<GltfValue> samplers = RELIEF_TRY(place.objects("samplers"));
        std::set<std::pair<std::uint64_t, std::string>> moved;
        for (const GltfValue& from : RELIEF_TRY(place.objects("channels"))) {
            RELIEF_TRY(readChannel(from, samplers, moved, clip));
        }
        if (clip.channels.empty() || !(clip.seconds > 0.0F)) {
            warnings_.push_back("the animation '" + cleanUtf8(clip.name, kAnimatedNameMax) +
                                (clip.channels.empty() ? "' does not move the mesh" : "' has zero length") +
                                "; it is left out");
            return {};
        }
        if (clip.seconds > kClipSecondsMax) {
            return place.wrong("lasts longer than a day; cut it, or fix its key times", ErrorCode::kLimit);
        }
        if (mesh_.clips.size() == kMeshClipsMax) {
            return fail(ErrorCode::kLimit,
                        "it has more than " + std::to_string(kMeshClipsMax) + " animations; export fewer");
        }
        addClip(mesh_, std::move(clip), warnings_);
        return {};
    }

  private:
    /// Adds the channel if it moves a node of the mesh. \param moved  nodes and paths that already have a channel.
    Result<void> readChannel(const GltfValue& from, const std::vector<GltfValue>& samplers,
                             std::set<std::pair<std::uint64_t, std::string>>& moved, MeshClip& clip) {
        const std::optional<GltfValue> target = RELIEF_TRY(from.object("target"));
        const std::optional<std::string> path =
            target ? RELIEF_TRY(target->get<std::string>("path")) : std::nullopt;
        if (!path) {
            return from.wrong("has no target, or its target has no path");
        }
        const std::optional<GltfValue> node = RELIEF_TRY(target->named("node", "nodes"));
        const std::uint64_t number = RELIEF_TRY(from.number("sampler"));
        if (number >= samplers.size()) {
            return from.wrong("references samplers[" + std::to_string(number) + "], which does not exist");
        }
        const std::optional<NodeMember> member = fromWord<NodeMember>(*path);
        if (!node || !member) {
            // Extensions animate other targets, such as lights and materials.
            return {};
        }
        if (!moved.emplace(node->index(), *path).second) {
            return from.wrong("moves the " + *path + " of nodes[" + std::to_string(node->index()) +
                              "], which another channel also moves");
        }
        ClipChannel channel;
        channel.member = *member;
        const GltfValue& sampler = samplers[number];
        channel.times = RELIEF_TRY(readTimes(sampler));
        clip.seconds = std::max(clip.seconds, channel.times.back());
        const std::optional<std::uint32_t> mesh_node = nodes_[node->index()];
        if (!mesh_node) {
            return {};
        }
        channel.node = *mesh_node;
        if (mesh_.nodes[channel.node].matrix && channel.member != NodeMember::kWeights) {
            return from.wrong(
                "moves nodes[" + std::to_string(node->index()) +
                "], whose matrix is not a translation, rotation and scale; export these instead");
        }
        if (channel.member == NodeMember::kWeights && mesh_.nodes[channel.node].weights == 0) {
            return from.wrong("moves the morph targets of nodes[" + std::to_string(node->index()) +
                              "], which has none");
        }
        RELIEF_TRY(readValues(sampler, channel));
        clip.channels.push_back(std::move(channel));
        return {};
    }

    Result<std::vector<float>> readTimes(const GltfValue& sampler) {
        const GltfValue input = RELIEF_TRY(sampler.needed("input", "accessors"));
        std::vector<float> times =
            RELIEF_TRY(readAccessor<float>(input, GltfUse::kTimes, buffers_, kKeysMax));
        if (times.empty()) {
            return input.wrong("has no keys");
        }
        for (std::size_t i = 0; i < times.size(); ++i) {
            if (!std::isfinite(times[i]) || times[i] < 0.0F || (i > 0 && times[i] <= times[i - 1])) {
                return input.wrong(
                    "has the time " + (std::isfinite(times[i]) ? shortest(times[i]) : "NaN or infinity") +
                    " at key " + std::to_string(i) + "; key times must not be negative, and must increase");
            }
        }
        return times;
    }

    Result<void> readValues(const GltfValue& sampler, ClipChannel& channel) {
        const std::string word = RELIEF_TRY(sampler.get<std::string>("interpolation", "LINEAR"));
        const std::optional<KeyCurve> curve = fromWord<KeyCurve>(word);
        if (!curve) {
            return sampler.wrong("has the interpolation '" + cleanUtf8(word, 20) +
                                 "', which is not STEP, LINEAR or CUBICSPLINE");
        }
        channel.curve = *curve;
        const GltfValue output = RELIEF_TRY(sampler.needed("output", "accessors"));
        switch (channel.member) {
            case NodeMember::kRotation:
                channel.values = RELIEF_TRY(numbers<glm::vec4>(output, GltfUse::kRotations));
                break;
            case NodeMember::kWeights:
                channel.values =
                    RELIEF_TRY(readAccessor<float>(output, GltfUse::kMorphs, buffers_, kKeysMax));
                break;
            default:
                channel.values = RELIEF_TRY(numbers<glm::vec3>(output, GltfUse::kVectors));
                break;
        }
        const std::size_t per_key = keyNumbers(mesh_, channel) * (channel.curve == KeyCurve::kCubic ? 3 : 1);
        if (channel.values.size() != per_key * channel.times.size()) {
            return output.wrong("has " + std::to_string(channel.values.size()) + " numbers instead of " +
                                std::to_string(per_key) + " for each of " +
                                std::to_string(channel.times.size()) + " keys");
        }
        if (!std::ranges::all_of(channel.values, [](float value) { return std::isfinite(value); })) {
            return output.wrong("has key values that are not numbers");
        }
        return channel.member == NodeMember::kRotation ? unitRotations(output, channel) : Result<void>();
    }

    /// Checks that quaternions have about unit length. Normalizes them, except in cubic curves: quantization changes
    /// their length.
    static Result<void> unitRotations(const GltfValue& output, ClipChannel& channel) {
        const bool cubic = channel.curve == KeyCurve::kCubic;
        for (std::size_t key = 0; key < channel.times.size(); ++key) {
            float* const q = &channel.values[cubic ? 12 * key + 4 : 4 * key];
            double square = 0.0;
            for (int i = 0; i < 4; ++i) {
                square += double{q[i]} * double{q[i]};
            }
            const double length = std::sqrt(square);
            if (!(std::abs(length - 1.0) <= kRotationTolerance)) {
                return output.wrong("has a rotation at key " + std::to_string(key) +
                                    " that is not a unit quaternion: its length is " +
                                    shortest(static_cast<float>(length)));
            }
            for (int i = 0; i < 4 && !cubic; ++i) {
                q[i] = static_cast<float>(double{q[i]} / length);
            }
        }
        return {};
    }

    template <class T>
    Result<std::vector<float>> numbers(const GltfValue& accessor, GltfUse use) {
        const std::vector<T> values = RELIEF_TRY(readAccessor<T>(accessor, use, buffers_, kKeysMax));
        std::vector<float> all;
        all.reserve(values.size() * static_cast<std::size_t>(T::length()));
        for (const T& value : values) {
            for (int i = 0; i < T::length(); ++i) {
                all.push_back(value[i]);
            }
        }
        return all;
    }

    GltfBuffers& buffers_;
    const std::vector<std::optional<std::uint32_t>>& nodes_;
    AnimatedMesh& mesh_;
    std::vector<std::string>& warnings_;
};

}  // namespace

Result<void> readGltfClips(const GltfValue& document, GltfBuffers& buffers,
                           const std::vector<std::optional<std::uint32_t>>& nodes, AnimatedMesh& mesh,
                           std::vector<std::string>& warnings) {
    ClipReader reader(buffers, nodes, mesh, warnings);
    for (const GltfValue& place : RELIEF_TRY(document.objects("animations"))) {
        RELIEF_TRY(reader.read(place));
    }
    return {};
}

}  // namespace relief
