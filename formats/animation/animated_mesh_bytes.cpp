// SPDX-License-Identifier: Apache-2.0
#include <flatbuffers/flatbuffers.h>

#include <bit>
#include <cstring>
#include <memory>
#include <utility>

#include "animated_mesh_generated.h"
#include "formats/animation/animated_mesh.h"

namespace relief {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

constexpr flatbuffers::uoffset_t kDepthMax = 4;  // mesh, clip, channel
constexpr flatbuffers::uoffset_t kTablesMax = 4'000'000;

// Structs with the same layout in file and memory are copied as they are.
template <class Stored, class T>
Offset<flatbuffers::Vector<const Stored*>> addAll(FlatBufferBuilder& builder, const std::vector<T>& values) {
    static_assert(sizeof(Stored) == sizeof(T) && std::endian::native == std::endian::little);
    return builder.CreateVectorOfStructs(reinterpret_cast<const Stored*>(values.data()), values.size());
}

template <class T, class Stored>
std::vector<T> copyAll(const flatbuffers::Vector<const Stored*>& stored) {
    static_assert(sizeof(Stored) == sizeof(T));
    std::vector<T> values(stored.size());
    if (!values.empty()) {
        std::memcpy(static_cast<void*>(values.data()), stored.data(), values.size() * sizeof(T));
    }
    return values;
}

template <class T>
std::vector<T> copyAll(const flatbuffers::Vector<T>& stored) {
    return {stored.begin(), stored.end()};
}

fb::Triple toFb(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

fb::Quadruple toFb(const glm::vec4& v) {
    return {v.x, v.y, v.z, v.w};
}

fb::Affine toFb(const Affine& a) {
    return {toFb(a.row[0]), toFb(a.row[1]), toFb(a.row[2])};
}

glm::vec3 fromFb(const fb::Triple& v) {
    return {v.x(), v.y(), v.z()};
}

glm::vec4 fromFb(const fb::Quadruple& v) {
    return {v.x(), v.y(), v.z(), v.w()};
}

Affine fromFb(const fb::Affine& a) {
    return {{fromFb(a.row0()), fromFb(a.row1()), fromFb(a.row2())}};
}

Offset<fb::Node> addNode(FlatBufferBuilder& builder, const MeshNode& node) {
    const auto name = builder.CreateString(node.name);
    const fb::Triple translation = toFb(node.translation);
    const fb::Quadruple rotation = toFb(node.rotation);
    const fb::Triple scale = toFb(node.scale);
    const fb::Affine matrix = toFb(node.matrix.value_or(Affine{}));
    return fb::CreateNode(builder, name, node.parent, &translation, &rotation, &scale,
                          node.matrix ? &matrix : nullptr, node.first_weight, node.weights);
}

Offset<fb::Clip> addClip(FlatBufferBuilder& builder, const MeshClip& clip) {
    std::vector<Offset<fb::Channel>> channels;
    for (const ClipChannel& channel : clip.channels) {
        const auto times = builder.CreateVector(channel.times);
        const auto values = builder.CreateVector(channel.values);
        channels.push_back(fb::CreateChannel(builder, channel.node, static_cast<fb::Member>(channel.member),
                                             static_cast<fb::Curve>(channel.curve), times, values));
    }
    const auto name = builder.CreateString(clip.name);
    const auto list = builder.CreateVector(channels);
    return fb::CreateClip(builder, name, clip.seconds, list);
}

MeshNode readNode(const fb::Node& from) {
    MeshNode node{.name = from.name()->str(),
                  .parent = from.parent(),
                  .translation = fromFb(*from.translation()),
                  .rotation = fromFb(*from.rotation()),
                  .scale = fromFb(*from.scale()),
                  .matrix = {},
                  .first_weight = from.first_weight(),
                  .weights = from.weights()};
    if (from.matrix() != nullptr) {
        node.matrix = fromFb(*from.matrix());
    }
    return node;
}

MeshClip readClip(const fb::Clip& from) {
    MeshClip clip{from.name()->str(), from.seconds(), {}};
    for (const fb::Channel* channel : *from.channels()) {
        clip.channels.push_back({channel->node(), static_cast<NodeMember>(channel->member()),
                                 static_cast<KeyCurve>(channel->curve()), copyAll(*channel->times()),
                                 copyAll(*channel->values())});
    }
    return clip;
}

/// Returns whether the copied data is no larger than the file: tables of a malicious file may overlap.
bool fits(const fb::AnimatedMesh& from, std::size_t file_bytes) {
    if (from.nodes()->size() > kMeshNodesMax || from.clips()->size() > kMeshClipsMax ||
        (from.materials() != nullptr && from.materials()->size() > kMeshMaterialsMax)) {
        return false;
    }
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; from.materials() != nullptr && i < from.materials()->size(); ++i) {
        bytes += from.materials()->Get(static_cast<flatbuffers::uoffset_t>(i))->size();
    }
    for (const fb::Node* node : *from.nodes()) {
        bytes += node->name()->size();
    }
    for (const fb::Clip* clip : *from.clips()) {
        bytes += clip->name()->size();
        for (const fb::Channel* channel : *clip->channels()) {
            bytes += sizeof(float) * (std::uint64_t{channel->times()->size()} + channel->values()->size());
        }
    }
    return bytes <= file_bytes;
}

/// Decodes the bytes; checks the structure of the file, but not the values.
Result<AnimatedMesh> unpack(std::span<const std::byte> bytes) {
    // Accessors require an alignment that `bytes` may lack.
    const auto aligned = std::make_unique<std::uint64_t[]>(bytes.size() / sizeof(std::uint64_t) + 1);
    std::memcpy(aligned.get(), bytes.data(), bytes.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(aligned.get());
    flatbuffers::Verifier verifier(data, bytes.size(), kDepthMax, kTablesMax);
    if (bytes.empty() || !fb::VerifyAnimatedMeshBuffer(verifier)) {
        return invalidInput("its animation is not a FlatBuffers table of an animated mesh; bake it again");
    }
    const fb::AnimatedMesh& from = *fb::GetAnimatedMesh(data);
    if (!fits(from, bytes.size())) {
        return fail(ErrorCode::kLimit,
                    "its animation declares more nodes, clips or keys than fit into the file; bake it again");
    }
    AnimatedMesh mesh;
    mesh.positions = copyAll<glm::vec3>(*from.positions());
    mesh.triangles = copyAll<glm::uvec3>(*from.triangles());
    mesh.influence_begin = copyAll(*from.influence_begin());
    mesh.influences = copyAll<VertexInfluence>(*from.influences());
    mesh.delta_begin = copyAll(*from.delta_begin());
    mesh.deltas = copyAll<MorphDelta>(*from.deltas());
    for (const fb::Node* node : *from.nodes()) {
        mesh.nodes.push_back(readNode(*node));
    }
    for (const fb::Joint* joint : *from.joints()) {
        mesh.joints.push_back({joint->node(), fromFb(joint->bind())});
    }
    mesh.weights = copyAll(*from.weights());
    for (const fb::Clip* clip : *from.clips()) {
        mesh.clips.push_back(readClip(*clip));
    }
    if (from.materials() != nullptr) {
        for (const flatbuffers::String* name : *from.materials()) {
            mesh.materials.push_back(name->str());
        }
    }
    if (from.triangle_materials() != nullptr) {
        mesh.triangle_materials = copyAll(*from.triangle_materials());
    }
    return mesh;
}

}  // namespace

std::vector<std::byte> writeAnimatedMesh(const AnimatedMesh& mesh) {
    FlatBufferBuilder builder;
    // Build them one by one: the evaluation order of function arguments is unspecified.
    std::vector<Offset<fb::Node>> nodes;
    for (const MeshNode& node : mesh.nodes) {
        nodes.push_back(addNode(builder, node));
    }
    std::vector<Offset<fb::Clip>> clips;
    for (const MeshClip& clip : mesh.clips) {
        clips.push_back(addClip(builder, clip));
    }
    std::vector<fb::Joint> joints;
    for (const MeshJoint& joint : mesh.joints) {
        joints.emplace_back(joint.node, toFb(joint.bind));
    }
    const auto positions = addAll<fb::Triple>(builder, mesh.positions);
    const auto triangles = addAll<fb::Triangle>(builder, mesh.triangles);
    const auto influence_begin = builder.CreateVector(mesh.influence_begin);
    const auto influences = addAll<fb::Influence>(builder, mesh.influences);
    const auto delta_begin = builder.CreateVector(mesh.delta_begin);
    const auto deltas = addAll<fb::Delta>(builder, mesh.deltas);
    const auto node_list = builder.CreateVector(nodes);
    const auto joint_list = builder.CreateVectorOfStructs(joints);
    const auto weights = builder.CreateVector(mesh.weights);
    const auto clip_list = builder.CreateVector(clips);
    flatbuffers::Offset<flatbuffers::Vector<Offset<flatbuffers::String>>> material_list;
    flatbuffers::Offset<flatbuffers::Vector<std::uint16_t>> triangle_materials;
    if (!mesh.materials.empty()) {  // omitted if empty, to keep the bytes of files without materials
        material_list = builder.CreateVectorOfStrings(mesh.materials);
        triangle_materials = builder.CreateVector(mesh.triangle_materials);
    }
    fb::FinishAnimatedMeshBuffer(
        builder, fb::CreateAnimatedMesh(builder, positions, triangles, influence_begin, influences,
                                        delta_begin, deltas, node_list, joint_list, weights, clip_list,
                                        material_list, triangle_materials));
    const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
    return {bytes.begin(), bytes.end()};
}

Result<AnimatedMesh> readAnimatedMesh(std::span<const std::byte> bytes) {
    AnimatedMesh mesh = RELIEF_TRY(unpack(bytes));
    RELIEF_TRY(validate(mesh));
    return mesh;
}

Result<AnimatedMesh> readAnimatedClips(std::span<const std::byte> bytes) {
    AnimatedMesh all = RELIEF_TRY(unpack(bytes));
    AnimatedMesh mesh;
    mesh.nodes = std::move(all.nodes);
    mesh.weights = std::move(all.weights);
    mesh.clips = std::move(all.clips);
    RELIEF_TRY(validateClips(mesh));
    return mesh;
}

}  // namespace relief
