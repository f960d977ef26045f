// SPDX-License-Identifier: Apache-2.0
// The file of error curves that determine the shares of a level.
#include "bake/world/error_curves.h"

#include <gtest/gtest.h>

#include "formats/base/file_io.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

const ErrorCurves kCurves = {{"a", {{1024.0, 0.1}, {3000.0, 1e-17}}}, {"b", {{4096.0, 0.0}}}};

TEST(ErrorCurves, RoundTrip) {
    const TemporaryFolder folder;
    EXPECT_TRUE(loadErrorCurves(folder.path())->empty());
    ASSERT_TRUE(saveErrorCurves(folder.path(), kCurves));
    EXPECT_TRUE(*loadErrorCurves(folder.path()) == kCurves);
}

TEST(ErrorCurves, InvalidFilesAreRejected) {
    const auto text = [](const char* curve) {
        return std::string(R"({"format":"relief-curves","version":1,"curves":{"a":)") + curve + "}}";
    };
    EXPECT_TRUE(parseErrorCurves(text("[1024,2,2048,1]")));
    for (const char* curve : {"[]", "[1024]", "[0,2]", "[1024,-2]", "[1024,2,1024,1]", "[1024,2,2048,2]",
                              "[\"1024\",2]", "[1e999,2]", "{}"}) {
        EXPECT_FALSE(parseErrorCurves(text(curve))) << curve;
    }
    for (const char* other : {"{", "[]", R"({"format":"relief-curves","version":2,"curves":{}})",
                              R"({"format":"relief-cache","version":1,"curves":{}})",
                              R"({"format":"relief-curves","version":1,"curves":[]})"}) {
        EXPECT_FALSE(parseErrorCurves(other)) << other;
    }
}

TEST(ErrorCurves, LinksAreNotFollowed) {
    const TemporaryFolder folder;
    const fs::path elsewhere = folder.write("elsewhere.json", errorCurvesText(kCurves));
    fs::create_directory(folder.path() / "w");
    fs::create_symlink(elsewhere, folder.path() / "w" / kErrorCurvesName);
    EXPECT_FALSE(loadErrorCurves(folder.path() / "w"));
    ASSERT_TRUE(saveErrorCurves(folder.path() / "w", {}));
    EXPECT_TRUE(loadErrorCurves(folder.path() / "w")->empty());
    const auto kept = readFile(elsewhere);
    EXPECT_EQ(kept->size(), errorCurvesText(kCurves).size());
}

}  // namespace
}  // namespace relief::test
