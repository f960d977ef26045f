#include "runtime/vdb_module/vdb_file.h"

#include <openvdb/io/Archive.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <string>

#include "formats/base/hash.h"

namespace relief {
namespace {

/// In memory, with the grids' offsets, as in a file that other programs read part by part.
class MemoryArchive : public openvdb::io::Archive {
  public:
    [[nodiscard]] Ptr copy() const override { return Ptr(new MemoryArchive(*this)); }
    void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids) {
        // Zip and Blosc do not belong to every build of OpenVDB; without either any of them reads the file.
        setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
        setGridStatsMetadataEnabled(false);
        Archive::write(out, grids, true);
    }
};

// A header is the magic number, three versions and a flag; then 36 letters that identify the file, drawn at random.
constexpr std::size_t kTagAt = 8 + 3 * 4 + 1;
constexpr std::size_t kTagSize = 36;

/// The letters come from the bytes instead, so that equal content is an equal file.
void nameByContent(std::string& bytes) {
    const auto tag = bytes.begin() + static_cast<std::ptrdiff_t>(kTagAt);
    std::fill_n(tag, kTagSize, '0');
    const std::string hash = xxh3_128Hex(std::as_bytes(std::span(bytes)));
    std::size_t from = 0;
    for (std::size_t i = 0; i < kTagSize; ++i) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        bytes[kTagAt + i] = dash ? '-' : hash[from++];
    }
}

}  // namespace

Result<std::vector<std::byte>> vdbBytes(const std::function<openvdb::GridPtrVec()>& make) {
    try {
        openvdb::initialize();
        const openvdb::GridPtrVec made = make();
        const openvdb::GridCPtrVec grids(made.begin(), made.end());
        std::ostringstream out;
        MemoryArchive().writeTo(out, grids);
        std::string bytes = std::move(out).str();
        nameByContent(bytes);
        const auto* const data = reinterpret_cast<const std::byte*>(bytes.data());
        return std::vector<std::byte>(data, data + bytes.size());
    } catch (const std::exception& error) {
        return fail(ErrorCode::kFailure, std::string("OpenVDB: ") + error.what());
    }
}

}  // namespace relief
