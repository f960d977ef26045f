// SPDX-License-Identifier: Apache-2.0
#include "bake/images/exr.h"

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <exception>
#include <glm/matrix.hpp>

namespace relief {
namespace {

Imath::M44f rowVectorMatrix(const glm::dmat4& m) {
    Imath::M44f out;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            // glm's m[column] is a column; OpenEXR multiplies row vectors from the left. + 0 avoids −0.
            out[row][column] = static_cast<float>(m[row][column] + 0.0);
        }
    }
    return out;
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
    for (const ExrImage::Channel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        // OpenEXR requires non-const memory; writing a file only reads it.
        auto* base = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
        frame_buffer.insert(channel.name,
                            Imf::Slice(Imf::FLOAT, base, sizeof(float), sizeof(float) * image.width));
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

void ExrImage::setOrthographicCamera(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z,
                                     const glm::dvec3& scale) {
    const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
    world_to_camera =
        glm::transpose(glm::dmat4(scale.x * (x - 0.5 * one), scale.y * (y - 0.5 * one), scale.z * z, one));
    world_to_ndc = glm::transpose(glm::dmat4(x, one - y, z, one));
}

Result<std::vector<std::byte>> encodeExr(const ExrImage& image) {
    try {
        return encode(image);
    } catch (const std::bad_alloc&) {
        return fail(
            ErrorCode::kLimit,
            "out of memory while encoding an EXR image; lower --size or --resolution, or bake smaller maps");
    } catch (const std::exception& e) {
        return fail(ErrorCode::kFailure, std::string("cannot encode an EXR image: ") + e.what());
    }
}

}  // namespace relief
