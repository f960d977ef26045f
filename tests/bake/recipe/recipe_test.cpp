// SPDX-License-Identifier: Apache-2.0
// Recipes: parsing, merging and file patterns. Errors name the place, and paths outside the folders are rejected.
#include <gtest/gtest.h>
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "bake/recipe/glob.h"
#include "bake/recipe/recipe.h"
#include "bake/recipe/recipe_jobs.h"
#include "bake/recipe/recipe_run.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

const std::vector<RecipeKey>& keys() {
    using Kind = FieldKind;
    static const std::vector<RecipeKey> kKeys = {{"map", Kind::kList},        {"paper", Kind::kFlag},
                                                 {"clips", Kind::kList},      {"budget", Kind::kValue},
                                                 {"decode", Kind::kValue},    {"prefer", Kind::kValue},
                                                 {"max-error", Kind::kValue}, {"compress", Kind::kValue},
                                                 {"heights", Kind::kValue},   {"texel", Kind::kValue}};
    return kKeys;
}

std::string recipe(const std::string& rest) {
    return "version = 1\n" + rest;
}

using Arguments = std::vector<std::string>;

/// The assets of a valid recipe.
std::vector<RecipeAsset> assetsOf(const std::string& rest) {
    return required(parseRecipe(recipe(rest), keys(), "r.toml"));
}

TEST(Recipe, MergesDefaultsKeyByKey) {
    const auto assets = assetsOf(
        "[defaults]\noutput = '{stem}.relief'\ncompress = 3\nprefer = 'inside'\n[[asset]]\nmesh = 'a.obj'\n"
        "[[asset]]\nmesh = ['b.obj', 'c/*.obj']\nprefer = 'outside'\n"
        "max-error = 1.5\noutput = 'x/{stem}.relief'\nexclude = 'c/d.obj'\n");
    ASSERT_EQ(assets.size(), 2U);
    EXPECT_EQ(recipeArguments(assets[0].options), (Arguments{"--compress=3", "--prefer=inside"}));
    EXPECT_EQ(recipeArguments(assets[1].options),
              (Arguments{"--compress=3", "--max-error=1.5", "--prefer=outside"}));
    EXPECT_EQ(assets[0].output, "{stem}.relief");
    EXPECT_EQ(assets[1].output, "x/{stem}.relief");
    EXPECT_EQ(assets[1].meshes.size(), 2U);
    EXPECT_EQ(assets[1].exclude, std::vector<std::string>{"c/d.obj"});
}

TEST(Recipe, MessagesNameKeysInsteadOfOptions) {
    for (const auto& [message, expected] : {std::pair("--max-error is 'x' (--map and --paper); see --help",
                                                      "max-error is 'x' (map and paper); see --help"),
                                            {"a--map.obj: '--map' has no effect; raise -j or --budget",
                                             "a--map.obj: '--map' has no effect; raise -j or budget"},
                                            {"--maps --", "--maps --"}}) {
        EXPECT_EQ(nameKeys(message, keys()), expected);
    }
}

