// SPDX-License-Identifier: Apache-2.0
// Settings of height maps, and valid and hostile image files.
#include "bake/height_map/height_map.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <png.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

#include "bake/images/exr.h"
#include "bake/import/image_rows.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

void expectError(const Error& error, const std::string& words, ErrorCode code) {
    EXPECT_EQ(error.code, code) << error.message;
    EXPECT_NE(error.message.find(words), std::string::npos) << error.message;
    EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
}

/// An EXR file with two images of 2x2 heights.
void writeParts(const fs::path& path) {
    std::vector<Imf::Header> headers(2, Imf::Header(2, 2));
    for (std::size_t i = 0; i < headers.size(); ++i) {
        headers[i].setName("part " + std::to_string(i));
        headers[i].setType(Imf::SCANLINEIMAGE);
        headers[i].channels().insert("Y", Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    std::array<float, 4> heights = {1.0F, 2.0F, 3.0F, 4.0F};
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(heights.data()), sizeof(float),
                                  2 * sizeof(float)));
    for (int i = 0; i < 2; ++i) {
        Imf::OutputPart part(file, i);
        part.setFrameBuffer(buffer);
        part.writePixels(2);
    }
}

class HeightMaps : public testing::Test {
  protected:
    fs::path write(const char* name, std::span<const std::byte> bytes) {
        EXPECT_TRUE(writeFile(folder_ / name, bytes));
        return folder_ / name;
    }
    fs::path writeRaw(const char* name, const std::vector<std::uint16_t>& samples) {
        return write(name, std::as_bytes(std::span(samples)));
    }
    fs::path writePng(const char* name, std::uint32_t format, std::uint32_t width, std::uint32_t height,
                      const std::vector<std::byte>& pixels) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = width;
        image.height = height;
        image.format = format;
        EXPECT_NE(png_image_write_to_file(&image, (folder_ / name).c_str(), 0, pixels.data(), 0, nullptr), 0);
        return folder_ / name;
    }

    /// Inserts a chunk of 16-bit numbers after the header of a PNG.
    static fs::path addChunk(const fs::path& png, const char* type, std::initializer_list<unsigned> numbers) {
        std::vector<unsigned char> chunk;
        const auto append = [&](std::uint32_t value, unsigned bytes) {
            for (unsigned i = bytes; i-- > 0;) {
                chunk.push_back(static_cast<unsigned char>(value >> 8U * i));
            }
        };
        append(static_cast<std::uint32_t>(2 * numbers.size()), 4);
        chunk.insert(chunk.end(), type, type + 4);
        for (const unsigned number : numbers) {
            append(number, 2);
        }
        append(static_cast<std::uint32_t>(::crc32(0, chunk.data() + 4, static_cast<uInt>(chunk.size() - 4))),
               4);
        constexpr std::ptrdiff_t kHeaderEnd = 33;
        std::vector<std::byte> bytes = *readFile(png);
        const auto added = std::as_bytes(std::span(chunk));
        bytes.insert(bytes.begin() + kHeaderEnd, added.begin(), added.end());
        EXPECT_TRUE(writeFile(png, bytes));
        return png;
    }

    template <class Rows>
    static Error errorOfRows(Rows& rows) {
        std::vector<float> row(rows.columns());
        for (std::uint64_t i = 0; i < rows.rows(); ++i) {
            if (const Result<void> read = rows.next(row); !read) {
                return read.error();
            }
        }
        return {ErrorCode::kFailure, "it was read"};
    }

    /// The error of opening a file or reading its rows.
    static Error errorOf(const fs::path& path, const char* settings) {
        Result<HeightMap> map = HeightMap::open(path, parseHeightsSpec(settings).value());
        return map ? errorOfRows(*map) : map.error();
    }

    static void rejects(const fs::path& path, const char* settings, const char* words,
                        ErrorCode code = ErrorCode::kInvalidInput) {
        expectError(errorOf(path, settings), words, code);
    }

    /// The error of decoding in this process.
    static Error decodeError(std::span<const std::byte> bytes) {
        Result<std::unique_ptr<SampleRows>> rows = openImageRows(bytes);
        return rows ? errorOfRows(**rows) : rows.error();
    }

    /// \param hole  replaces NaN
    static std::vector<float> heightsOf(const fs::path& path, const char* settings,
                                        float hole = std::numeric_limits<float>::quiet_NaN()) {
        HeightMap map = required(HeightMap::open(path, parseHeightsSpec(settings).value()));
        std::vector<float> all;
        std::vector<float> row(map.columns());
        for (std::uint32_t i = 0; i < map.rows(); ++i) {
            EXPECT_TRUE(map.next(row));
            std::ranges::transform(row, std::back_inserter(all),
                                   [&](float h) { return std::isnan(h) ? hole : h; });
        }
        return all;
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST(HeightsSettings, RoundTrip) {
    const HeightsSpec spec = required(
        parseHeightsSpec("spacing=0.25,low=-3,high=500.5,hole=0,width=2048,offset=-1/0/2.5,tile=512"));
    EXPECT_EQ(spec.offset.at, glm::dvec3(-1.0, 0.0, 2.5));
    EXPECT_EQ(toString(spec), "spacing=0.25,low=-3,high=500.5,hole=0,width=2048,offset=-1/0/2.5,tile=512");
    EXPECT_EQ(toString(*parseHeightsSpec("high=1,low=0")), "spacing=1,low=0,high=1");
    EXPECT_EQ(toString(*parseHeightsSpec(toString(spec))), toString(spec));
}

TEST(HeightsSettings, InvalidSettingsAreRejectedWithAFix) {
    for (const Wrong& wrong :
         {Wrong{"", "unknown key ''; use one of spacing, low"}, Wrong{"spacin=1", "did you mean 'spacing'?"},
          Wrong{"spacing", "spacing is '' but must be a length"},
          Wrong{"spacing=0", "a length from 0.000001"}, Wrong{"spacing=-1", "a length from"},
          Wrong{"spacing=nan", "is 'nan' but must be"}, Wrong{"spacing=inf", "is 'inf' but must be"},
          Wrong{"low=nan", "a number from -1e9 to 1e9"}, Wrong{"high=1e10", "a number from -1e9"},
          Wrong{"low=5,high=1", "low is 5 but must be below high, 1"},
          Wrong{"low=5,high=5", "must be below high"}, Wrong{"low=1,low=2", "low is given twice"},
          Wrong{"hole=x", "hole is 'x'"}, Wrong{"width=1", "width is '1'"},
          Wrong{"offset=1/2", "three numbers x/y/z"}, Wrong{"offset=1/2/inf", "three numbers"},
          Wrong{"tile=66", "a multiple of 4"}, Wrong{"tile=8", "tile is '8'"}}) {
        const Result<HeightsSpec> spec = parseHeightsSpec(wrong.text);
        ASSERT_FALSE(spec) << wrong.text;
        expectError(spec.error(), wrong.words, ErrorCode::kUsage);
        EXPECT_EQ(spec.error().message.find("--heights '"), 0U);
    }
}

TEST_F(HeightMaps, IntegerImagesSpanLowToHigh) {
    const std::array<std::uint16_t, 6> samples = {0, 65535, 13107, 1, 258, 40000};
    std::vector<std::byte> words(sizeof(samples));
    std::memcpy(words.data(), samples.data(), words.size());
    const fs::path png = writePng("a.png", PNG_FORMAT_LINEAR_Y, 3, 2, words);
    std::vector<float> wanted;
    for (const std::uint16_t sample : samples) {
        wanted.push_back(static_cast<float>(-10.0 + 100.0 / 65535.0 * sample));
    }
    EXPECT_EQ(heightsOf(png, "low=-10,high=90"), wanted);
    EXPECT_EQ(heightsOf(writeRaw("a.raw", {samples.begin(), samples.end()}), "low=-10,high=90,width=3"),
              wanted);
    const fs::path bytes =
        writePng("b.png", PNG_FORMAT_GRAY, 2, 2, {std::byte{0}, std::byte{255}, std::byte{51}, std::byte{7}});
    EXPECT_EQ(heightsOf(bytes, "low=0,high=5,hole=7", 9.0F), (std::vector<float>{0.0F, 5.0F, 1.0F, 9.0F}));
}

TEST_F(HeightMaps, FloatsAreMetresAndNanIsAHole) {
    ExrImage image;
    image.width = 3;
    image.height = 2;
    image.channels.push_back(
        {"Y", {1.5F, -20.0F, std::numeric_limits<float>::quiet_NaN(), 8848.0F, -9999.0F, 0.1F}});
    const fs::path path = write("a.exr", *encodeExr(image));
    EXPECT_EQ(heightsOf(path, "hole=-9999", 9.0F),
              (std::vector<float>{1.5F, -20.0F, 9.0F, 8848.0F, 9.0F, 0.1F}));
    rejects(path, "low=0,high=1", "a.exr': --heights low applies only to unsigned samples",
            ErrorCode::kUsage);
    image.channels.push_back({"Z", std::vector<float>(6, 0.0F)});
    rejects(write("b.exr", *encodeExr(image)), "spacing=1", "exactly one channel", ErrorCode::kUnsupported);
    writeParts(folder_ / "parts.exr");
    rejects(folder_ / "parts.exr", "spacing=1", "parts.exr': it has 2 parts; save only the heights",
            ErrorCode::kUnsupported);
    image.channels = {{"Y", std::vector<float>(6, std::numeric_limits<float>::infinity())}};
    rejects(write("c.exr", *encodeExr(image)), "spacing=1",
            "height of inf, beyond 1e9; if it stands for a hole, save it as NaN");
    image.channels = {{"Y", {1.0F, -std::numeric_limits<float>::max(), 2.0F, 3.0F, 4.0F, 5.0F}}};
    const fs::path lowest = write("d.exr", *encodeExr(image));
    const std::string message = errorOf(lowest, "spacing=1").message;
    const std::size_t cure = message.find("hole=");
    ASSERT_NE(cure, std::string::npos) << message;
    EXPECT_TRUE(std::isnan(heightsOf(lowest, message.substr(cure).c_str())[1]));
}

TEST_F(HeightMaps, RawSamplesAreSquareWithoutAWidth) {
    const fs::path square = writeRaw("a.r16", std::vector<std::uint16_t>(49, 7));
    EXPECT_EQ(heightsOf(square, "low=0,high=1").size(), 49U);
    const fs::path cut = writeRaw("b.raw", std::vector<std::uint16_t>(48, 7));
    rejects(cut, "low=0,high=1",
            "b.raw': it has 96 bytes, which do not form a square of samples of 16 bits; give --heights "
            "width=N or "
            "type=");
    rejects(cut, "low=0,high=1,width=7", "do not form rows of 7 samples");
    rejects(write("odd.raw", std::vector<std::byte>(99)), "low=0,high=1", "99 bytes");
    rejects(write("none.raw", {}), "low=0,high=1", "0 bytes");
    rejects(square, "low=0", "needs high=, the height of sample value 65535", ErrorCode::kUsage);
    rejects(square, "high=0", "needs low=, the height of sample value 0", ErrorCode::kUsage);
    rejects(square, "low=0,high=1,hole=0.5", "whole number from 0 to 65535", ErrorCode::kUsage);
    rejects(writeRaw("a.bin", {1, 2, 3, 4}), "low=0,high=1",
            "give --heights type= or width=", ErrorCode::kUnsupported);
    EXPECT_EQ(heightsOf(folder_ / "a.bin", "low=0,high=1,width=2").size(), 4U);
}

TEST_F(HeightMaps, RawSamplesHaveATypeAndAByteOrder) {
    const auto write = [&](const char* name, std::initializer_list<unsigned> values) {
        std::vector<std::byte> bytes;
        for (const unsigned value : values) {
            bytes.push_back(static_cast<std::byte>(value));
        }
        return HeightMaps::write(name, bytes);
    };
    const fs::path big = write("a.raw", {0x00, 0x07, 0xff, 0xf1, 0x80, 0x00, 0x01, 0x00});
    EXPECT_EQ(heightsOf(big, "type=int16,order=big"), (std::vector<float>{7.0F, -15.0F, -32768.0F, 256.0F}));
    EXPECT_EQ(heightsOf(big, "order=big,low=0,high=65535"),
              (std::vector<float>{7.0F, 65521.0F, 32768.0F, 256.0F}));
    EXPECT_EQ(heightsOf(big, "type=int16"), (std::vector<float>{1792.0F, -3585.0F, 128.0F, 1.0F}));
    const fs::path floats =
        write("f.bin", {0x3f, 0xc0, 0, 0, 0xc2, 0x28, 0, 0, 0, 0, 0, 0, 0x7f, 0xc0, 0, 0});
    EXPECT_EQ(heightsOf(floats, "type=float32,order=big", 9.0F),
              (std::vector<float>{1.5F, -42.0F, 0.0F, 9.0F}));
    rejects(floats, "type=float32,width=3",
            "do not form rows of 3 samples of 32 bits; give another width or type");
    rejects(big, "type=float32", "do not form a square of samples of 32 bits");
    rejects(big, "type=int16,low=0", "low applies only to unsigned samples, but these are heights",
            ErrorCode::kUsage);
    rejects(big, "type=int16,hole=40000", "whole number from -32768 to 32767", ErrorCode::kUsage);
    const fs::path png = writePng("p.png", PNG_FORMAT_GRAY, 2, 2, std::vector<std::byte>(4));
    rejects(png, "type=int16", "type applies only to raw samples", ErrorCode::kUsage);
    rejects(png, "low=0,high=1,order=big", "order applies only to raw samples", ErrorCode::kUsage);

    // SRTM defaults, with or without the width. Explicit settings override them.
    const fs::path hgt = write("N00E000.HGT", {0x00, 0x07, 0xff, 0xf1, 0x80, 0x00, 0x01, 0x00});
    for (const char* const settings : {"spacing=30", "spacing=30,width=2"}) {
        EXPECT_EQ(heightsOf(hgt, settings, 9.0F), (std::vector<float>{7.0F, -15.0F, 9.0F, 256.0F}));
    }
    EXPECT_EQ(heightsOf(hgt, "order=little,hole=1")[0], 1792.0F);
    // Images are recognised under any name.
    const fs::path image = writePng("image.hgt", PNG_FORMAT_GRAY, 2, 2, std::vector<std::byte>(4));
    EXPECT_EQ(heightsOf(image, "spacing=1,low=7,high=100"), std::vector<float>(4, 7.0F));
    rejects(image, "low=0,high=1,order=big", "order applies only to raw samples", ErrorCode::kUsage);
    EXPECT_EQ(toString(HeightMap::open(image, parseHeightsSpec("low=0,high=9").value())->spec()),
              "spacing=1,low=0,high=9");
    const HeightsSpec implied = HeightMap::open(hgt, parseHeightsSpec("spacing=30").value())->spec();
    EXPECT_EQ(toString(implied), "spacing=30,hole=-32768,type=int16,order=big");
}

/// 65² samples of ground about 40 m high, partly below sea level, written in every raw format and read as each.
TEST_F(HeightMaps, BetterRawFormatIsSuggested) {
    std::vector<double> ground;
    for (int i = 0; i < 65 * 65; ++i) {
        ground.push_back(
            std::round(3000.0 * std::sin(i % 65 / 9.0) + 2000.0 * std::cos(i / 65 / 5.0) + 1500.0));
    }
    const auto bytesOf = [&](const std::string& type, const std::string& order) {
        std::vector<std::byte> bytes;
        for (const double height : ground) {
            const auto number = static_cast<std::int16_t>(height);
            const auto metres = static_cast<float>(1.0001 * height);
            std::array<std::byte, 4> word{};
            const std::size_t size = type == "float32" ? 4 : 2;
            std::memcpy(word.data(), size == 4 ? static_cast<const void*>(&metres) : &number, size);
            if (order == "big") {
                std::reverse(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(size));
            }
            bytes.insert(bytes.end(), word.begin(), word.begin() + static_cast<std::ptrdiff_t>(size));
        }
        return bytes;
    };
    const auto found = [&](const std::vector<std::byte>& bytes, const std::string& type,
                           const std::string& order) {
        const std::string settings =
            "width=65,type=" + type + ",order=" + order + (type == "uint16" ? ",low=0,high=65535" : "");
        return toString(
            HeightMap::open(write("g.raw", bytes), parseHeightsSpec(settings).value())->betterFormat());
    };
    const std::array<std::string, 2> orders = {"little", "big"};
    for (const std::string& order : orders) {
        const std::string& other = orders[order == "little" ? 1 : 0];
        const std::vector<std::byte> shorts = bytesOf("int16", order);
        EXPECT_EQ(found(shorts, "int16", order), "");
        EXPECT_EQ(found(shorts, "int16", other), "order=" + order);
        EXPECT_EQ(found(shorts, "uint16", order), "type=int16");
        EXPECT_EQ(found(shorts, "uint16", other), "type=int16,order=" + order);
        const std::vector<std::byte> floats = bytesOf("float32", order);
        EXPECT_EQ(found(floats, "float32", order), "");
        EXPECT_EQ(found(floats, "float32", other), "order=" + order);
        EXPECT_EQ(found(floats, "uint16", order), "type=float32");
        EXPECT_EQ(found(floats, "int16", other), "type=float32,order=" + order);
    }
    // No suggestion: unsigned heights up to the maximum, walls of two levels, and expanded 8-bit values.
    const std::vector<double> hills = ground;
    for (double& height : ground) {
        height = std::clamp(6.0 * height + 33000.0, 0.0, 65535.0);
    }
    std::vector<std::uint16_t> samples(ground.begin(), ground.end());
    EXPECT_EQ(found({std::as_bytes(std::span(samples)).begin(), std::as_bytes(std::span(samples)).end()},
                    "uint16", "little"),
              "");
    // 8-bit values times 256 could also be in the other byte order.
    for (const auto& [step, format] : std::initializer_list<std::pair<unsigned, const char*>>{
             {65535U, ""}, {257U, ""}, {64U, ""}, {256U, "order=big"}}) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const bool wall = i % 7 == 0;
            const double levels = step == 64U ? 10.0 : 40.0;
            samples[i] = static_cast<std::uint16_t>(
                step == 65535U ? (wall ? step : 0U)
                               : step * static_cast<unsigned>((hills[i] + 3500.0) / levels));
        }
        const auto bytes = std::as_bytes(std::span(samples));
        EXPECT_EQ(found({bytes.begin(), bytes.end()}, "uint16", "little"), format) << step;
    }
    rejects(write("f.raw", bytesOf("float32", "big")), "type=float32",
            "beyond 1e9; give --heights order=big");
    // Two integers from 0 to 200 form a float below 1e-35.
    samples.clear();
    for (int i = 0; i < 66 * 64; ++i) {
        samples.push_back(static_cast<std::uint16_t>(
            std::lround(100.0 + 50.0 * std::sin(i % 66 / 9.0) + 50.0 * std::cos(i / 66 / 5.0))));
    }
    const auto small = std::as_bytes(std::span(samples));
    EXPECT_EQ(toString(HeightMap::open(write("g.raw", {small.begin(), small.end()}),
                                       parseHeightsSpec("width=66,type=float32").value())
                           ->betterFormat()),
              "type=uint16");
}

