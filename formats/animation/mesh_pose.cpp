// SPDX-License-Identifier: Apache-2.0
#include "formats/animation/mesh_pose.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>
#include <span>
#include <utility>

#include "formats/base/portable_math.h"

namespace relief {
namespace {

/// If the cosine of two rotations' half angle exceeds this, linear interpolation is as accurate as slerp.
constexpr double kStraightCosine = 0.9999999;
/// Interval between samples: 15 degrees at ten turns per second. Bounding boxes grow by less than kMotionMargin in it.
constexpr double kSampleSeconds = 1.0 / 240.0;
/// Limit on samples · (nodes + joints), over all clips.
constexpr double kSampleWork = 2e7;
/// Tolerance of isCyclic(), relative to the longest side.
constexpr float kLoopTolerance = 0.02F;
/// Margin for motion between samples.
constexpr float kMotionMargin = 0.02F;

struct Motion {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};
};

Motion operator*(const Motion& outer, const Motion& inner) {
    return {outer.linear * inner.linear, outer.linear * inner.offset + outer.offset};
}

Motion motionOf(const Affine& affine) {
    Motion motion;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            motion.linear[column][row] = double{affine.row[row][column]};
        }
        motion.offset[row] = double{affine.row[row].w};
    }
    return motion;
}

Affine affineOf(const Motion& motion) {
    Affine affine;
    for (int row = 0; row < 3; ++row) {
        affine.row[row] = {motion.linear[0][row], motion.linear[1][row], motion.linear[2][row],
                           motion.offset[row]};
    }
    return affine;
}

/// A node's transform, as animated by a clip.
struct NodeState {
    glm::dvec3 translation;
    glm::dvec4 rotation;
    glm::dvec3 scale;
};

Motion motionOf(const NodeState& state) {
    const glm::dvec4 q = state.rotation / std::sqrt(glm::dot(state.rotation, state.rotation));
    Motion motion{glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z)), state.translation};
    for (int i = 0; i < 3; ++i) {
        motion.linear[i] *= state.scale[i];
    }
    return motion;
}

/// Interpolates unit quaternions along the shorter arc.
void slerp(std::span<const float> a, std::span<const float> b, double t, double* out) {
    double cosine = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        cosine += double{a[i]} * double{b[i]};
    }
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    cosine = std::min(std::abs(cosine), 1.0);
    double from = 1.0 - t;
    double to = t;
    if (cosine < kStraightCosine) {
        const double angle = portable::acos(cosine);
        const double sine = portable::sin(angle);
        from = portable::sin(from * angle) / sine;
        to = portable::sin(to * angle) / sine;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        out[i] = from * double{a[i]} + sign * to * double{b[i]};
    }
}

/// Evaluates a channel with `numbers` values per key.
void valueAt(const ClipChannel& channel, std::size_t numbers, double seconds, double* out) {
    const bool cubic = channel.curve == KeyCurve::kCubic;
    const std::size_t stride = cubic ? 3 * numbers : numbers;
    // 0: in-tangent; 1: value; 2: out-tangent.
    const auto part = [&](std::size_t key, std::size_t which) {
        return std::span(channel.values).subspan(key * stride + (cubic ? which * numbers : 0), numbers);
    };
    const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), seconds,
                                        [](double t, float key) { return t < double{key}; });
    const auto next = static_cast<std::size_t>(after - channel.times.begin());
    const std::size_t key = next == 0 ? 0 : next - 1;
    const std::span<const float> value = part(key, 1);
    std::copy(value.begin(), value.end(), out);
    if (next == 0 || next == channel.times.size() || channel.curve == KeyCurve::kStep) {
        return;
    }
    const double length = double{channel.times[next]} - double{channel.times[key]};
    const double t = (seconds - double{channel.times[key]}) / length;
    const std::span<const float> other = part(next, 1);
    if (cubic) {
        const std::span<const float> out_tangent = part(key, 2);
        const std::span<const float> in_tangent = part(next, 0);
        for (std::size_t i = 0; i < numbers; ++i) {
            out[i] = (2 * t * t * t - 3 * t * t + 1) * double{value[i]} +
                     length * (t * t * t - 2 * t * t + t) * double{out_tangent[i]} +
                     (3 * t * t - 2 * t * t * t) * double{other[i]} +
                     length * (t * t * t - t * t) * double{in_tangent[i]};
        }
    } else if (channel.member == NodeMember::kRotation) {
        slerp(value, other, t, out);
    } else {
        for (std::size_t i = 0; i < numbers; ++i) {
            out[i] += t * (double{other[i]} - double{value[i]});
        }
    }
}

