#include "bake/import/import_message.h"

#include <flatbuffers/flatbuffers.h>

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

template <class T>
void copyArray(std::span<const std::byte> bytes, std::vector<T>& out) {
    out.resize(bytes.size() / sizeof(T));
    if (!bytes.empty()) {
        std::memcpy(static_cast<void*>(out.data()), bytes.data(), bytes.size());
    }
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

/// Runs of equal labels.
struct LabelRuns {
    std::vector<std::uint32_t> labels;
    std::vector<std::uint64_t> triangles;
};
LabelRuns runsOf(const std::vector<std::uint32_t>& labels) {
    LabelRuns runs;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (i == 0 || labels[i] != labels[i - 1]) {
            runs.labels.push_back(labels[i]);
            runs.triangles.push_back(0);
        }
        ++runs.triangles.back();
    }
    return runs;
}

/// \return whether the runs are those of the mesh's triangles.
bool readLabels(const import_fb::Message& message, TriangleMesh& raw) {
    const auto* surfaces = message.surfaces();
    const auto* labels = message.run_labels();
    const auto* triangles = message.run_triangles();
    if (labels == nullptr || labels->size() == 0) {
        return true;
    }
    if (surfaces == nullptr || triangles == nullptr || triangles->size() != labels->size() ||
        surfaces->size() > kSurfaceNamesMax) {
        return false;
    }
    for (const import_fb::Surface* surface : *surfaces) {
        raw.surface_names.push_back({surface->node_index(),
                                     cleanUtf8(textOf(surface->node()), kAskedNameBytesMax),
                                     cleanUtf8(textOf(surface->material()), kAskedNameBytesMax)});
    }
    std::uint64_t left = message.triangles();
    raw.labels.reserve(left);
    for (flatbuffers::uoffset_t i = 0; i < labels->size(); ++i) {
        if (labels->Get(i) >= surfaces->size() || triangles->Get(i) > left) {
            return false;
        }
        raw.labels.insert(raw.labels.end(), triangles->Get(i), labels->Get(i));
        left -= triangles->Get(i);
    }
    return left == 0;
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
        const LabelRuns runs = runsOf(raw->labels);
        const auto run_labels = builder.CreateVector(runs.labels);
        const auto run_triangles = builder.CreateVector(runs.triangles);
        import_fb::MessageBuilder message(builder);
        message.add_unit(unit);
        message.add_warnings(warnings);
        message.add_files(files);
        message.add_positions(raw->positions.size());
        message.add_triangles(raw->triangles.size());
        message.add_unused_vertices(raw->unused_vertices);
        message.add_marks(raw->marks.size());
        message.add_surfaces(surfaces);
        message.add_run_labels(run_labels);
        message.add_run_triangles(run_triangles);
        import_fb::FinishMessageBuffer(builder, message.Finish());
        arrays = 12 * (raw->positions.size() + raw->triangles.size()) + raw->marks.size();
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
    std::memcpy(target.data(), message.head.data(), message.head.size());
    if (!raw) {
        return;
    }
    std::byte* const arrays = target.data() + message.head.size();
    const std::size_t positions = 12 * raw->positions.size();
    const std::size_t triangles = 12 * raw->triangles.size();
    if (positions != 0) {
        std::memcpy(arrays, raw->positions.data(), positions);
    }
    if (triangles != 0) {
        std::memcpy(arrays + positions, raw->triangles.data(), triangles);
    }
    if (!raw->marks.empty()) {
        std::memcpy(arrays + positions + triangles, raw->marks.data(), raw->marks.size());
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
        head + 12 * (message.positions() + message.triangles()) + message.marks() != bytes.size()) {
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
    const std::uint64_t triangles = head + 12 * message.positions();
    const std::uint64_t marks = triangles + 12 * message.triangles();
    copyArray(bytes.subspan(head, triangles - head), raw.positions);
    copyArray(bytes.subspan(triangles, marks - triangles), raw.triangles);
    copyArray(bytes.subspan(marks, message.marks()), raw.marks);
    return readLabels(message, raw) ? Result<TriangleMesh>(std::move(raw)) : noMessage();
}

}  // namespace relief
