// What a container says of its bake, read by a check: as bake writes it, and as nobody should.
#include "bake/cli/recorded_bake.h"

#include <gtest/gtest.h>

#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

TEST(RecordedBake, ReadsWhatBakeWrites) {
    const RecordedBake bake = recordedBake(
        "--map front-back:dir=+z,size=95x90,depth=unorm16,decode=plane,box=tight "
        "--map cube:size=6,compare=less,decode=plane,box=0/0/0/1/1/1 --quality best --prefer inside "
        "--budget 60000 --holes keep --unit mm --up +z --repair wrap=0.02 --as shell --thickness 0.25");
    EXPECT_TRUE(bake.understood);
    ASSERT_EQ(bake.maps.size(), 2U);
    EXPECT_EQ(bake.maps[0].width, 95U);
    EXPECT_EQ(bake.maps[1].format, MapFormat::kCube8);
    EXPECT_EQ(bake.quality, Quality::kBest);
    EXPECT_EQ(bake.prefer, Prefer::kInside);
    EXPECT_TRUE(bake.keeps_holes);
    EXPECT_EQ(bake.repair, "wrap=0.02");
    EXPECT_EQ(bake.shape.as, ShapeAs::kShell);
    EXPECT_EQ(bake.shape.thickness, 0.25);
    EXPECT_EQ(
        bake.words("--holes"),
        " --quality best --prefer inside --unit mm --up +z --repair wrap=0.02 --as shell --thickness 0.25");
    EXPECT_EQ(recordedBake("--map cube:size=6 --quality normal").words(), "");
}

TEST(RecordedBake, TakesNothingThatMeansSomethingToAShell) {
    for (const char* options : {"--unit $(reboot)", "--prefer ;reboot", "`reboot` x", "--unit mm;reboot",
                                "--up '+z", "--map cube:size=6|reboot", "--unit \"mm\"", "x > file",
                                "--unit a\tb\\", "--unit ~/x", "--unit \xff"}) {
        const RecordedBake bake = recordedBake(options);
        EXPECT_EQ(bake.words().find_first_of(";|&$`'\"\\<>()*?~\t\n\xff"), std::string::npos) << bake.words();
        EXPECT_TRUE(bake.maps.empty());
    }
    EXPECT_FALSE(recordedBake("--from the=future").understood);
    EXPECT_FALSE(recordedBake("--map cube:size=many").understood);
    EXPECT_FALSE(recordedBake("--repair magic").understood);
    EXPECT_FALSE(recordedBake("--as wall").understood);
    EXPECT_FALSE(recordedBake("--thickness -1").understood);
    EXPECT_FALSE(recordedBake("--quality").understood);
    EXPECT_TRUE(recordedBake("").understood);
}

TEST(RecordedBake, NamesAreWordsOfTheAdvisedCommand) {
    const RecordedBake bake =
        recordedBake("--as solid --as glass%20%27top%27%3B=shell --as wheel=auto --as -x=shell");
    EXPECT_TRUE(bake.understood);
    EXPECT_EQ(bake.shape.as, ShapeAs::kSolid);
    const std::vector<std::string> names = {"glass 'top';", "wheel", "-x"};
    EXPECT_EQ(bake.shape.names(), names);
    EXPECT_EQ(bake.words(), " --as solid --as 'glass '\\''top'\\'';=shell' --as wheel=auto --as -x=shell");
    for (const char* options :
         {"--as a;reboot=shell", "--as $(reboot)=shell", "--as a%0Ab=shell", "--as a=b=shell"}) {
        const RecordedBake hostile = recordedBake(options);
        EXPECT_FALSE(hostile.understood) << options;
        EXPECT_EQ(hostile.words(), "");
        EXPECT_TRUE(hostile.shape.named.empty());
    }
}

TEST(RecordedBake, MakesTheSolidThatWasBaked) {
    TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    box.triangles.pop_back();
    const Result<ShapedMesh> closed = shapedMesh(recordedBake(""), box);
    ASSERT_TRUE(closed);
    EXPECT_TRUE(closed->mesh.closed());
    const Result<ShapedMesh> kept = shapedMesh(recordedBake("--holes keep"), box);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->mesh->triangles.size(), 11U);
    const Result<ShapedMesh> shell = shapedMesh(recordedBake("--as shell --thickness 0.1"), box);
    ASSERT_TRUE(shell);
    EXPECT_NEAR(shell->report.thickness, 0.1, 1e-6);
    const Result<ShapedMesh> filled = repairedMesh(recordedBake("--holes keep --repair holes"), box);
    ASSERT_TRUE(filled);
    EXPECT_EQ(filled->mesh->triangles.size(), 12U);
    // Whoever says this must not have a check run for hours.
    EXPECT_FALSE(repairedMesh(recordedBake("--repair wrap=0.001"), box));
}

TEST(ShellWord, IsOneWordToAShell) {
    EXPECT_EQ(shellWord("a/b-1.obj"), "a/b-1.obj");
    EXPECT_EQ(shellWord("my mesh.obj"), "'my mesh.obj'");
    EXPECT_EQ(shellWord("it's.obj"), "'it'\\''s.obj'");
    EXPECT_EQ(shellWord("$(reboot)"), "'$(reboot)'");
    EXPECT_EQ(shellWord("-o"), "./-o");
    EXPECT_EQ(shellWord(""), "''");
}

}  // namespace
}  // namespace relief::test