MeshPose poseOf(const AnimatedMesh& mesh, const std::vector<NodeState>& states, std::vector<float> weights) {
    std::vector<Motion> nodes;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        const MeshNode& node = mesh.nodes[i];
        const Motion own = node.matrix ? motionOf(*node.matrix) : motionOf(states[i]);
        nodes.push_back(node.parent < 0 ? own : nodes[static_cast<std::size_t>(node.parent)] * own);
    }
    MeshPose pose{{}, std::move(weights)};
    for (const MeshJoint& joint : mesh.joints) {
        pose.joints.push_back(affineOf(nodes[joint.node] * motionOf(joint.bind)));
    }
    return pose;
}

/// Returns ascending times at most `interval` seconds apart, including all keys unless there are more keys than times.
std::vector<double> timesOf(const MeshClip& clip, double interval) {
    std::vector<double> times{double{clip.seconds}};
    for (double t = 0.0; t < double{clip.seconds}; t += interval) {
        times.push_back(t);
    }
    const std::size_t count = times.size();
    std::set<float> keys;
    for (const ClipChannel& channel : clip.channels) {
        keys.insert(channel.times.begin(), channel.times.end());
    }
    if (keys.size() <= count) {
        times.insert(times.end(), keys.begin(), keys.end());
        std::sort(times.begin(), times.end());
    }
    return times;
}

std::vector<NodeState> statesOf(const AnimatedMesh& mesh) {
    std::vector<NodeState> states;
    for (const MeshNode& node : mesh.nodes) {
        states.push_back({node.translation, node.rotation, node.scale});
    }
    return states;
}

}  // namespace

MeshPose restPose(const AnimatedMesh& mesh) {
    return poseOf(mesh, statesOf(mesh), mesh.weights);
}

MeshPose firstPose(const AnimatedMesh& mesh) {
    return mesh.clips.empty() ? restPose(mesh) : poseAt(mesh, mesh.clips.front(), 0.0);
}

MeshPose poseAt(const AnimatedMesh& mesh, const MeshClip& clip, double seconds) {
    std::vector<NodeState> states = statesOf(mesh);
    std::vector<float> weights = mesh.weights;
    std::vector<double> value;
    for (const ClipChannel& channel : clip.channels) {
        value.resize(keyNumbers(mesh, channel));
        valueAt(channel, value.size(), seconds, value.data());
        NodeState& state = states[channel.node];
        switch (channel.member) {
            case NodeMember::kTranslation:
                state.translation = {value[0], value[1], value[2]};
                break;
            case NodeMember::kRotation: {
                const glm::dvec4 rotation(value[0], value[1], value[2], value[3]);
                // A curve may pass through 0, which is not a rotation.
                state.rotation = glm::dot(rotation, rotation) > 0.0 ? rotation : state.rotation;
                break;
            }
            case NodeMember::kScale:
                state.scale = {value[0], value[1], value[2]};
                break;
            case NodeMember::kWeights:
                std::transform(value.begin(), value.end(),
                               weights.begin() + mesh.nodes[channel.node].first_weight,
                               [](double weight) { return static_cast<float>(weight); });
                break;
        }
    }
    return poseOf(mesh, states, std::move(weights));
}

std::optional<std::size_t> findClip(const AnimatedMesh& mesh, std::string_view name) {
    const auto found = std::find_if(mesh.clips.begin(), mesh.clips.end(),
                                    [&](const MeshClip& clip) { return name.empty() || clip.name == name; });
    return found == mesh.clips.end() ? std::nullopt
                                     : std::optional(static_cast<std::size_t>(found - mesh.clips.begin()));
}