/// Each recipe with its expected assets: whether the asset is a world, and its arguments.
TEST(Recipe, DefaultsThatConflictWithAnAssetAreDropped) {
    const std::string defaults = "[defaults]\noutput = '{stem}.relief'\n";
    const std::vector<std::pair<std::string, std::vector<std::pair<bool, Arguments>>>> recipes = {
        // Otherwise an asset with patches could not override defaults with maps, or vice versa.
        {defaults + "map = ['cube:size=8', 'float:size=8']\ndecode = 'projected'\ncompress = 1\n"
                    "[[asset]]\nmesh = 'a'\n[[asset]]\nmesh = 'b'\nbudget = '1MB'\n"
                    "[[asset]]\nmesh = 'c'\npaper = true\n[[asset]]\nmesh = 'd'\npaper = false\n",
         {{false, {"--compress=1", "--decode=projected", "--map=cube:size=8", "--map=float:size=8"}},
          {false, {"--budget=1MB", "--compress=1"}},
          {false, {"--compress=1", "--paper"}},
          {false, {"--compress=1"}}}},
        // Otherwise defaults for meshes would limit a level to the budget of one mesh, or be errors for a height map.
        {"[defaults]\noutput = '{stem}/world.json'\nmax-error = 1\nmap = 'float'\n"
         "prefer = 'inside'\ncompress = 3\n[[asset]]\nmesh = 'a'\n[[asset]]\nmesh = 'b'\nbudget = '4MB'\n"
         "[[asset]]\nmesh = 'c'\noutput = 'c.relief'\n[[asset]]\nmesh = 'd'\nheights = 'low=0'\n"
         "[[asset]]\nmesh = 'e'\nheights = 'low=0'\noutput = 'e.relief'\n"
         "[[asset]]\nmesh = 'f'\noutput = 'fworld.json'\ntexel = '1cm'\n",
         {{true, {"--compress=3", "--prefer=inside"}},
          {true, {"--budget=4MB", "--compress=3", "--prefer=inside"}},
          {false, {"--compress=3", "--map=float", "--max-error=1", "--prefer=inside"}},
          {true, {"--compress=3", "--heights=low=0"}},
          {false, {"--compress=3", "--heights=low=0"}},
          {false, {"--compress=3", "--prefer=inside", "--texel=1cm"}}}},
    };
    for (const auto& [text, wanted] : recipes) {
        std::vector<std::pair<bool, Arguments>> read;
        for (const RecipeAsset& asset : assetsOf(text)) {
            read.emplace_back(asset.isWorld(), recipeArguments(asset.options));
        }
        EXPECT_EQ(read, wanted);
    }
}

TEST(Recipe, ErrorsNameTheCauseAndTheLine) {
    struct Case {
        std::string text;
        const char* says;
        ErrorCode code = ErrorCode::kInvalidInput;
    };
    const std::string asset = "[[asset]]\nmesh = 'a.obj'\noutput = 'a.relief'\n";
    std::string many = "version = 1\n";
    for (std::size_t i = 0; i <= kRecipeTablesMax; ++i) {
        many += "[[asset]]\n";
    }
    std::string patterns = "mesh = [";
    for (std::size_t i = 0; i <= kRecipePatternsMax; ++i) {
        patterns += "'a',";
    }
    const Case cases[] = {
        {"", "r.toml:1:1: a recipe needs version = 1"},
        {"version = 2\n" + asset, "r.toml:1:11: version must be 1"},
        {"version = ", "r.toml:1:"},
        {recipe(""), "r.toml:1:1: a recipe needs at least one [[asset]]"},
        {recipe("asset = 3"), "r.toml:2:9: a recipe needs at least one [[asset]]"},
        {recipe("asset = [3]"), "r.toml:2:10: an asset must be a table"},
        {recipe("[default]\n" + asset), "r.toml:2:2: unknown key 'default'; did you mean 'defaults'"},
        {recipe("defaults = 1\n" + asset), "r.toml:2:12: defaults must be a table"},
        {recipe("[defaults]\nmesh = 'a'\n" + asset), "r.toml:3:1: unknown key 'mesh'"},
        {recipe("[defaults]\nprefre = 'inside'\n" + asset),
         "r.toml:3:1: unknown key 'prefre'; did you mean 'prefer'"},
        {recipe(asset + "\"a\\u001bb\" = 3\n"), "r.toml:5:1: unknown key"},
        {recipe(asset + "threads = 3\n"), "r.toml:5:1: unknown key 'threads'"},
        {recipe("[[asset]]\noutput = 'a.relief'"), "r.toml:2:1: an asset needs mesh"},
        {recipe("[[asset]]\nmesh = 'a.relief'"), "r.toml:2:1: an asset needs an output"},
        {recipe("[[asset]]\nmesh = []\noutput = 'a.relief'"), "r.toml:3:8: mesh is an empty list"},
        {recipe("[[asset]]\nmesh = ''\noutput = 'a.relief'"), "r.toml:3:8: mesh is empty"},
        {recipe("[[asset]]\nmesh = 3\noutput = 'a.relief'"), "r.toml:3:8: mesh must be a string"},
        {recipe(asset + "compress = true"), "r.toml:5:12: compress must be a string or a number"},
        {recipe(asset + "compress = [1]"), "r.toml:5:12: compress must be a string or a number"},
        {recipe(asset + "map = [1]"), "r.toml:5:8: map must be a string"},
        {recipe(asset + "paper = 'yes'"), "r.toml:5:9: paper must be true or false"},
        {recipe(asset + "optional = 1"), "r.toml:5:12: optional must be true or false"},
        {recipe(asset + "prefer = \"a\\u0000b\""), "r.toml:5:10: prefer contains a zero byte"},
        {recipe(asset + "prefer = '" + std::string(5000, 'x') + "'"), "longer than", ErrorCode::kLimit},
        {many, "10001 [[asset]]", ErrorCode::kLimit},
        {recipe("[[asset]]\n" + patterns + "]"), "mesh lists more than 1000", ErrorCode::kLimit},
        {recipe("x = " + std::string(5000, '[')), "r.toml:2:"},
        {"\xff\xfe", "r.toml:1:"},
    };
    for (const Case& c : cases) {
        const auto assets = parseRecipe(c.text, keys(), "r.toml");
        expectError(assets, c.code, c.says);
        EXPECT_TRUE(!assets && assets.error().message.starts_with("r.toml:") &&
                    assets.error().message.find('\x1b') == std::string::npos);
    }
}

