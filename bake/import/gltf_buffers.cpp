#include "bake/import/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kHeader = 12;      // of a GLB: magic, version, length
constexpr std::size_t kChunkHeader = 8;  // its length and type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kShownUri = 200;  // bytes of it in a message
constexpr const char* kCutOff = "and was probably cut off; copy or export it again";

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

/// 0…15, or -1.
int hexadecimal(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

Result<std::string> percentDecoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hexadecimal(text[i + 2]) : -1;
        if (high < 0 || low < 0) {
            return invalidInput("has a % without two hexadecimal digits behind it; write %25 for the sign");
        }
        out += static_cast<char>(16 * high + low);
        i += 2;
    }
    return out;
}

/// 0…63, or -1.
int base64Digit(char c) {
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
                                  : -1;
}

/// With or without its padding.
std::optional<std::vector<std::byte>> base64Bytes(std::string_view text) {
    if (text.size() % 4 == 0) {
        text.remove_suffix(text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0);
    }
    if (text.size() % 4 == 1) {
        return std::nullopt;
    }
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    unsigned count = 0;
    for (const char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0) {
            return std::nullopt;
        }
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count & 0xFFU));
        }
    }
    return bytes;
}

bool isDataUri(std::string_view uri) {
    return lowerCase(uri.substr(0, 5)) == "data:";
}

}  // namespace

Result<GltfChunks> gltfChunks(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    GltfChunks chunks;
    chunks.json = text;
    if (!text.starts_with("glTF")) {
        return chunks;
    }
    if (bytes.size() < kHeader + kChunkHeader) {
        return invalidInput(std::string("it ends within its header, ") + kCutOff);
    }
    if (word(bytes, 4) != 2) {
        return fail(ErrorCode::kUnsupported, "binary glTF of version " + std::to_string(word(bytes, 4)) +
                                                 " is not read; save it as glTF 2.0");
    }
    const std::size_t length = word(bytes, 8);
    if (length > bytes.size()) {
        return invalidInput("it has " + std::to_string(bytes.size()) + " of the " + std::to_string(length) +
                            " bytes that its header announces, " + kCutOff);
    }
    if (length < bytes.size()) {
        chunks.warnings.push_back(std::to_string(bytes.size() - length) +
                                  " bytes behind the end that its header announces are left out");
    }
    std::size_t number = 0;
    for (std::size_t at = kHeader; at < length; ++number) {
        if (length - at < kChunkHeader || word(bytes, at) > length - at - kChunkHeader) {
            return invalidInput("its chunk " + std::to_string(number) +
                                " ends behind the file; export it again");
        }
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += kChunkHeader;
        if (size % 4 != 0 && at + size < length) {
            return invalidInput("the length of its chunk " + std::to_string(number) +
                                " is no multiple of 4; export it again");
        }
        if ((number == 0) != (type == kJsonChunk) || (number > 1 && type == kBinaryChunk)) {
            return invalidInput(
                "its first chunk is no JSON, or its second not the binary one; export it again");
        }
        if (type == kJsonChunk) {
            chunks.json = text.substr(at, size);
        } else if (type == kBinaryChunk) {
            chunks.binary = bytes.subspan(at, size);
        }
        at += size;
    }
    if (number == 0) {
        return invalidInput(std::string("it has no JSON, ") + kCutOff);
    }
    return chunks;
}

Result<std::vector<std::byte>> dataUriBytes(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) {
        return invalidInput("is a data URI without data");
    }
    if (!lowerCase(uri.substr(0, comma)).ends_with(";base64")) {
        return fail(ErrorCode::kUnsupported,
                    "holds its bytes otherwise than by base64, which is not read; export it as GLB");
    }
    std::string_view data = uri.substr(comma + 1);
    std::string decoded;
    if (data.find('%') != std::string_view::npos) {
        decoded = RELIEF_TRY(percentDecoded(data));
        data = decoded;
    }
    std::optional<std::vector<std::byte>> bytes = base64Bytes(data);
    if (!bytes) {
        return invalidInput("is no valid base64");
    }
    return *std::move(bytes);
}

Result<std::string> uriPath(std::string_view uri) {
    const auto outside = [uri] {
        return invalidInput("refers to '" + cleanUtf8(uri, kShownUri) +
                            "', which is not below its folder; put the buffer beside it");
    };
    if (uri.empty() || uri.find(':') != std::string_view::npos) {
        return outside();
    }
    std::string path = RELIEF_TRY(percentDecoded(uri));
    std::string slashes = path;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const std::vector<std::string_view> parts = split(slashes, '/');
    if (slashes.starts_with('/') || std::find(parts.begin(), parts.end(), "..") != parts.end()) {
        return outside();
    }
    if (path.find('\0') != std::string::npos) {
        return invalidInput("holds a byte of 0");
    }
    return path;
}

