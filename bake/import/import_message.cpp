#include "bake/import/import_message.h"

#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "bake/import/import_files.h"
#include "formats/base/text.h"
#include "formats/validate.h"
#include "import_message_generated.h"

namespace relief {
namespace {

constexpr std::size_t kPrefixBytes = 16;
constexpr flatbuffers::uoffset_t kDepthMax = 4;
constexpr std::size_t kErrorBytesMax = 4096;
constexpr std::size_t kWarningsMax = 100;
constexpr std::size_t kFilesMax = 100'000;
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

std::uint64_t padded(std::uint64_t size) {
    return (size + 15) / 16 * 16;
}

tl::unexpected<Error> noMessage() {
    return fail(ErrorCode::kInvalidInput, "the importer answers with bytes that are no mesh");
}

std::string textOf(const flatbuffers::String* text) {
    return text == nullptr ? std::string() : text->str();
}

/// The arrays behind the table.
std::array<std::span<const std::byte>, 4> arraysOf(const TriangleMesh& mesh) {
    return {std::as_bytes(std::span(mesh.positions)), std::as_bytes(std::span(mesh.triangles)),
            std::as_bytes(std::span(mesh.marks)), std::as_bytes(std::span(mesh.labels))};
}

/// Takes an array of that many off the bytes, which hold it.
template <class T>
void takeArray(std::span<const std::byte>& bytes, std::uint64_t count, std::vector<T>& out) {
    out.resize(count);
    if (count > 0) {
        std::memcpy(static_cast<void*>(out.data()), bytes.data(), count * sizeof(T));
    }
    bytes = bytes.subspan(count * sizeof(T));
}

using Surfaces = flatbuffers::Vector<flatbuffers::Offset<import_fb::Surface>>;

flatbuffers::Offset<Surfaces> writeSurfaces(flatbuffers::FlatBufferBuilder& builder,
                                            const TriangleMesh& raw) {
    std::vector<flatbuffers::Offset<import_fb::Surface>> surfaces;
    for (const SurfaceName& name : raw.surface_names) {
        surfaces.push_back(import_fb::CreateSurfaceDirect(builder, name.node_index, name.node.c_str(),
                                                          name.material.c_str()));
    }
    return builder.CreateVector(surfaces);
}

}  // namespace

ImportMessage makeImportMessage(const Result<TriangleMesh>& raw) {
    flatbuffers::FlatBufferBuilder builder;
    std::uint64_t arrays = 0;
    if (!raw) {
        const auto text = builder.CreateString(raw.error().message);
        import_fb::MessageBuilder message(builder);
        message.add_error_code(static_cast<std::uint32_t>(raw.error().code));
        message.add_error_message(text);
        import_fb::FinishMessageBuffer(builder, message.Finish());
    } else {
        const auto unit = builder.CreateString(raw->unit);
        const auto warnings = builder.CreateVectorOfStrings(raw->warnings);
        std::vector<flatbuffers::Offset<import_fb::File>> list;
        for (std::size_t i = 0; i < raw->dependencies.size(); ++i) {
            list.push_back(import_fb::CreateFileDirect(builder, raw->dependencies[i].c_str(),
                                                       raw->dependency_hashes[i].c_str()));
        }
        const auto files = builder.CreateVector(list);
        const auto surfaces = writeSurfaces(builder, *raw);
        import_fb::MessageBuilder message(builder);
        message.add_unit(unit);
        message.add_warnings(warnings);
        message.add_files(files);
        message.add_positions(raw->positions.size());
        message.add_triangles(raw->triangles.size());
        message.add_unused_vertices(raw->unused_vertices);
        message.add_marks(raw->marks.size());
        message.add_surfaces(surfaces);
        message.add_labels(raw->labels.size());
        import_fb::FinishMessageBuffer(builder, message.Finish());
        for (const std::span<const std::byte> array : arraysOf(*raw)) {
            arrays += array.size();
        }
    }
    ImportMessage made;
    const std::uint64_t table = builder.GetSize();
    made.head.resize(padded(kPrefixBytes + table));
    std::memcpy(made.head.data(), &table, sizeof(table));
    std::memcpy(made.head.data() + kPrefixBytes, builder.GetBufferPointer(), table);
    made.size = made.head.size() + arrays;
    return made;
}

void writeImportMessage(const ImportMessage& message, const Result<TriangleMesh>& raw,
                        std::span<std::byte> target) {
    std::copy(message.head.begin(), message.head.end(), target.begin());
    target = target.subspan(message.head.size());
    for (const std::span<const std::byte> array :
         raw ? arraysOf(*raw) : std::array<std::span<const std::byte>, 4>()) {
        std::copy(array.begin(), array.end(), target.begin());
        target = target.subspan(array.size());
    }
}

Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes, std::uint64_t triangle_max) {
    std::uint64_t table = 0;
    if (bytes.size() < kPrefixBytes) {
        return noMessage();
    }
    std::memcpy(&table, bytes.data(), sizeof(table));
    if (table > bytes.size() - kPrefixBytes || table >= FLATBUFFERS_MAX_BUFFER_SIZE || table < 8) {
        return noMessage();
    }
    const std::uint64_t head = padded(kPrefixBytes + table);
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data() + kPrefixBytes);
    flatbuffers::Verifier verifier(data, table, kDepthMax);
    if (head > bytes.size() || !import_fb::VerifyMessageBuffer(verifier)) {
        return noMessage();
    }
    const import_fb::Message& message = *import_fb::GetMessage(data);
    if (message.error_code() != 0) {
        const std::uint32_t code = message.error_code();
        if (code > static_cast<std::uint32_t>(ErrorCode::kDifference) || head != bytes.size()) {
            return noMessage();
        }
        return fail(static_cast<ErrorCode>(code), cleanUtf8(textOf(message.error_message()), kErrorBytesMax));
    }
    // Each bounded before they are added up.
    if (message.positions() > 3 * triangle_max || message.triangles() > triangle_max ||
        message.unused_vertices() > kImportBytesMax ||  // a vertex takes more than a byte
        !(message.marks() == 0 || message.marks() == message.triangles()) ||
        !(message.labels() == 0 || message.labels() == message.triangles()) ||
        head + 12 * (message.positions() + message.triangles()) + message.marks() + 4 * message.labels() !=
            bytes.size()) {
        return noMessage();
    }
    TriangleMesh raw;
    raw.unit = textOf(message.unit());
    raw.unused_vertices = message.unused_vertices();
    if (const auto* warnings = message.warnings(); warnings != nullptr) {
        if (warnings->size() > kWarningsMax) {
            return noMessage();
        }
        for (const flatbuffers::String* warning : *warnings) {
            raw.warnings.push_back(cleanUtf8(warning->str(), kErrorBytesMax));
        }
    }
    if (const auto* files = message.files(); files != nullptr) {
        if (files->size() > kFilesMax) {
            return noMessage();
        }
        for (const import_fb::File* file : *files) {
            raw.dependencies.push_back(file->path()->str());
            raw.dependency_hashes.push_back(file->hash()->str());
        }
    }
    if (const auto* surfaces = message.surfaces(); surfaces != nullptr) {
        if (surfaces->size() > kSurfaceNamesMax) {
            return noMessage();
        }
        for (const import_fb::Surface* surface : *surfaces) {
            raw.surface_names.push_back({surface->node_index(),
                                         cleanUtf8(textOf(surface->node()), kAskedNameBytesMax),
                                         cleanUtf8(textOf(surface->material()), kAskedNameBytesMax)});
        }
    }
    bytes = bytes.subspan(head);
    takeArray(bytes, message.positions(), raw.positions);
    takeArray(bytes, message.triangles(), raw.triangles);
    takeArray(bytes, message.marks(), raw.marks);
    takeArray(bytes, message.labels(), raw.labels);
    const bool named = std::all_of(raw.labels.begin(), raw.labels.end(),
                                   [&raw](std::uint32_t label) { return label < raw.surface_names.size(); });
    return named ? Result<TriangleMesh>(std::move(raw)) : noMessage();
}

}  // namespace relief