/// The wrong byte order scales heights below 256 m by 256. The wrong signedness makes pillars of 65 km.
TEST_F(HeightMaps, BetterFormatOfLowlandIsSuggested) {
    const auto found = [&](double low, double high, const std::string& settings, int lone = 0) {
        std::vector<std::uint16_t> samples;
        for (int i = 0; i < 65 * 65; ++i) {
            const double wave = 0.5 + 0.25 * std::sin(i % 65 / 9.0) + 0.25 * std::cos(i / 65 / 5.0);
            samples.push_back(static_cast<std::uint16_t>(std::lround(low + (high - low) * wave)));
        }
        if (lone != 0) {
            samples[16 * 65 + 42] = static_cast<std::uint16_t>(lone);  // in a valley
        }
        const auto bytes = std::as_bytes(std::span(samples));
        std::vector<std::byte> big(bytes.begin(), bytes.end());
        for (std::size_t i = 0; i < big.size(); i += 2) {
            std::swap(big[i], big[i + 1]);
        }
        const bool swap = settings.find("written=big") == 0;
        return toString(HeightMap::open(write("g.raw", swap ? big : std::vector(bytes.begin(), bytes.end())),
                                        parseHeightsSpec(settings.substr(swap ? 12 : 0)).value())
                            ->betterFormat());
    };
    const std::string uint16 = "low=0,high=65535";
    for (const auto& [low, high] : {std::pair(0, 5), {0, 100}, {0, 255}, {0, 300}, {1030, 1200}}) {
        SCOPED_TRACE(high);
        EXPECT_EQ(found(low, high, uint16), "");
        EXPECT_EQ(found(low, high, "type=int16"), "");
        EXPECT_EQ(found(low, high, "written=big," + uint16), "order=big");
        EXPECT_EQ(found(low, high, "written=big,type=int16"), "order=big");
        EXPECT_EQ(found(low, high, "written=big,type=int16,order=big"), "");
    }
    for (const int most : {2, 3, 4, 8, 100, 10000}) {
        SCOPED_TRACE(most);
        EXPECT_EQ(found(-most, most, "type=int16"), "");
        EXPECT_EQ(found(-most, most, uint16), "type=int16");
        EXPECT_EQ(found(-most, most, "written=big," + uint16), "type=int16,order=big");
        EXPECT_EQ(found(-most, most, "written=big,type=int16"), "order=big");
    }
    // A former fault: an undeclared hole of -32768 hid the other settings.
    constexpr int kHole = -32768;
    for (const auto& [low, high] : {std::pair(0, 3), {0, 5}, {0, 100}, {0, 255}, {0, 300}, {30, 2000}}) {
        SCOPED_TRACE(high);
        EXPECT_EQ(found(low, high, uint16, kHole), "");
        EXPECT_EQ(found(low, high, "type=int16", kHole), "");
        EXPECT_EQ(found(low, high, "written=big,type=int16,order=big", kHole), "");
        EXPECT_EQ(found(low, high, "written=big," + uint16, kHole), "order=big");
        EXPECT_EQ(found(low, high, "written=big,type=int16", kHole), "order=big");
        EXPECT_EQ(found(low, high, "type=int16,order=big", kHole), "order=little");
    }
    for (const int most : {2, 3, 8, 100, 10000}) {
        SCOPED_TRACE(most);
        EXPECT_EQ(found(-most, most, "type=int16", kHole), "");
        EXPECT_EQ(found(-most, most, uint16, kHole), "type=int16");
        EXPECT_EQ(found(-most, most, "written=big," + uint16, kHole), "type=int16,order=big");
        EXPECT_EQ(found(-most, most, "written=big,type=int16", kHole), "order=big");
    }
    EXPECT_EQ(found(0, 5, uint16, -1), "type=int16");
    EXPECT_EQ(found(0, 5, uint16 + ",hole=65535", -1), "");
    EXPECT_EQ(found(300, 500, uint16 + ",hole=65535", -1), "");
    EXPECT_NE(found(300, 500, uint16, -1), "type=int16");
    EXPECT_EQ(found(32000, 33500, uint16), "");
    EXPECT_EQ(found(32000, 33500, "type=int16"), "type=uint16");
}

