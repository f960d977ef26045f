// SPDX-License-Identifier: Apache-2.0
#include "bake/report/points_csv.h"

#include <gtest/gtest.h>

#include "tests/results.h"

namespace relief {
namespace {

TEST(PointsCsv, ReadsCommonVariants) {
    const std::vector<glm::vec3> points = required(parsePoints(
        "\xef\xbb\xbf# a comment\r\nx,y,z\r\n1,2,3\r\n\n  -1.5 ,\t+2e-3, .5 \n# more\n0,0,-0", "in.csv"));
    ASSERT_EQ(points.size(), 3U);
    EXPECT_EQ(points[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(points[1], glm::vec3(-1.5F, 2e-3F, 0.5F));
    EXPECT_TRUE(parsePoints("", "in.csv")->empty());
    EXPECT_TRUE(parsePoints("x,y,z\n", "in.csv")->empty());
}

TEST(PointsCsv, ErrorsNameTheLine) {
    struct Case {
        const char* text;
        const char* where;
    };
    const Case cases[] = {
        {"1,2,3\n1,2\n", "in.csv:2"},   {"1,2,3,4\n", "in.csv:1"},      {"1,2,nan\n", "in.csv:1"},
        {"nan,nan,nan\n", "in.csv:1"},  {"inf,0,0\n", "in.csv:1"},      {"1e99,0,0\n", "in.csv:1"},
        {"# c\n\n1;2;3\n", "in.csv:3"}, {"1,2,3\nx,y,z\n", "in.csv:2"}, {"x,y,z\na,b,c\n", "in.csv:2"},
        {"1,,3\n", "in.csv:1"},         {"a,b\n", "in.csv:1"},          {"0x1,0,0\n", "in.csv:1"}};
    for (const Case& c : cases) {
        const Result<std::vector<glm::vec3>> points = parsePoints(c.text, "in.csv");
        ASSERT_FALSE(points) << c.text;
        EXPECT_EQ(points.error().code, ErrorCode::kInvalidInput);
        EXPECT_EQ(points.error().message.find(std::string(c.where) + ":"), 0U) << points.error().message;
    }
}

TEST(PointsCsv, WritesExactValuesAndMarksUnknowns) {
    const std::vector<glm::vec3> points = {{0.1F, -2, 3}, {1e20F, 0, 0}, {7, 8, 9}};
    const std::vector<FieldSample> samples = {{-0.25F, {0, 1, 0}, 2}, {kFarOutside, glm::vec3(0), 0}, {}};
    EXPECT_EQ(formatSamples(points, samples),
              "x,y,z,f,nx,ny,nz,map\n0.1,-2,3,-0.25,0,1,0,2\n1e+20,0,0,inf,0,0,0,0\n7,8,9,,,,,\n");
}

}  // namespace
}  // namespace relief
