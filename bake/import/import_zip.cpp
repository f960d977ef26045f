#include "bake/import/import_zip.h"

#include <zlib.h>

#include <algorithm>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint64_t kEndSignature = 0x06054b50;
constexpr std::uint64_t kEnd64Signature = 0x06064b50;
constexpr std::uint64_t kLocator64Signature = 0x07064b50;
constexpr std::uint64_t kEntrySignature = 0x02014b50;
constexpr std::uint64_t kFileSignature = 0x04034b50;
constexpr std::size_t kEndSize = 22;
constexpr std::size_t kLocator64Size = 20;
constexpr std::size_t kEntrySize = 46;
constexpr std::size_t kFileSize = 30;
constexpr std::size_t kCommentMax = 0xFFFF;
constexpr std::uint64_t kIn64 = 0xFFFFFFFF;   // a number that the extra field has
constexpr std::uint64_t kDeflateMost = 1032;  // no byte of deflated data becomes more
constexpr std::size_t kQuotedMax = 80;        // bytes of a name shown in a message

/// \return whether all of it became `out`, and no more.
bool inflateAll(std::span<const std::byte> packed, std::span<std::byte> out) {
    constexpr std::size_t kPiece = std::size_t{1} << 30;  // zlib counts by 32 bits
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
        return false;
    }
    std::size_t in_at = 0;
    std::size_t out_at = 0;
    int state = Z_OK;
    while (state == Z_OK) {
        const std::size_t in = std::min(packed.size() - in_at, kPiece);
        const std::size_t room = std::min(out.size() - out_at, kPiece);
        std::byte none{};
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data() + in_at));
        stream.avail_in = static_cast<uInt>(in);
        stream.next_out = reinterpret_cast<Bytef*>(room > 0 ? out.data() + out_at : &none);
        stream.avail_out = static_cast<uInt>(room);
        state = inflate(&stream, Z_NO_FLUSH);
        in_at += in - stream.avail_in;
        out_at += room - stream.avail_out;
        if (state == Z_OK && stream.avail_in == in && stream.avail_out == room) {
            break;  // no way forward
        }
    }
    inflateEnd(&stream);
    return state == Z_STREAM_END && out_at == out.size();
}

}  // namespace

Result<ZipArchive> ZipArchive::open(std::span<const std::byte> bytes) {
    ZipArchive archive(bytes);
    if (!archive.readDirectory()) {
        return invalidInput("it is no ZIP archive, or was cut off; copy or export it again");
    }
    return archive;
}

Result<std::vector<std::byte>> ZipArchive::read(std::string_view name) const {
    const std::string shown = "'" + cleanUtf8(name, kQuotedMax) + "' of its archive";
    const auto found = entries_.find(lowerCase(name));
    if (found == entries_.end()) {
        return invalidInput(shown + " does not exist");
    }
    const Entry& entry = found->second;
    if ((entry.flags & 1U) != 0 || (entry.method != 0 && entry.method != Z_DEFLATED)) {
        return fail(ErrorCode::kUnsupported,
                    shown + " is encrypted, or packed in another way than by deflate");
    }
    const std::uint64_t begin =
        entry.header + kFileSize + number(entry.header + 26, 2) + number(entry.header + 28, 2);
    if (number(entry.header, 4) != kFileSignature || begin > bytes_.size() ||
        entry.packed > bytes_.size() - begin ||
        (entry.method == 0 ? entry.size != entry.packed : entry.size / kDeflateMost > entry.packed)) {
        return invalidInput(shown + " is damaged");
    }
    const std::span packed = bytes_.subspan(begin, entry.packed);
    std::vector<std::byte> bytes;
    if (entry.method == 0) {
        bytes.assign(packed.begin(), packed.end());
    } else {
        bytes.resize(entry.size);
        if (!inflateAll(packed, bytes)) {
            return invalidInput(shown + " is damaged");
        }
    }
    if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != entry.checksum) {
        return invalidInput(shown + " is damaged: its checksum is wrong");
    }
    return bytes;
}

bool ZipArchive::readDirectory() {
    if (bytes_.size() < kEndSize) {
        return false;
    }
    // A comment may follow.
    std::uint64_t end = bytes_.size() - kEndSize;
    const std::uint64_t least = end > kCommentMax ? end - kCommentMax : 0;
    while (number(end, 4) != kEndSignature) {
        if (end-- == least) {
            return false;
        }
    }
    std::uint64_t count = number(end + 10, 2);
    std::uint64_t at = number(end + 16, 4);
    if (end >= kLocator64Size && number(end - kLocator64Size, 4) == kLocator64Signature) {
        const std::uint64_t end64 = number(end - kLocator64Size + 8, 8);
        if (number(end64, 4) != kEnd64Signature) {
            return false;
        }
        count = number(end64 + 32, 8);
        at = number(end64 + 48, 8);
    }
    for (; count > 0; --count) {
        if (!readEntry(at)) {
            return false;
        }
    }
    return true;
}

bool ZipArchive::readEntry(std::uint64_t& at) {
    if (at > bytes_.size() || bytes_.size() - at < kEntrySize || number(at, 4) != kEntrySignature) {
        return false;
    }
    Entry entry;
    entry.flags = static_cast<std::uint16_t>(number(at + 8, 2));
    entry.method = static_cast<std::uint16_t>(number(at + 10, 2));
    entry.checksum = static_cast<std::uint32_t>(number(at + 16, 4));
    entry.packed = number(at + 20, 4);
    entry.size = number(at + 24, 4);
    entry.header = number(at + 42, 4);
    const std::uint64_t name_size = number(at + 28, 2);
    const std::uint64_t extra_size = number(at + 30, 2);
    const std::uint64_t comment_size = number(at + 32, 2);
    const std::uint64_t name_at = at + kEntrySize;
    at = name_at + name_size + extra_size + comment_size;
    if (at > bytes_.size()) {
        return false;
    }
    const std::uint64_t extra_end = name_at + name_size + extra_size;
    for (std::uint64_t extra = name_at + name_size; extra + 4 <= extra_end;) {
        std::uint64_t field = extra + 4;
        const std::uint64_t field_end = std::min(field + number(extra + 2, 2), extra_end);
        if (number(extra, 2) == 1) {
            for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.header}) {
                if (*value == kIn64 && field + 8 <= field_end) {
                    *value = number(field, 8);
                    field += 8;
                }
            }
        }
        extra = field_end;
    }
    if (entry.header > bytes_.size()) {
        return false;
    }
    const std::string_view name(reinterpret_cast<const char*>(bytes_.data() + name_at), name_size);
    entries_[lowerCase(name)] = entry;
    return true;
}

std::uint64_t ZipArchive::number(std::uint64_t at, std::size_t size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) {
        return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = size; i > 0; --i) {
        value = value << 8U | std::to_integer<std::uint64_t>(bytes_[at + i - 1]);
    }
    return value;
}

}  // namespace relief