TEST_F(HeightMaps, OutlierSampleIsReported) {
    const auto lone = [](std::initializer_list<float> samples) {
        SampleRange range;
        for (const float sample : samples) {
            range.add(sample);
        }
        const std::optional<OutlierSample> found = range.outliers();
        return found
                   ? std::string(found->lowest ? "low " : "high ") + std::to_string(std::lround(found->gap)) +
                         (found->sample == found->last ? "" : " of several")
                   : "";
    };
    EXPECT_EQ(lone({3.0F, -9999.0F, 5.0F, -9999.0F, 4.0F}), "low 10002");
    EXPECT_EQ(lone({-400.0F, 8848.0F, 100.0F, -9999.0F}), "low 9599");
    EXPECT_EQ(lone({65535.0F, 100.0F, 30000.0F, 65535.0F}), "high 35535");
    EXPECT_EQ(lone({7.0F, -9999.0F, 8.0F, -9998.5F, 4.0F, 5.0F}), "low 10003 of several");
    EXPECT_EQ(lone({7.0F, 65534.0F, 8.0F, 65535.0F, 4.0F, 5.0F, 65533.0F, 6.0F}), "high 65525 of several");
    EXPECT_EQ(lone({100.0F, 101.0F, 5000.0F, 5001.0F}), "");
    EXPECT_EQ(lone({0.0F, 65535.0F}), "");
    EXPECT_EQ(lone({7.0F, 7.0F}), "");
    EXPECT_EQ(lone({}), "");
    EXPECT_EQ(lone({1.0F, 2.0F, 3.0F}), "");
}

