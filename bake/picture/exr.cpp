// SPDX-License-Identifier: Apache-2.0
#include "bake/picture/exr.h"

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <exception>
#include <type_traits>

namespace relief {
namespace {

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

/// Adds a channel. OpenEXR's interface takes non-const memory for reading and writing alike; it only reads here.
template <class Value>
void insert(const ExrImage& image, const ExrImage::ChannelOf<Value>& channel, Imf::Header& header,
            Imf::FrameBuffer& frame_buffer) {
    const Imf::PixelType type = std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT;
    header.channels().insert(channel.name, Imf::Channel(type));
    auto* base = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
    frame_buffer.insert(channel.name, Imf::Slice(type, base, sizeof(Value), sizeof(Value) * image.width));
}

std::vector<std::byte> encode(const ExrImage& image) {
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
    for (const auto& channel : image.channels) {
        insert(image, channel, header, frame_buffer);
    }
    for (const auto& channel : image.words) {
        insert(image, channel, header, frame_buffer);
    }
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame_buffer);
        file.writePixels(height);
    }
    const std::string file = stream.str();
    const auto* first = reinterpret_cast<const std::byte*>(file.data());
    return {first, first + file.size()};
}

}  // namespace

Result<std::vector<std::byte>> encodeExr(const ExrImage& image) {
    try {
        return encode(image);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::kLimit, "out of memory while encoding an EXR image; use fewer pixels");
    } catch (const std::exception& e) {
        return fail(ErrorCode::kFailure, std::string("cannot encode an EXR image: ") + e.what());
    }
}

}  // namespace relief
