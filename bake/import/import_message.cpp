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
        import_fb::MessageBuilder message(builder);
        message.add_unit(unit);
        message.add_warnings(warnings);
        message.add_files(files);
        message.add_positions(raw->positions.size());
        message.add_triangles(raw->triangles.size());
        message.add_unused_vertices(raw->unused_vertices);
        message.add_marks(raw->marks.size());
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
    return raw;
}

}  // namespace relief