TEST_F(HeightMaps, GreyCanBeSavedAsOpaqueColor) {
    const auto png = [&](std::uint32_t format, std::initializer_list<unsigned char> values) {
        const std::span<const unsigned char> all(values.begin(), values.size());
        return writePng("c.png", format, 2, 2, {std::as_bytes(all).begin(), std::as_bytes(all).end()});
    };
    const std::vector<float> heights{1.0F, 2.0F, 3.0F, 250.0F};
    const char* const whole = "low=0,high=255";
    EXPECT_EQ(heightsOf(png(PNG_FORMAT_RGB, {1, 1, 1, 2, 2, 2, 3, 3, 3, 250, 250, 250}), whole), heights);
    EXPECT_EQ(heightsOf(png(PNG_FORMAT_GA, {1, 255, 2, 255, 3, 255, 250, 255}), whole), heights);
    EXPECT_EQ(heightsOf(png(PNG_FORMAT_RGBA, {1, 1, 1, 255, 2, 2, 2, 255, 3, 3, 3, 255, 250, 250, 250, 255}),
                        whole),
              heights);
    rejects(png(PNG_FORMAT_RGB, {1, 1, 1, 2, 2, 2, 3, 3, 3, 250, 251, 250}), whole,
            "c.png': it is in colour at column 1 of row 1; save it as 16-bit grey", ErrorCode::kUnsupported);
    rejects(png(PNG_FORMAT_RGB, {1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 4}), whole,
            "in colour at column 0 of row 0", ErrorCode::kUnsupported);
    rejects(png(PNG_FORMAT_GA, {1, 255, 2, 254, 3, 255, 250, 255}), whole,
            "it is transparent at column 1 of row 0; save it", ErrorCode::kUnsupported);
}