Result<GltfBuffers> GltfBuffers::open(const GltfValue& document, const GltfChunks& chunks,
                                      ImportFiles& files) {
    GltfBuffers buffers(RELIEF_TRY(document.objects("buffers")), chunks, files);
    RELIEF_TRY(buffers.readBuffers());
    const GltfList views = RELIEF_TRY(document.objects("bufferViews"));
    RELIEF_TRY(buffers.readViews(views));
    return buffers;
}

Result<void> GltfBuffers::readBuffers() {
    buffers_.resize(list_.size());
    for (std::size_t i = 0; i < list_.size(); ++i) {
        const GltfValue place = RELIEF_TRY(list_.at(i));
        buffers_[i].length = RELIEF_TRY(place.neededWhole("byteLength"));
        const std::optional<std::string> uri = RELIEF_TRY(place.text("uri"));
        if (uri && !isDataUri(*uri)) {
            if (const Result<std::string> path = uriPath(*uri); !path) {
                return place.wrong(path.error().message, path.error().code);
            }
        }
    }
    return {};
}

Result<void> GltfBuffers::readViews(const GltfList& views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const GltfValue place = RELIEF_TRY(views.at(i));
        View view;
        view.buffer = RELIEF_TRY(place.neededWhole("buffer"));
        view.offset = RELIEF_TRY(place.whole("byteOffset")).value_or(0);
        view.length = RELIEF_TRY(place.neededWhole("byteLength"));
        view.stride = RELIEF_TRY(place.whole("byteStride"));
        RELIEF_TRY(list_.named(view.buffer, place, "buffer"));
        const std::uint64_t length = buffers_[view.buffer].length;
        if (view.offset > length || view.length > length - view.offset) {
            return place.wrong("ends behind its buffer");
        }
        if (view.stride == std::uint64_t{0}) {
            return place.wrong("has a byteStride of 0");
        }
        const std::optional<GltfValue> extensions = RELIEF_TRY(place.object("extensions"));
        view.compressed = extensions && (extensions->has("EXT_meshopt_compression") ||
                                         extensions->has("KHR_meshopt_compression"));
        views_.push_back(view);
    }
    return {};
}

Result<GltfView> GltfBuffers::view(const GltfValue& from) {
    const std::uint64_t index = RELIEF_TRY(from.neededWhole("bufferView"));
    if (index >= views_.size()) {
        return from.wrong("names bufferViews[" + std::to_string(index) + "], which does not exist");
    }
    const View& view = views_[index];
    if (view.compressed) {
        return fail(ErrorCode::kUnsupported, "bufferViews[" + std::to_string(index) +
                                                 "] is compressed by meshopt, which is not read; export it "
                                                 "without");
    }
    RELIEF_TRY(load(view.buffer));
    return GltfView{buffers_[view.buffer].bytes.subspan(view.offset, view.length), view.stride};
}

Result<void> GltfBuffers::load(std::uint64_t index) {
    Buffer& buffer = buffers_[index];
    if (buffer.loaded) {
        return {};
    }
    const GltfValue place = RELIEF_TRY(list_.at(index));
    const std::optional<std::string> uri = RELIEF_TRY(place.text("uri"));
    if (!uri) {
        if (index != 0 || !chunks_->binary) {
            return place.wrong("has no uri, and the file no bytes for it");
        }
        buffer.bytes = *chunks_->binary;
    } else if (isDataUri(*uri)) {
        Result<std::vector<std::byte>> bytes = dataUriBytes(*uri);
        if (!bytes) {
            return place.wrong(bytes.error().message, bytes.error().code);
        }
        buffer.owned = *std::move(bytes);
        buffer.bytes = buffer.owned;
    } else {
        RELIEF_TRY(loadFile(buffer, place, *uri));
    }
    if (buffer.bytes.size() < buffer.length) {
        return place.wrong("has " + std::to_string(buffer.bytes.size()) + " of the " +
                           std::to_string(buffer.length) + " bytes that it announces, " + kCutOff);
    }
    buffer.bytes = buffer.bytes.first(buffer.length);
    buffer.loaded = true;
    return {};
}

Result<void> GltfBuffers::loadFile(Buffer& buffer, const GltfValue& place, const std::string& uri) {
    const std::string path = RELIEF_TRY(uriPath(uri));
    if (files_->isMesh(path)) {
        buffer.bytes = files_->meshBytes();
        return {};
    }
    std::optional<std::vector<std::byte>> bytes = files_->open(path);
    if (!bytes) {
        return place.wrong(
            "refers to " +
            (files_->refused().empty() ? "'" + cleanUtf8(path, kShownUri) + "'" : files_->refused().back()) +
            "; put the buffer beside the mesh");
    }
    buffer.owned = *std::move(bytes);
    buffer.bytes = buffer.owned;
    return {};
}

}  // namespace relief
