// --prune removes what this recipe has baked and nothing else, whatever a hostile cache or a link may say.
#include "bake/recipe/prune.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "bake/recipe/bake_cache.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class Prune : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "relief_prune_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        base_ = name;
        out_ = base_ / "out";
        fs::create_directories(out_ / "sub");
        fs::create_directories(base_ / "elsewhere");
    }
    void TearDown() override { fs::remove_all(base_); }

    void put(const fs::path& file, const std::string& text) const { std::ofstream(out_ / file) << text; }
    /// A file, and an entry that says that r.toml has baked it.
    void bake(const std::string& output, const std::string& recipe = "r.toml") {
        put(output, output);
        entries_[output] = {"relief 1", {}, {{"m.obj", ""}}, *hashOfFile(out_ / output), 1, recipe};
    }
    /// "name: why it stays" of each that was found.
    std::vector<std::string> prune(const std::set<std::string>& wanted = {}, bool dry_run = false) {
        put(kBakeCacheName, bakeCacheText(entries_));
        const auto pruned = pruneOutputs(
            out_, "r.toml", [&](const std::string& output) { return wanted.contains(output); }, dry_run);
        std::vector<std::string> found;
        for (const PrunedOutput& output : pruned.value()) {
            found.push_back(output.output + (output.kept.empty() ? "" : ": " + output.kept));
        }
        return found;
    }
    [[nodiscard]] bool has(const fs::path& file) const { return fs::exists(out_ / file); }

    fs::path base_;
    fs::path out_;
    BakeCacheEntries entries_;
};

using Names = std::vector<std::string>;

TEST_F(Prune, RemovesWhatThisRecipeHasBaked) {
    bake("gone.relief");
    bake("sub/gone.relief");
    bake("wanted.relief");
    bake("others.relief", "other.toml");
    bake("older.relief", "");
    put("stranger.relief", "x");
    EXPECT_EQ(prune({"wanted.relief"}, true), (Names{"gone.relief", "sub/gone.relief"}));
    EXPECT_TRUE(has("gone.relief")) << "a dry run";
    EXPECT_EQ(prune({"wanted.relief"}), (Names{"gone.relief", "sub/gone.relief"}));
    EXPECT_FALSE(has("gone.relief") || has("sub/gone.relief"));
    for (const char* name : {"wanted.relief", "others.relief", "older.relief", "stranger.relief", "sub"}) {
        EXPECT_TRUE(has(name)) << name;
    }
    const auto left = loadBakeCache(out_);
    EXPECT_EQ(left->size(), 3U);
    EXPECT_FALSE(left->contains("gone.relief"));
    EXPECT_EQ(left->at("wanted.relief").recipe, "r.toml");
}

TEST_F(Prune, KeepsWhatIsNotWhatWasBaked) {
    bake("changed.relief");
    bake("folder.relief");
    bake("missing.relief");
    put("changed.relief", "by hand");
    fs::remove(out_ / "folder.relief");
    fs::create_directory(out_ / "folder.relief");
    fs::remove(out_ / "missing.relief");
    EXPECT_EQ(prune(), (Names{"changed.relief: it is not what was baked", "folder.relief: it is no file"}));
    EXPECT_TRUE(has("changed.relief") && has("folder.relief"));
    EXPECT_TRUE(loadBakeCache(out_)->contains("changed.relief")) << "it is told of again";
}

TEST_F(Prune, FollowsNoLink) {
    std::ofstream(base_ / "elsewhere/x.relief") << "sub/x.relief";
    bake("sub/x.relief");
    bake("y.relief");
    fs::remove_all(out_ / "sub");
    fs::create_directory_symlink("../elsewhere", out_ / "sub");
    fs::rename(out_ / "y.relief", base_ / "elsewhere/y.relief");
    fs::create_symlink("../elsewhere/y.relief", out_ / "y.relief");
    EXPECT_EQ(prune(),
              (Names{"sub/x.relief: a symbolic link leads there", "y.relief: a symbolic link leads there"}));
    EXPECT_TRUE(fs::exists(base_ / "elsewhere/x.relief"));
    EXPECT_TRUE(fs::exists(base_ / "elsewhere/y.relief"));
    EXPECT_TRUE(fs::is_symlink(out_ / "y.relief"));
}

TEST_F(Prune, AHostileCacheReachesNothingElse) {
    std::ofstream(base_ / "elsewhere/x.relief") << "x";
    std::ofstream(out_ / "mesh.obj") << "x";
    const BakeCacheEntry entry{"relief 1", {}, {{"m.obj", ""}}, *hashOfFile(out_ / "mesh.obj"), 1, "r.toml"};
    for (const std::string& name :
         {std::string("../elsewhere/x.relief"), std::string("sub/../../elsewhere/x.relief"),
          (base_ / "elsewhere/x.relief").string(), std::string("mesh.obj"), std::string(""),
          std::string(".."), std::string("./mesh.obj"), std::string("mesh.obj\0.relief", 16),
          std::string(".relief")}) {
        entries_[name] = entry;
    }
    EXPECT_EQ(prune(), Names{});
    EXPECT_TRUE(fs::exists(base_ / "elsewhere/x.relief"));
    EXPECT_TRUE(has("mesh.obj"));
}

TEST_F(Prune, AnUnknownRecipeOwnsNothing) {
    bake("gone.relief", "");
    put(kBakeCacheName, bakeCacheText(entries_));
    const auto pruned = pruneOutputs(
        out_, "", [](const std::string&) { return false; }, false);
    EXPECT_TRUE(pruned->empty());
    EXPECT_TRUE(has("gone.relief"));
}

TEST_F(Prune, RecipesAreKnownByWhereTheyLie) {
    std::ofstream(base_ / "r.toml") << "x";
    fs::create_directory_symlink("out", base_ / "linked");
    EXPECT_EQ(recipeName(base_ / "r.toml", out_), "../r.toml");
    EXPECT_EQ(recipeName(base_ / "elsewhere/../r.toml", base_ / "linked"), "../r.toml");
    EXPECT_EQ(recipeName("-", out_), "");
}

}  // namespace
}  // namespace relief::test
