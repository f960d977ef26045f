#include "runtime/files/flow_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>
#include <system_error>
#include <vector>

#include "formats/base/error_context.h"
#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little,
              "raw flows are little-endian and copied as they are");

// The largest image. 512 x 512 pixels take no more than 12 MiB; other channels may come along.
constexpr std::uint64_t kImageBytesMax = std::uint64_t{64} << 20U;

class MemoryStream final : public Imf::IStream {
  public:
    MemoryStream(const std::vector<std::byte>& bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    bool read(char c[], int n) override {
        const auto count = static_cast<std::uint64_t>(n);
        if (n < 0 || at_ > bytes_.size() || count > bytes_.size() - at_) {
            throw std::runtime_error("it ends early");
        }
        std::memcpy(c, bytes_.data() + at_, count);
        at_ += count;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

  private:
    const std::vector<std::byte>& bytes_;
    std::uint64_t at_ = 0;
};

struct Slice {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::vector<glm::vec3> nodes;  // from the lowest y
};

Result<Slice> decode(const std::vector<std::byte>& bytes, const std::string& name) {
    MemoryStream stream(bytes, name);
    Imf::InputFile file(stream, 0);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    // OpenEXR has checked that a window is not empty and its sides fit an int.
    Slice slice;
    slice.width = static_cast<std::uint64_t>(std::int64_t{window.max.x} - window.min.x + 1);
    slice.height = static_cast<std::uint64_t>(std::int64_t{window.max.y} - window.min.y + 1);
    RELIEF_TRY(inFront(name, checkFlowSize({slice.width, slice.height, 1})));
    const Imf::ChannelList& channels = header.channels();
    if (channels.findChannel("R") == nullptr || channels.findChannel("G") == nullptr) {
        return fail(ErrorCode::kInvalidInput,
                    name + " has no channels R and G, the velocity along x and y; name them so");
    }
    std::vector<glm::vec3> rows(slice.width * slice.height, glm::vec3(0.0F));
    const auto stride = static_cast<std::int64_t>(sizeof(glm::vec3));
    const std::int64_t skipped =
        window.min.x * stride + window.min.y * stride * static_cast<std::int64_t>(slice.width);
    Imf::FrameBuffer frame;
    constexpr const char* kNames[] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 3; ++i) {
        if (channels.findChannel(kNames[i]) == nullptr) {
            continue;
        }
        // OpenEXR wants the address that pixel (0, 0) has or would have: as an integer, for it may lie
        // outside.
        const auto first = reinterpret_cast<std::uintptr_t>(rows.data()) + i * sizeof(float);
        auto* base = reinterpret_cast<char*>(first - static_cast<std::uintptr_t>(skipped));
        frame.insert(kNames[i],
                     Imf::Slice(Imf::FLOAT, base, sizeof(glm::vec3), sizeof(glm::vec3) * slice.width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    slice.nodes.reserve(rows.size());
    for (std::uint64_t y = slice.height; y-- > 0;) {
        const auto row = rows.begin() + static_cast<std::ptrdiff_t>(y * slice.width);
        slice.nodes.insert(slice.nodes.end(), row, row + static_cast<std::ptrdiff_t>(slice.width));
    }
    return slice;
}

Result<Slice> readImage(const fs::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kImageBytesMax));
    // Before anything is allocated for a size that the file merely claims. 0 is OpenEXR's own "no limit".
    struct SizeLimit {
        SizeLimit() { Imf::Header::setMaxImageSize(FlowField::kSideMax, FlowField::kSideMax); }
        ~SizeLimit() { Imf::Header::setMaxImageSize(0, 0); }
    };
    const SizeLimit limit;
    const std::string name = quotedPath(path);
    try {
        return decode(bytes, name);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, "out of memory while reading " + name);
    } catch (const std::exception& error) {
        const std::string words = quotedPath(fs::path(error.what()));
        return fail(ErrorCode::kInvalidInput,
                    name + " is no EXR image of at most 512x512 pixels that can be read: " +
                        words.substr(1, words.size() - 2));
    }
}

/// The number in a file name: its first byte, the byte behind it, and its width.
struct SliceNumber {
    std::size_t begin;
    std::size_t end;
    std::size_t width;
    bool zeros;
};

std::optional<SliceNumber> sliceNumber(const std::string& name) {
    std::optional<SliceNumber> found;
    for (std::size_t i = name.find('%'); i != std::string::npos; i = name.find('%', i + 1)) {
        SliceNumber number{i, i + 1, 0, false};
        if (number.end < name.size() && name[number.end] == '0') {
            number.zeros = true;
            ++number.end;
        }
        if (number.end < name.size() && name[number.end] >= '1' && name[number.end] <= '9') {
            number.width = static_cast<std::size_t>(name[number.end] - '0');
            ++number.end;
        }
        if (found || number.end >= name.size() || name[number.end] != 'd') {
            return std::nullopt;
        }
        ++number.end;
        found = number;
    }
    return found;
}

fs::path slicePath(const fs::path& pattern, std::uint32_t index) {
    const std::string name = pattern.filename().native();
    const SliceNumber number = *sliceNumber(name);
    std::string digits = std::to_string(index);
    if (digits.size() < number.width) {
        digits.insert(0, number.width - digits.size(), number.zeros ? '0' : ' ');
    }
    return pattern.parent_path() / (name.substr(0, number.begin) + digits + name.substr(number.end));
}

bool fileExists(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
}

struct SliceCount {
    std::uint32_t first;
    std::uint32_t count;  // at most one more than a flow may have
};

/// The slices that are there, up to the first gap.
SliceCount countSlices(const fs::path& pattern) {
    SliceCount slices{fileExists(slicePath(pattern, 0)) ? 0U : 1U, 0};
    while (slices.count <= FlowField::kSideMax &&
           fileExists(slicePath(pattern, slices.first + slices.count))) {
        ++slices.count;
    }
    return slices;
}

Result<void> readSlices(const FlowFile& file, FlowField& flow) {
    if (!hasSliceNumber(file.path.filename().native())) {
        return fail(ErrorCode::kInvalidInput,
                    quotedPath(file.path) + " needs one number, as in 'flow_%03d.exr', in its file name");
    }
    const auto [first, count] = countSlices(file.path);
    // A missing slice must not be taken for the end.
    for (std::uint32_t i = first + count + 1; i <= first + FlowField::kSideMax; ++i) {
        if (fileExists(slicePath(file.path, i))) {
            return fail(ErrorCode::kInvalidInput, quotedPath(slicePath(file.path, first + count)) +
                                                      " is missing, but there is " +
                                                      quotedPath(slicePath(file.path, i)));
        }
    }
    if (count == 0) {
        return fail(ErrorCode::kIo, "there is neither " + quotedPath(slicePath(file.path, 0)) + " nor " +
                                        quotedPath(slicePath(file.path, 1)));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const fs::path path = slicePath(file.path, first + i);
        auto slice = RELIEF_TRY(readImage(path));
        if (i == 0) {
            flow.size = {static_cast<std::uint32_t>(slice.width), static_cast<std::uint32_t>(slice.height),
                         count};
            RELIEF_TRY(inFront(quotedPath(path), checkFlowSize({slice.width, slice.height, count})));
        } else if (slice.width != flow.size[0] || slice.height != flow.size[1]) {
            return fail(ErrorCode::kInvalidInput,
                        quotedPath(path) + " is " + std::to_string(slice.width) + "x" +
                            std::to_string(slice.height) + " pixels, the first slice " +
                            std::to_string(flow.size[0]) + "x" + std::to_string(flow.size[1]) +
                            "; all must be of one size");
        }
        flow.nodes.insert(flow.nodes.end(), slice.nodes.begin(), slice.nodes.end());
    }
    return {};
}

Result<void> readRaw(const FlowFile& file, FlowField& flow) {
    const std::string name = quotedPath(file.path);
    if (file.components != 2 && file.components != 3) {
        return fail(ErrorCode::kUsage, name + ": a node has 2 or 3 components");
    }
    RELIEF_TRY(inFront(name, checkFlowSize({file.size[0], file.size[1], file.size[2]})));
    const std::size_t nodes = std::size_t{file.size[0]} * file.size[1] * file.size[2];
    const std::size_t expected = nodes * file.components * sizeof(float);
    const auto bytes = RELIEF_TRY(readFile(file.path, FlowField::kNodesMax * 3 * sizeof(float)));
    if (bytes.size() != expected) {
        return fail(ErrorCode::kInvalidInput, name + " has " + std::to_string(bytes.size()) +
                                                  " bytes, but size and components ask for " +
                                                  std::to_string(expected));
    }
    flow.size = file.size;
    flow.nodes.assign(nodes, glm::vec3(0.0F));
    for (std::size_t i = 0; i < nodes; ++i) {
        const std::size_t node_bytes = file.components * sizeof(float);
        std::memcpy(&flow.nodes[i].x, bytes.data() + i * node_bytes, node_bytes);
    }
    return {};
}

Result<void> checkSpeeds(const FlowFile& file, const FlowField& flow) {
    const std::size_t slice = std::size_t{flow.size[0]} * flow.size[1];
    for (std::size_t i = 0; i < flow.nodes.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const float v = flow.nodes[i][axis];
            if (std::abs(v) <= kFlowSpeedMax) {  // false for NaN
                continue;
            }
            return fail(ErrorCode::kInvalidInput,
                        quotedPath(file.path) + ": the velocity at node " + std::to_string(i % flow.size[0]) +
                            ", " + std::to_string(i / flow.size[0] % flow.size[1]) + ", " +
                            std::to_string(i / slice) +
                            (std::isfinite(v) ? " is above 1000000 a second" : " is not finite"));
        }
    }
    return {};
}