class RecipeJobsTest : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* file :
             {"rocks/a.obj", "rocks/b.obj", "rocks/deep/a.obj", "rocks/b.mtl", "hill.off"}) {
            put(file);
        }
    }

    void put(const std::string& file) {
        fs::create_directories((folder_ / file).parent_path());
        std::ofstream(folder_ / file) << file;
    }
    Result<RecipeJobs> jobs(const std::string& rest, const fs::path& out = "") {
        const auto assets = parseRecipe(recipe(rest), keys(), folder_ / "r.toml");
        EXPECT_TRUE(assets) << assets.error().message;
        return assets ? recipeJobs(*assets, folder_ / "r.toml", out) : Result<RecipeJobs>(forward(assets));
    }
    static std::vector<std::string> outputs(const RecipeJobs& found) {
        std::vector<std::string> names;
        for (const RecipeJob& job : found.jobs) {
            names.push_back(job.mesh + ">" + job.output);
        }
        return names;
    }
    void fails(const std::string& rest, const std::string& says, const fs::path& out = "") {
        expectError(jobs(rest, out), ErrorCode::kInvalidInput, says);
        expectError(jobs(rest, out), ErrorCode::kInvalidInput, "r.toml:");
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path() / "in";
};

TEST_F(RecipeJobsTest, FindsFilesInOrderAndNamesOutputs) {
    const RecipeJobs found = required(
        jobs("[defaults]\noutput = 'baked/{dir}/{stem}.relief'\n"
             "[[asset]]\nmesh = ['hill.off', '**/*.obj']\nexclude = '**/b.*'\n"
             "[[asset]]\nmesh = 'rocks/b.obj'\noutput = './x//{name}.relief'\nclips = 'hill.off'\n"));
    EXPECT_EQ(outputs(found),
              (std::vector<std::string>{"hill.off>baked/hill.relief", "rocks/a.obj>baked/rocks/a.relief",
                                        "rocks/deep/a.obj>baked/rocks/deep/a.relief",
                                        "rocks/b.obj>x/b.obj.relief"}));
    EXPECT_EQ(found.jobs[0].mesh_path, folder_ / "hill.off");
    EXPECT_EQ(found.jobs[0].output_path, folder_ / "baked/hill.relief");
    EXPECT_EQ(found.jobs[3].arguments,
              std::vector<std::string>{"--clips=" + (folder_ / "hill.off").string()});
    EXPECT_EQ(found.jobs[3].options, std::vector<std::string>{"--clips=hill.off"});
    EXPECT_EQ(found.folders.size(), 3U) << "the root, rocks and rocks/deep";
    const auto elsewhere = jobs("[[asset]]\nmesh = 'hill.off'\noutput = '{stem}.relief'\n", folder_ / "out");
    EXPECT_EQ(required(elsewhere).jobs[0].output_path, folder_ / "out/hill.relief");
}