TEST_F(HeightMaps, TransparentPngColorsAreHoles) {
    const std::array<std::uint16_t, 4> samples = {0, 300, 44, 65535};
    std::vector<std::byte> words(sizeof(samples));
    std::memcpy(words.data(), samples.data(), words.size());
    const auto holesOf = [](const fs::path& png, const char* settings) {
        std::string holes;
        for (const float height : heightsOf(png, settings)) {
            holes += std::isnan(height) ? 'o' : '.';
        }
        return holes;
    };
    const auto grey16 = [&] { return writePng("g.png", PNG_FORMAT_LINEAR_Y, 2, 2, words); };
    EXPECT_EQ(holesOf(addChunk(grey16(), "tRNS", {300}), "low=0,high=65535"), ".o..");
    EXPECT_EQ(holesOf(addChunk(grey16(), "tRNS", {0}), "low=0,high=65535,hole=44"), "o.o.");
    EXPECT_EQ(holesOf(grey16(), "low=0,high=65535"), "....");
    const std::vector<std::byte> bytes = {std::byte{0}, std::byte{44}, std::byte{7}, std::byte{255}};
    const auto grey8 = [&] { return writePng("b.png", PNG_FORMAT_GRAY, 2, 2, bytes); };
    EXPECT_EQ(holesOf(addChunk(grey8(), "tRNS", {44}), "low=0,high=255"), ".o..");
    EXPECT_EQ(holesOf(addChunk(grey8(), "tRNS", {300}), "low=0,high=255"), ".o..")
        << "only the low byte is compared";
    const auto rgb = [&] {
        std::vector<std::byte> pixels;
        for (const std::byte value : bytes) {
            pixels.insert(pixels.end(), 3, value);
        }
        return writePng("c.png", PNG_FORMAT_RGB, 2, 2, pixels);
    };
    EXPECT_EQ(holesOf(addChunk(rgb(), "tRNS", {7, 7, 7}), "low=0,high=255"), "..o.");
    EXPECT_EQ(holesOf(addChunk(rgb(), "tRNS", {7, 7, 0}), "low=0,high=255"), "....");
}