Result<FlowField> load(const FlowFile& file) {
    FlowField flow;
    flow.box_min = file.box_min;
    flow.box_max = file.box_max;
    flow.outside = file.outside;
    flow.gain = file.gain;
    if (file.kind == FlowFileKind::kRaw) {
        RELIEF_TRY(readRaw(file, flow));
    } else if (file.kind == FlowFileKind::kSlices) {
        RELIEF_TRY(readSlices(file, flow));
    } else {
        auto image = RELIEF_TRY(readImage(file.path));
        flow.size = {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), 1};
        flow.nodes = std::move(image.nodes);
    }
    RELIEF_TRY(checkSpeeds(file, flow));
    RELIEF_TRY(inFront(quotedPath(file.path), checkFlow(flow)));
    return flow;
}

}  // namespace

bool hasSliceNumber(const std::string& name) {
    return sliceNumber(name).has_value();
}

std::vector<fs::path> flowPaths(const FlowFile& file) {
    if (file.kind != FlowFileKind::kSlices || !hasSliceNumber(file.path.filename().native())) {
        return {file.path};
    }
    const SliceCount slices = countSlices(file.path);
    std::vector<fs::path> paths;
    for (std::uint32_t i = 0; i < slices.count; ++i) {
        paths.push_back(slicePath(file.path, slices.first + i));
    }
    return paths;
}

Result<FlowField> loadFlow(const FlowFile& file) {
    auto flow = load(file);
    if (!flow && !file.origin.empty()) {
        return fail(flow.error().code, file.origin + flow.error().message);
    }
    return flow;
}

}  // namespace relief