double repeated(const MeshClip& clip, double seconds) {
    const auto length = double{clip.seconds};
    const double rest = std::fmod(seconds, length);
    const double positive = rest < 0.0 ? rest + length : rest;
    return positive < length ? positive : 0.0;
}

std::vector<glm::vec3> posed(const AnimatedMesh& mesh, const MeshPose& pose) {
    std::vector<glm::vec3> positions;
    positions.reserve(mesh.positions.size());
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        glm::vec3 position = mesh.positions[vertex];
        for (std::uint32_t i = mesh.delta_begin[vertex]; i < mesh.delta_begin[vertex + 1]; ++i) {
            position += pose.weights[mesh.deltas[i].target] * mesh.deltas[i].delta;
        }
        glm::vec3 sum(0.0F);
        for (std::uint32_t i = mesh.influence_begin[vertex]; i < mesh.influence_begin[vertex + 1]; ++i) {
            sum += mesh.influences[i].weight * pose.joints[mesh.influences[i].joint].apply(position);
        }
        positions.push_back(sum);
    }
    return positions;
}

PoseBounds::PoseBounds(const AnimatedMesh& mesh) : boxes_(mesh.joints.size()), reach_(mesh.weights.size()) {
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        for (std::uint32_t i = mesh.influence_begin[vertex]; i < mesh.influence_begin[vertex + 1]; ++i) {
            boxes_[mesh.influences[i].joint].add(mesh.positions[vertex]);
        }
    }
    for (const MorphDelta& delta : mesh.deltas) {
        reach_[delta.target] = glm::max(reach_[delta.target], glm::abs(delta.delta));
    }
}

Bounds PoseBounds::of(const MeshPose& pose) const {
    glm::vec3 morphed(0.0F);
    for (std::size_t i = 0; i < reach_.size(); ++i) {
        morphed += std::abs(pose.weights[i]) * reach_[i];
    }
    Bounds all;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (!(boxes_[i].min.x <= boxes_[i].max.x)) {
            continue;  // moves no vertex
        }
        const glm::vec3 half = 0.5F * boxes_[i].size() + morphed;
        const glm::vec3 middle = pose.joints[i].apply(boxes_[i].center());
        glm::vec3 reach;
        for (int k = 0; k < 3; ++k) {
            reach[k] = glm::dot(glm::abs(glm::vec3(pose.joints[i].row[k])), half);
        }
        all.add(middle - reach);
        all.add(middle + reach);
    }
    return all;
}

PoseExtent poseExtent(const AnimatedMesh& mesh) {
    const PoseBounds bounds(mesh);
    PoseExtent extent;
    const auto add = [&](const MeshPose& pose) {
        const Bounds box = bounds.of(pose);
        extent.box.add(box.min);
        extent.box.add(box.max);
        extent.box_size = glm::max(extent.box_size, (1.0F + kMotionMargin) * box.size());
    };
    add(firstPose(mesh));
    double seconds = 0.0;
    for (const MeshClip& clip : mesh.clips) {
        seconds += double{clip.seconds};
    }
    const double samples_max = kSampleWork / static_cast<double>(mesh.nodes.size() + mesh.joints.size());
    const double interval = std::max(kSampleSeconds, seconds / samples_max);
    for (const MeshClip& clip : mesh.clips) {
        for (const double t : timesOf(clip, interval)) {
            add(poseAt(mesh, clip, t));
        }
    }
    return extent;
}

bool isCyclic(const AnimatedMesh& mesh, const MeshClip& clip) {
    const PoseBounds bounds(mesh);
    const Bounds begin = bounds.of(poseAt(mesh, clip, 0.0));
    const Bounds end = bounds.of(poseAt(mesh, clip, double{clip.seconds}));
    const float difference = std::max(glm::length(begin.min - end.min), glm::length(begin.max - end.max));
    return difference <= kLoopTolerance * begin.longestSide();
}

}  // namespace relief
