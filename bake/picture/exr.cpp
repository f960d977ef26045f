#include "bake/picture/exr.h"

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <exception>

namespace relief {
namespace {

/// Seekable, as OpenEXR writes its table of offsets last, at the front.
class MemoryStream final : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}

    void write(const char c[], int n) override {
        const auto count = static_cast<std::size_t>(n);
        bytes_.resize(std::max(bytes_.size(), at_ + count));
        std::memcpy(bytes_.data() + at_, c, count);
        at_ += count;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
};

Imath::M44f rowVectorMatrix(const glm::dmat4& m) {
    Imath::M44f out;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            // glm's m[column] is a column; OpenEXR multiplies row vectors from the left. + 0: no −0.
            out[row][column] = static_cast<float>(m[row][column] + 0.0);
        }
    }
    return out;
}

std::vector<std::byte> encode(const FloatImage& image) {
    const auto width = static_cast<int>(image.width);
    const auto height = static_cast<int>(image.height);
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (image.world_to_camera) {
        Imf::addWorldToCamera(header, rowVectorMatrix(*image.world_to_camera));
    }
    if (image.world_to_ndc) {
        Imf::addWorldToNDC(header, rowVectorMatrix(*image.world_to_ndc));
    }
    for (const auto& [name, text] : image.attributes) {
        header.insert(name, Imf::StringAttribute(text));
    }
    Imf::FrameBuffer frame_buffer;
    for (const FloatImage::Channel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        // OpenEXR's interface takes non-const memory for reading and writing alike; it only reads here.
        auto* base = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
        frame_buffer.insert(channel.name,
                            Imf::Slice(Imf::FLOAT, base, sizeof(float), sizeof(float) * image.width));
    }
    MemoryStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame_buffer);
        file.writePixels(height);
    }
    return stream.take();
}

}  // namespace

Result<std::vector<std::byte>> encodeExr(const FloatImage& image) {
    try {
        return encode(image);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, "out of memory while encoding an EXR image; use fewer pixels");
    } catch (const std::exception& e) {
        return fail(ErrorCode::kFailure, std::string("cannot encode an EXR image: ") + e.what());
    }
}

}  // namespace relief
