// SPDX-License-Identifier: Apache-2.0
// Point lists: both file types, every encoding, and invalid files.
#include "runtime/births/point_list.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/results.h"

namespace relief {
namespace {

Result<PointList> parse(const std::string& text) {
    return parsePointList(std::as_bytes(std::span(text)), "p");
}

void expectError(const std::string& text, const std::string& start,
                 ErrorCode code = ErrorCode::kInvalidInput) {
    const auto list = parse(text);
    ASSERT_FALSE(list) << text.substr(0, 200);
    EXPECT_EQ(list.error().code, code);
    EXPECT_TRUE(list.error().message.starts_with(start)) << list.error().message;
    EXPECT_EQ(list.error().message.find('\n'), std::string::npos);
}

TEST(PointList, CsvWithAndWithoutNormals) {
    const auto plain = required(parse("x,y,z\r\n# a comment\n\n 1 , -2.5,\t3e1\r\n+4,5,6"));
    ASSERT_EQ(plain.positions.size(), 2U);
    EXPECT_EQ(plain.positions[0], glm::vec3(1.0F, -2.5F, 30.0F));
    EXPECT_EQ(plain.positions[1], glm::vec3(4.0F, 5.0F, 6.0F));
    EXPECT_TRUE(plain.normals.empty());
    const auto normals = parse("1,2,3,0,0,-8\n4,5,6,3,0,4\n");
    ASSERT_TRUE(normals);
    EXPECT_EQ(normals->normals[0], glm::vec3(0.0F, 0.0F, -1.0F));
    EXPECT_NEAR(normals->normals[1].x, 0.6F, 1e-7F);
}

TEST(PointList, CsvErrorsNameTheLine) {
    expectError("x,y,z\nu,v,w\n1,2,3\n", "p:2: not a point; write x,y,z");
    expectError("1,2,3\nx,y,z\n", "p:2: not a point of 3 numbers");
    expectError("1,2\n3,4,5\n", "p:1: ");  // numbers, so no header line
    expectError("\n1,2,3\n1,2,3,0,1,0\n", "p:3: ");
    for (const char* line : {"1,2,3,", "1,,3", "1,2,3x", "1,2,nan", "1,2,inf", "1,2,1.1e9"}) {
        expectError("1,2,3\n" + std::string(line) + "\n", "p:2: ");
    }
    expectError("1,2,3\n" + std::string(100'000, ','), "p:2: ");
    expectError("1,2,3,0,0,0\n", "p:1: a normal has no direction");
    expectError("1,2,3,0,0,inf\n", "p:1: a normal has no direction");
    expectError("", "p: contains no points");
    expectError("x,y,z\n", "p: contains no points");
    EXPECT_TRUE(parse("1,2,1e9\n"));
}

std::string header(const std::string& format, const std::string& count, const std::string& properties) {
    return "ply\nformat " + format + " 1.0\ncomment x\nelement vertex " + count + "\n" + properties +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

TEST(PointList, AsciiPly) {
    const auto list =
        required(parse(header("ascii", "2",
                              "property uchar red\nproperty double z\nproperty float y\nproperty int x\n"
                              "property float nx\nproperty float ny\nproperty float nz\n") +
                       "255 3.5 2 1 0 2 0\n\n0 6 5 4 -1 0 0\n3 0 1 2\n"));
    ASSERT_EQ(list.positions.size(), 2U);
    EXPECT_EQ(list.positions[0], glm::vec3(1.0F, 2.0F, 3.5F));
    EXPECT_EQ(list.positions[1], glm::vec3(4.0F, 5.0F, 6.0F));
    EXPECT_EQ(list.normals[0], glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_EQ(list.normals[1], glm::vec3(-1.0F, 0.0F, 0.0F));
}

template <class T>
void append(std::string& out, T value, bool big) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    const bool turn = big != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        out.push_back(bytes[turn ? sizeof(T) - 1 - i : i]);
    }
}

TEST(PointList, BinaryPlyOfEveryTypeAndByteOrder) {
    for (const bool big : {false, true}) {
        std::string text = header(big ? "binary_big_endian" : "binary_little_endian", "2",
                                  "property char a\nproperty uchar b\nproperty short x\nproperty ushort y\n"
                                  "property int c\nproperty uint z\nproperty float nx\nproperty double ny\n"
                                  "property int8 nz\n");
        for (int i = 0; i < 2; ++i) {
            append(text, std::int8_t{-1}, big);
            append(text, std::uint8_t{255}, big);
            append(text, static_cast<std::int16_t>(-300 - i), big);
            append(text, std::uint16_t{65535}, big);
            append(text, std::int32_t{-7}, big);
            append(text, std::uint32_t{100'000'000}, big);
            append(text, 0.0F, big);
            append(text, 0.0, big);
            append(text, std::int8_t{-3}, big);
        }
        const auto list = required(parse(text));
        EXPECT_EQ(list.positions[1], glm::vec3(-301.0F, 65535.0F, 1e8F));
        EXPECT_EQ(list.normals[0], glm::vec3(0.0F, 0.0F, -1.0F));
        text.pop_back();
        expectError(text, "p: vertex 1: it ends before the counts");
    }
}

TEST(PointList, RejectsInvalidPly) {
    expectError("ply\n", "p: its header does not end");
    expectError("ply\n" + std::string(1'000'000, '\n'), "p: its header does not end");
    expectError("ply\nformat ebcdic 1.0\nend_header\n", "p: its header does not name a supported format");
    expectError("ply\nelement vertex 1\n" + kXyz + "end_header\n0 0 0\n", "p: ");
    expectError("ply\nformat ascii 1.0\nelement face 2\nelement vertex 1\nend_header\n",
                "p: vertices must be the first element");
    std::string many = kXyz;
    for (int i = 0; i < 300; ++i) {
        many += "property uchar p\n";
    }
    const auto ascii = [](const std::string& count, const std::string& properties, const std::string& body) {
        return header("ascii", count, properties) + body;
    };
    EXPECT_TRUE(parse(ascii("1", kXyz + "property list uchar int l\n", "0 0 0 2 7 8\n")));
    expectError(ascii("1", many, ""), "p: ");
    expectError(ascii("1", "property float x\nproperty float y\n", "0 0\n"), "p: the vertices of a PLY");
    expectError(ascii("1", kXyz + "property float x\n", "0 0 0 0\n"), "p: the vertices of a PLY");
    expectError(ascii("1", kXyz + "property real w\n", "0 0 0 0\n"), "p: ");
    expectError(ascii("-1", kXyz, ""), "p: an element of its header");
    expectError(ascii("99999999999999999999999", kXyz, ""), "p: 18446744073709551615 points",
                ErrorCode::kLimit);
    expectError(ascii("4194305", kXyz, ""), "p: 4194305 points", ErrorCode::kLimit);
    expectError(ascii("0", kXyz, ""), "p: contains no points");
    expectError(ascii("2", kXyz, "0 0 0\n0 0\n"), "p: vertex 1: line 12: it ends before the counts");
    expectError(ascii("2", kXyz, "0 0 0\n"), "p: vertex 1: ");
    expectError(ascii("2", kXyz, "0 0 0 0\n0 0 0\n"), "p: vertex 0: line 11: more numbers");
    expectError(ascii("2", kXyz, "0 0\n0 0 0\n0\n"), "p: vertex 0: line 12: more numbers");
    expectError(header("binary_little_endian", "4194304", kXyz), "p: vertex 0: it ends before the counts");
}

TEST(PointList, SurvivesPrefixesAndFlippedBytes) {
    std::string binary = header("binary_little_endian", "2", kXyz);
    for (int i = 0; i < 6; ++i) {
        append(binary, static_cast<float>(i), false);
    }
    for (const std::string& text :
         {binary, header("ascii", "2", kXyz) + "0 1 2\n3 4 5\n", std::string("x,y,z\n1,2,3\n4,5,6\n")}) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            const auto cut = parse(text.substr(0, i));
            EXPECT_TRUE(cut || !cut.error().message.empty());
            for (const unsigned flip : {1U, 0x10U, 0x80U, 0xffU}) {
                std::string changed = text;
                changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
                const auto list = parse(changed);
                EXPECT_TRUE(list || !list.error().message.empty());
            }
        }
    }
}

TEST(PointList, ManyPointsHitTheLimit) {
    std::string text;
    for (std::size_t i = 0; i <= kPointsMax; ++i) {
        text += "1,2,3\n";
    }
    expectError(text, "p:4194305: more than 4194304 points", ErrorCode::kLimit);
}

TEST(PointList, Files) {
    const std::string path = testing::TempDir() + "relief_point_list.csv";
    std::ofstream(path) << "1,2,3\n";
    EXPECT_TRUE(loadPointList(path));
    std::ofstream(path) << "1;2;3\n4;5;6\n";
    const auto wrong = loadPointList(path);
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("relief_point_list.csv':2: "), std::string::npos)
        << wrong.error().message;
    std::filesystem::remove(path);
    EXPECT_EQ(loadPointList(path).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace relief