TEST_F(RecipeJobsTest, PatternWithoutMatchesIsAnError) {
    fails("[[asset]]\nmesh = 'rock/*.obj'\noutput = '{stem}.relief'\n", "'rock/*.obj' matches no file");
    fails("[[asset]]\nmesh = 'rocks'\noutput = '{stem}.relief'\n", "'rocks' matches no file");
    const auto found =
        required(jobs("[[asset]]\nmesh = 'rock/*.obj'\noptional = true\noutput = '{stem}.relief'\n"));
    EXPECT_TRUE(found.jobs.empty());
}

TEST_F(RecipeJobsTest, WorldOwnsItsFolder) {
    const RecipeJobs found =
        required(jobs("[[asset]]\nmesh = 'ro*/'\noutput = 'w/{stem}/world.json'\n"
                      "[[asset]]\nmesh = 'hill.off'\noutput = 'w/hill.relief'\n"));
    EXPECT_EQ(outputs(found),
              (std::vector<std::string>{"rocks>w/rocks/world.json", "hill.off>w/hill.relief"}));
    EXPECT_TRUE(found.jobs[0].world && found.jobs[0].mesh_is_folder);
    EXPECT_FALSE(found.jobs[1].world || found.jobs[1].mesh_is_folder);
    EXPECT_TRUE(found.jobs[0].arguments.empty());
    EXPECT_EQ(found.jobs[0].options, std::vector<std::string>{kWorldOption})
        << "a world, even if a collider has the same options";
    fs::create_symlink("w", folder_ / "link");
    const std::string level = "[[asset]]\nmesh = 'rocks/'\noutput = 'w/world.json'\n";
    for (const char* other : {"w/x/world.json", "link/x.relief", "w/a/b/c.relief"}) {
        fails(level + "[[asset]]\nmesh = 'hill.off'\noutput = '" + other + "'\n",
              std::string("the output '") + other + "' is in the folder of the world 'w/world.json'");
    }
    fails(level + "[[asset]]\nmesh = 'hill.off'\noutput = 'link/world.json'\n", "would both write");
    EXPECT_TRUE(jobs(level + "[[asset]]\nmesh = 'hill.off'\noutput = 'wx/world.json'\n"));
}

TEST_F(RecipeJobsTest, OutputCollisionsAreErrors) {
    const std::string rocks = "[[asset]]\nmesh = '**/a.obj'\n";
    fails(rocks + "output = '{stem}.relief'\n",
          "'rocks/a.obj' and the bake of 'rocks/deep/a.obj' would both write 'a.relief'");
    fails(rocks + "output = 'x/../a.relief'\n", "write 'a.relief'");
    put("mesh.relief");
    fails("[[asset]]\nmesh = 'mesh.relief'\noutput = '{stem}.relief'\n", "is the input");
    fs::create_symlink("rocks", folder_ / "link");
    fs::create_symlink("later", folder_ / "to_later");  // created later by the first bake
    fs::create_symlink("fresh.relief", folder_ / "to_fresh.relief");
    put("one.relief");
    fs::create_hard_link(folder_ / "one.relief", folder_ / "two.relief");
    for (const auto& [first, second] :
         {std::pair{"rocks/x.relief", "link/x.relief"}, std::pair{"later/x.relief", "to_later/x.relief"},
          std::pair{"to_fresh.relief", "fresh.relief"}, std::pair{"one.relief", "two.relief"}}) {
        fails("[[asset]]\nmesh = 'hill.off'\noutput = '" + std::string(first) +
                  "'\n[[asset]]\nmesh = 'rocks/a.obj'\noutput = '" + second + "'\n",
              "would both write '" + std::string(second) + "'");
    }
}

