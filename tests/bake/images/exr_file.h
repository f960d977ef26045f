// SPDX-License-Identifier: Apache-2.0
// Images written by Relief, read with the OpenEXR library.
#pragma once

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <string>
#include <vector>

#include "bake/images/exr.h"
#include "formats/base/file_io.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {

class ExrFile {
  public:
    explicit ExrFile(const ExrImage& image) : file_(writtenPath(folder_, image).c_str()) {
        const Imath::Box2i window = file_.header().dataWindow();
        width = static_cast<std::uint32_t>(window.max.x + 1);
        height = static_cast<std::uint32_t>(window.max.y + 1);
    }
    [[nodiscard]] const Imf::Header& header() const { return file_.header(); }
    [[nodiscard]] std::vector<float> channel(const char* name) {
        EXPECT_NE(header().channels().findChannel(name), nullptr) << name;
        std::vector<float> values(std::size_t{width} * height);
        Imf::FrameBuffer buffer;
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                       sizeof(float) * width));
        file_.setFrameBuffer(buffer);
        file_.readPixels(0, static_cast<int>(height) - 1);
        return values;
    }
    [[nodiscard]] std::string text(const char* name) const {
        return header().typedAttribute<Imf::StringAttribute>(name).value();
    }
    /// Pixel coordinates of a point from the upper left corner, and its distance from the camera plane.
    [[nodiscard]] glm::vec3 project(const glm::vec3& p) const {
        const Imath::V3f world(p.x, p.y, p.z);
        Imath::V3f ndc;
        Imf::worldToNDC(header()).multVecMatrix(world, ndc);
        Imath::V3f camera;
        Imf::worldToCamera(header()).multVecMatrix(world, camera);
        return {ndc.x * static_cast<float>(width), ndc.y * static_cast<float>(height), camera.z};
    }

    std::uint32_t width = 0;
    std::uint32_t height = 0;

  private:
    static std::string writtenPath(const TemporaryFolder& folder, const ExrImage& image) {
        const std::vector<std::byte> bytes = required(encodeExr(image));
        EXPECT_EQ(bytes, *encodeExr(image)) << "encoding is deterministic";
        const std::filesystem::path path = folder.path() / "image.exr";
        EXPECT_TRUE(writeFile(path, bytes));
        return path.string();
    }

    TemporaryFolder folder_;
    Imf::InputFile file_;
};

}  // namespace relief::test