TEST_F(HeightMaps, WrongSizesAndFormatsAreRejected) {
    const std::vector<std::byte> pixels(64);
    rejects(writePng("one.png", PNG_FORMAT_GRAY, 1, 1, pixels), "low=0,high=1",
            "one.png': it has 1x1 samples; a height map has at least 2x2");
    rejects(writePng("thin.png", PNG_FORMAT_GRAY, 1, 9, pixels), "low=0,high=1", "1x9");
    rejects(folder_ / "none.png", "low=0,high=1", "none.png", ErrorCode::kIo);
    const fs::path fine = writePng("fine.png", PNG_FORMAT_GRAY, 8, 8, pixels);
    rejects(fine, "low=0,high=1,width=8", "width applies only to raw samples", ErrorCode::kUsage);
    rejects(fine, "low=0,high=1,hole=256", "from 0 to 255", ErrorCode::kUsage);
}

/// The first word after `name` in /proc/PID/status.
std::string statusOf(const std::string& pid, const std::string& name) {
    std::ifstream file("/proc/" + pid + "/status");
    std::string word;
    while (file >> word && word != name) {
    }
    file >> word;
    return word;
}

TEST_F(HeightMaps, ImagesAreDecodedInASandbox) {
    const auto children = [] {
        std::string list;
        std::ifstream("/proc/self/task/" + std::to_string(::getpid()) + "/children") >> list;
        return list;
    };
    constexpr std::uint32_t kSide = 1024;  // more rows than a pipe buffers
    std::vector<std::byte> pixels(2 * kSide * kSide);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::byte>(i >> 11U);
    }
    const fs::path png = writePng("a.png", PNG_FORMAT_LINEAR_Y, kSide, kSide, pixels);
    {
        HeightMap map = required(HeightMap::open(png, parseHeightsSpec("low=0,high=65535").value()));
        for (int times = 0; times < 2; ++times) {
            const std::string worker = children();
            ASSERT_NE(worker, "");
            EXPECT_EQ(statusOf(worker, "Seccomp:"), "2");
            EXPECT_EQ(statusOf(worker, "NoNewPrivs:"), "1");
            std::vector<float> row(kSide);
            for (std::uint32_t i = 0; i < kSide; ++i) {
                ASSERT_TRUE(map.next(row));
                std::uint16_t wanted = 0;
                std::memcpy(&wanted, &pixels[2 * (std::size_t{i} * kSide + i)], 2);
                ASSERT_EQ(row[i], static_cast<float>(wanted));
            }
            ASSERT_TRUE(map.rewind());
        }
    }
    EXPECT_EQ(children(), "");
    ImportLimits limits{.seconds = 0};
    const Result<HeightMap> none = HeightMap::open(png, parseHeightsSpec("low=0,high=1").value(), limits);
    ASSERT_FALSE(none);
    expectError(none.error(), "a.png': the importer's limits must be", ErrorCode::kUsage);
}