TEST_F(RecipeJobsTest, PathsOutsideTheFoldersAreRejected) {
    const auto mesh = [](const std::string& name) {
        return "[[asset]]\nmesh = '" + name + "'\noutput = '{stem}.relief'\n";
    };
    const auto output = [](const std::string& name) {
        return "[[asset]]\nmesh = 'hill.off'\noutput = '" + name + "'\n";
    };
    std::ofstream(folder_.parent_path() / "secret.obj") << "x";
    fs::create_symlink("../secret.obj", folder_ / "secret.obj");
    fs::create_symlink("..", folder_ / "up");
    fails(mesh("../secret.obj"), "leaves the recipe's folder");
    fails(mesh("/etc/passwd"), "is an absolute path");
    fails(mesh("secret.obj"), "leads out of the recipe's folder");
    fails(mesh("up/*.obj"), "leads out of the recipe's folder");
    fs::create_symlink("../../secret.obj", folder_ / "rocks/secret.obj");
    fails("[[asset]]\nmesh = 'rocks/'\noutput = 'w/world.json'\n", "contains the link 'secret.obj'");
    for (const char* name : {"../x.relief", "up/x.relief", "up/world.json"}) {
        fails(output(name), "is outside the output folder");
    }
    for (const char* name : {"hill.off", "{stem}/.relief", "{stem}/world.json/", "{dir}world.json"}) {
        fails(output(name), "must end in .relief");
    }
    fails(output("/x.relief"), "must be a relative path");
    fails(output("{sten}.relief"), "{sten}");
    fails(output("{stem.relief"), "use {stem}");
    fails(output("stem}.relief"), "} without a {");
    fails(output("hill.relief") + "clips = '../p.glb'\n",
          "clips '../p.glb' leads out of the recipe's folder");
}

TEST_F(RecipeJobsTest, ForeignFilesAreNotReplaced) {
    RecipeRun run;
    run.recipe = folder_ / "r.toml";
    run.output_folder = folder_;
    run.dry_run = true;
    const auto outcome = [&](const std::vector<std::string>& outputs) {
        std::string assets;
        for (const std::string& output : outputs) {
            assets += "[[asset]]\nmesh = 'hill.off'\noutput = '" + output + "'\n";
        }
        const auto result = runRecipe(jobs(assets)->jobs, run);
        EXPECT_TRUE(result || result.error().code == ErrorCode::kUsage);
        return result ? "" : result.error().message;
    };
    put("rock.relief");  // a material library can have any name
    put("w/world.json");
    fs::create_symlink("rocks/b.mtl", folder_ / "link.relief");
    for (const char* file : {"rock.relief", "link.relief"}) {
        EXPECT_NE(outcome({file}).find(file + std::string("' exists and is not a collider")),
                  std::string::npos);
    }
    EXPECT_NE(outcome({"w/world.json"}).find("w/world.json' exists and is not a world"), std::string::npos);
    std::ofstream(folder_ / "rock.relief") << "\xabRELIEF\xbb\r\n\x1a\n and damaged";
    std::ofstream(folder_ / "w/world.json") << "{\"format\": \"relief-world\", damaged";
    std::ofstream(folder_ / "none.relief");
    put("known.relief");
    BakeCacheEntry entry;
    entry.tool = "t";
    entry.inputs = {{"hill.off", "x"}};
    ASSERT_TRUE(updateBakeCache(folder_, {{"known.relief", entry}}));
    EXPECT_EQ(outcome({"rock.relief", "w/world.json", "none.relief", "fresh.relief", "known.relief"}), "")
        << "the last one is a damaged output of a bake";
}

TEST(RecipeShards, EveryOutputIsInExactlyOneShard) {
    for (const std::uint64_t count : {1, 2, 7, 64}) {
        std::vector<int> sizes(count, 0);
        for (int i = 0; i < 1000; ++i) {
            const std::string name = "baked/rock_" + std::to_string(i) + ".relief";
            int homes = 0;
            for (std::uint64_t k = 1; k <= count; ++k) {
                const int here = inShard(name, {k, count}) ? 1 : 0;
                homes += here;
                sizes[k - 1] += here;
            }
            ASSERT_EQ(homes, 1) << name << " of " << count;
        }
        EXPECT_GT(*std::ranges::min_element(sizes), static_cast<int>(1000 / count / 4))
            << "shards should have similar sizes";
    }
    // Shards of one array can run on several machines. XXH3-64 of the empty string is 2d06800538d394c2.
    EXPECT_TRUE(inShard("", {1 + 0xc2 % 4, 4}));
}

namespace fs = std::filesystem;

bool matches(const std::string& pattern, const std::string& path) {
    const Result<GlobPattern> parsed = GlobPattern::parse(pattern);
    EXPECT_TRUE(parsed) << pattern << ": " << parsed.error().message;
    return parsed && parsed->matches(path);
}

/// \param pair  a pattern and a path, separated by a space
bool matchesPair(const std::string& pair) {
    const std::size_t space = pair.find(' ');
    return matches(pair.substr(0, space), pair.substr(space + 1));
}

