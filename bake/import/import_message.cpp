// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_protocol.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "bake/import/import_files.h"
#include "bake/import/level.h"
#include "formats/base/finite.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kErrorBytesMax = 4096;
constexpr std::size_t kWarningsMax = 100;
constexpr std::size_t kFilesMax = 100'000;

/// Counts the bytes of a message, and writes them if there is a target.
class Writer {
  public:
    explicit Writer(std::byte* target = nullptr) : target_(target) {}

    [[nodiscard]] std::uint64_t size() const { return size_; }

    template <class T>
    void number(const T& value) {
        put(&value, sizeof(value));
    }
    template <class List>
    void array(const List& values, std::uint64_t /*length_max*/) {
        number(std::uint64_t{values.size()});
        put(values.data(), values.size() * sizeof(values[0]));
    }
    template <class T, class Each>
    void list(const std::vector<T>& values, std::uint64_t /*length_max*/, const Each& each) {
        number(std::uint64_t{values.size()});
        std::for_each(values.begin(), values.end(), each);
    }

  private:
    void put(const void* bytes, std::uint64_t size) {
        if (target_ != nullptr && size > 0) {
            std::memcpy(target_ + size_, bytes, size);
        }
        size_ += size;
    }

    std::byte* target_;
    std::uint64_t size_ = 0;
};

/// Reads a message that Writer wrote. Reads nothing after the first invalid length.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// Whether the message was complete and read to its end.
    [[nodiscard]] bool done() const { return good_ && bytes_.empty(); }

    template <class T>
    void number(T& value) {
        take(&value, sizeof(value));
    }
    template <class List>
    void array(List& values, std::uint64_t length_max) {
        values.resize(length(length_max, sizeof(values[0])));
        take(values.data(), values.size() * sizeof(values[0]));
    }
    template <class T, class Each>
    void list(std::vector<T>& values, std::uint64_t length_max, const Each& each) {
        values.resize(length(length_max, sizeof(std::uint64_t)));  // each element has at least a length
        std::for_each(values.begin(), values.end(), each);
    }

  private:
    std::uint64_t length(std::uint64_t length_max, std::uint64_t element_bytes) {
        std::uint64_t length = 0;
        number(length);
        good_ = good_ && length <= length_max && length <= bytes_.size() / element_bytes;
        return good_ ? length : 0;
    }
    void take(void* target, std::uint64_t size) {
        good_ = good_ && size <= bytes_.size();
        if (good_ && size > 0) {
            std::memcpy(target, bytes_.data(), size);
            bytes_ = bytes_.subspan(size);
        }
    }

    std::span<const std::byte> bytes_;
    bool good_ = true;
};

/// Writes or reads a mesh, depending on the channel.
template <class Channel, class Mesh>
void exchange(Channel& channel, Mesh& mesh, std::uint64_t triangle_max) {
    const auto text = [&](auto& value) { channel.array(value, kImportBytesMax); };
    text(mesh.unit);
    channel.number(mesh.unused_vertices);
    channel.list(mesh.warnings, kWarningsMax, text);
    channel.list(mesh.dependencies, kFilesMax, text);
    channel.list(mesh.dependency_hashes, kFilesMax, text);
    channel.list(mesh.surface_names, kSurfaceNamesMax, [&](auto& name) {
        channel.number(name.node_index);
        text(name.node);
        text(name.material);
        channel.number(name.restitution);
        channel.number(name.friction);
    });
    channel.array(mesh.positions, 3 * triangle_max);
    channel.array(mesh.triangles, triangle_max);
    channel.array(mesh.marks, triangle_max);
    channel.array(mesh.labels, triangle_max);
    channel.list(mesh.level_meshes, kLevelMeshesMax, [&](auto& one) {
        text(one.name);
        channel.number(one.positions);
        channel.number(one.triangles);
    });
    channel.list(mesh.level_bodies, kLevelBodiesMax, [&](auto& body) {
        channel.number(body.mesh);
        text(body.node);
        channel.number(body.position);
        channel.number(body.rotation);
        channel.number(body.scale);
    });
    channel.array(mesh.animation, kImportBytesMax);
}

void write(Writer& writer, const Result<TriangleMesh>& raw) {
    writer.number(raw ? std::uint32_t{0} : static_cast<std::uint32_t>(raw.error().code));
    if (raw) {
        exchange(writer, *raw, kTriangleMax);
    } else {
        writer.array(raw.error().message, kErrorBytesMax);
    }
}

tl::unexpected<Error> noMessage() {
    return invalidInput("the importer returned bytes that are not a mesh");
}

}  // namespace

std::uint64_t importMessageSize(const Result<TriangleMesh>& raw) {
    Writer counter;
    write(counter, raw);
    return counter.size();
}

void writeImportMessage(const Result<TriangleMesh>& raw, std::span<std::byte> target) {
    Writer writer(target.data());
    write(writer, raw);
}

Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes, std::uint64_t triangle_max) {
    Reader reader(bytes);
    auto code = static_cast<std::uint32_t>(ErrorCode::kFailure);  // if the message has no code
    reader.number(code);
    if (code != 0) {
        std::string message;
        reader.array(message, kImportBytesMax);
        if (!reader.done() || code > static_cast<std::uint32_t>(ErrorCode::kDifference)) {
            return noMessage();
        }
        return fail(static_cast<ErrorCode>(code), cleanUtf8(message, kErrorBytesMax));
    }
    TriangleMesh raw;
    exchange(reader, raw, triangle_max);
    const bool named = std::ranges::all_of(
        raw.labels, [&raw](std::uint32_t label) { return label < raw.surface_names.size(); });
    if (!reader.done() || !named ||
        raw.unused_vertices > kImportBytesMax ||  // a vertex takes more than a byte
        (!raw.marks.empty() && raw.marks.size() != raw.triangles.size()) ||
        (!raw.labels.empty() && raw.labels.size() != raw.triangles.size())) {
        return noMessage();
    }
    for (std::string& warning : raw.warnings) {
        warning = cleanUtf8(warning, kErrorBytesMax);
    }
    for (SurfaceName& name : raw.surface_names) {
        name.node = cleanUtf8(name.node, kSelectedNameBytesMax);
        name.material = cleanUtf8(name.material, kSelectedNameBytesMax);
        if (!isFraction(name.restitution) || !isFraction(name.friction)) {
            return noMessage();
        }
    }
    for (LevelMesh& mesh : raw.level_meshes) {
        mesh.name = cleanUtf8(mesh.name, kSelectedNameBytesMax);
    }
    for (LevelBody& body : raw.level_bodies) {
        body.node = cleanUtf8(body.node, kSelectedNameBytesMax);
    }
    return raw;
}

}  // namespace relief