/// Damaged files, and one that claims 10⁹ samples.
TEST_F(HeightMaps, DamagedImagesAreRejectedInOneLine) {
    std::vector<std::byte> pixels(2 * 40 * 40);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::byte>(i * i >> 3U);
    }
    const std::vector<std::byte> png = *readFile(writePng("a.png", PNG_FORMAT_LINEAR_Y, 40, 40, pixels));
    ExrImage image;
    image.width = 20;
    image.height = 20;
    image.channels.push_back({"Y", std::vector<float>(400, 2.5F)});
    image.channels[0].values[77] = 3.0F;
    const std::vector<std::byte> exr = *encodeExr(image);
    for (const std::vector<std::byte>& whole : {png, exr}) {
        for (std::size_t size = 8; size + 12 < whole.size(); size += 1 + whole.size() / 60) {
            const Error error = decodeError(std::span(whole).first(size));
            EXPECT_EQ(error.code, ErrorCode::kInvalidInput) << size << " " << error.message;
            EXPECT_EQ(error.message.find('\n'), std::string::npos);
        }
        for (std::size_t at = 4; at < whole.size(); at += 1 + whole.size() / 300) {
            std::vector<std::byte> changed = whole;
            changed[at] ^= std::byte{0x55};
            const Error error = decodeError(changed);
            EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
        }
    }
    rejects(write("cut.png", std::span(png).first(png.size() / 2)), "low=0,high=1",
            "cut.png': it cannot be read as PNG");
    std::vector<std::byte> large = png;
    for (const std::size_t at : {16U, 20U}) {  // 32768² in IHDR
        large[at] = large[at + 1] = large[at + 3] = std::byte{0};
        large[at + 2] = std::byte{0x80};
    }
    const auto crc = ::crc32(0, reinterpret_cast<const Bytef*>(large.data()) + 12, 17);
    for (std::size_t i = 0; i < 4; ++i) {
        large[29 + i] = static_cast<std::byte>(crc >> (24U - 8U * i) & 0xffU);
    }
    rejects(write("large.png", large), "low=0,high=1",
            "large.png': it has 32768x32768 samples, more than the limit of 268435456; split it",
            ErrorCode::kLimit);
}

}  // namespace
}  // namespace relief::test