TEST(Glob, MatchesPartByPart) {
    // Two stars match any number of folders.
    for (const std::string pair :
         {"a.obj a.obj", "./a.obj a.obj", "*.obj a.obj", ".*.obj .a.obj", "x/?.o*j x/a.obj",
          "[a-c].obj b.obj", "\\[a\\].obj [a].obj", "**/*.obj a.obj", "**/*.obj x/y/a.obj",
          "x/**/a.obj x/a.obj", "x/**/y/**/a.obj x/1/y/2/3/a.obj", "**/**/a.obj a.obj"}) {
        EXPECT_TRUE(matchesPair(pair)) << pair;
    }
    // One star does not cross folders. Names that start with a dot are hidden. Two stars within a part act as one.
    for (const std::string pair :
         {"a.obj b/a.obj", "a.obj A.obj", "*.obj x/a.obj", "*.obj .a.obj", "[!a-c].obj b.obj",
          "[a].obj [a].obj", "x/* x", "x x/y", "x/**/y/**/a.obj x/1/2/3/a.obj", "**/a.obj .git/a.obj",
          "x**/a.obj x/y/a.obj"}) {
        EXPECT_FALSE(matchesPair(pair)) << pair;
    }
}

// 64 times ** against 2,000 folders: backtracking would never end.
TEST(Glob, MatchingTimeIsBounded) {
    std::string pattern;
    std::string path;
    for (int i = 0; i < 31; ++i) {
        pattern += "**/a*a*a*a*/";
    }
    for (int i = 0; i < 2000; ++i) {
        path += "aaaaaaaaaaaa/";
    }
    EXPECT_FALSE(matches(pattern + "b", path + "c"));
    EXPECT_TRUE(matches(pattern + "b", path + "b"));
}

TEST(Glob, RejectsInvalidPatterns) {
    for (const auto& [text, says] :
         std::vector<std::pair<std::string, const char*>>{{"", "names no file"},
                                                          {"./", "names no file"},
                                                          {"x/**/", "ends with **"},
                                                          {"x/**", "ends with **"},
                                                          {"/x", "absolute"},
                                                          {"x/../y", "leaves the recipe's folder"},
                                                          {{"a\0b", 3}, "zero byte"}}) {
        expectError(GlobPattern::parse(text), ErrorCode::kInvalidInput, says);
    }
    std::string deep;
    for (int i = 0; i < 65; ++i) {
        deep += "a/";
    }
    EXPECT_EQ(GlobPattern::parse(deep + "b").error().code, ErrorCode::kLimit);
}

TEST(Glob, WalksFoldersOnceInOrder) {
    const TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    for (const char* file : {"b.obj", "a.obj", "x/a.obj", "x/y/a.obj", "x.obj/no", ".h/a.obj", "x-/a.obj"}) {
        fs::create_directories((folder / file).parent_path());
        temporary.write(file, "x");
    }
    fs::create_symlink("a.obj", folder / "link.obj");
    fs::create_symlink("gone.obj", folder / "dangling.obj");
    fs::create_symlink("..", folder / "x/up.d");  // a cycle if links are followed
    const GlobResult found = required(globFiles(folder, *GlobPattern::parse("**/*.obj")));
    EXPECT_EQ(found.files,
              (std::vector<std::string>{"a.obj", "b.obj", "link.obj", "x-/a.obj", "x/a.obj", "x/y/a.obj"}));
    EXPECT_EQ(found.folders, (std::vector<std::string>{"", "x", "x-", "x.obj", "x/y"}));
    EXPECT_EQ(required(globFiles(folder, *GlobPattern::parse("x/up.d/*.obj"))).files.size(), 3U)
        << "must follow a link that is named";
    const GlobResult folders = required(globFiles(folder, *GlobPattern::parse("**/x*/")));
    EXPECT_EQ(folders.files, (std::vector<std::string>{"x", "x-", "x.obj"})) << "with a trailing slash";
    EXPECT_TRUE(globFiles(folder, *GlobPattern::parse("a.obj/"))->files.empty());
    EXPECT_EQ(globFiles(folder / "gone", *GlobPattern::parse("*")).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace relief::test
