// SPDX-License-Identifier: Apache-2.0
// The cache of a recipe recognises files that are up to date, detects every change, and rejects foreign files. Also
// depfiles in the syntax of Make and Ninja.
#include "bake/recipe/bake_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <thread>

#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class BakeCache : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* file : {"m.obj", "m.bin", "m.relief"}) {
            put(file, file);
        }
        job_.mesh = "m.obj";
        job_.mesh_path = folder_ / "m.obj";
        job_.output = "m.relief";
        job_.output_path = folder_ / "m.relief";
        job_.options = {"--compress=3"};
        entry_ = {"relief 1",
                  job_.options,
                  {{"m.obj", hash("m.obj")}, {"m.bin", hash("m.bin")}},
                  hash("m.relief"),
                  8};
    }

    void put(const std::string& file, const std::string& text) const { temporary_.write(file, text); }
    [[nodiscard]] std::string hash(const char* file) const {
        return hashOfFile(folder_ / file).value_or("none");
    }
    [[nodiscard]] std::string why() const {
        return staleness(job_, &entry_, "relief 1", folder_).value_or("up to date");
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    RecipeJob job_;
    BakeCacheEntry entry_;
};

TEST_F(BakeCache, LinksAreNotFollowed) {
    const fs::path elsewhere = folder_ / "elsewhere";
    fs::create_directory(elsewhere);
    for (const bool dangling : {false, true}) {
        put("elsewhere/precious", bakeCacheText({{"m.relief", entry_}}));
        const std::string before = hash("elsewhere/precious");
        if (dangling) {
            fs::remove(elsewhere / "precious");
        }
        fs::remove(folder_ / kBakeCacheName);
        fs::create_symlink("elsewhere/precious", folder_ / kBakeCacheName);
        expectError(loadBakeCache(folder_), ErrorCode::kInvalidInput);
        ASSERT_TRUE(updateBakeCache(folder_, {{"m.relief", entry_}}));
        EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / kBakeCacheName)))
            << "must replace the link";
        EXPECT_EQ(hash("elsewhere/precious"), dangling ? "none" : before);
        EXPECT_EQ(loadBakeCache(folder_)->size(), 1U);
    }
}

TEST_F(BakeCache, EveryChangeIsDetected) {
    EXPECT_EQ(why(), "up to date");
    fs::last_write_time(folder_ / "m.obj", fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_EQ(why(), "up to date") << "modification times do not matter";

    for (const char* input : {"m.obj", "m.bin"}) {
        const auto time = fs::last_write_time(folder_ / input);
        put(input, "m.xyz");  // same size and time as before
        fs::last_write_time(folder_ / input, time);
        EXPECT_EQ(why(), std::string("'") + input + "' changed");
        fs::remove(folder_ / input);
        EXPECT_EQ(why(), std::string("'") + input + "' changed");
        put(input, input);
        EXPECT_EQ(why(), "up to date");
    }
    put("m.relief", "M.relief");
    EXPECT_EQ(why(), "the output changed");
    fs::remove(folder_ / "m.relief");
    EXPECT_EQ(why(), "the output is missing");
    EXPECT_EQ(*staleness(job_, nullptr, "relief 1", folder_), "new");
    put("m.relief", "m.relief");
    EXPECT_EQ(*staleness(job_, nullptr, "relief 1", folder_), "the output is not in the cache");
    EXPECT_EQ(*staleness(job_, &entry_, "relief 2", folder_), "baked by another version of relief");
    job_.options = {"--compress=4"};
    EXPECT_EQ(why(), "the options changed");
    job_.options = entry_.options;
    job_.mesh = "m.bin";
    EXPECT_EQ(why(), "the mesh is a different file");
}

TEST_F(BakeCache, PipesAreNotInputs) {
    fs::remove(folder_ / "m.bin");
    ASSERT_EQ(::mkfifo((folder_ / "m.bin").c_str(), 0600), 0);
    EXPECT_EQ(why(), "'m.bin' changed") << "must not wait for a writer";
    EXPECT_FALSE(hashOfFile("/dev/zero"));
}

TEST_F(BakeCache, WorldIsUpToDateOnlyWithAllContainers) {
    fs::create_directory(folder_ / "w");
    for (const char* file : {"w/world.json", "w/a.relief", "w/b.relief"}) {
        put(file, file);
    }
    job_.output = "w/world.json";
    job_.output_path = folder_ / job_.output;
    job_.world = true;
    entry_.output_hash = hash("w/world.json");
    EXPECT_EQ(why(), "the output is not in the cache") << "a world needs containers";
    entry_.containers = {{"a.relief", hash("w/a.relief")}, {"b.relief", hash("w/b.relief")}};
    EXPECT_EQ(why(), "up to date");
    put("w/b.relief", "w/B.relief");
    EXPECT_EQ(why(), "its 'b.relief' changed");
    fs::remove(folder_ / "w/b.relief");
    EXPECT_EQ(why(), "its 'b.relief' is missing");
    put("w/b.relief", "w/b.relief");
    put("w/world.json", "{}");
    EXPECT_EQ(why(), "the output changed");
    ASSERT_TRUE(updateBakeCache(folder_, {{job_.output, entry_}}));
    EXPECT_EQ(*loadBakeCache(folder_), (BakeCacheEntries{{job_.output, entry_}}));
}

TEST_F(BakeCache, FolderHashCoversFileNames) {
    fs::create_directory(folder_ / "parts");
    put("parts/a.obj", "a");
    const auto now = [&] { return hashOfInput(folder_ / "parts"); };
    const auto before = now();
    ASSERT_TRUE(before);
    for (const char* file :
         {"parts/a.obj", "parts/x.relief", "parts/world.json", "parts/.relief-cache.json"}) {
        put(file, "b");
        EXPECT_EQ(now(), before) << file
                                 << ": contents are separate inputs, and outputs may be in the folder";
    }
    put("parts/b.obj", "a");
    EXPECT_NE(now(), before);
    fs::rename(folder_ / "parts/b.obj", folder_ / "parts/c.obj");
    fs::remove(folder_ / "parts/a.obj");
    EXPECT_NE(now(), before);
    fs::rename(folder_ / "parts/c.obj", folder_ / "parts/a.obj");
    EXPECT_EQ(now(), before);
    EXPECT_FALSE(hashOfInput(folder_ / "gone"));
}

TEST_F(BakeCache, RoundTrips) {
    EXPECT_TRUE(loadBakeCache(folder_)->empty());
    ASSERT_TRUE(updateBakeCache(folder_, {{"m.relief", entry_}}));
    put("n.relief", "n");
    BakeCacheEntry other = entry_;
    other.options.clear();
    ASSERT_TRUE(updateBakeCache(folder_, {{"n.relief", other}, {"gone.relief", other}}));
    const auto read = required(loadBakeCache(folder_));
    EXPECT_EQ(read, (BakeCacheEntries{{"m.relief", entry_}, {"n.relief", other}}))
        << "entries of both runs, without the removed output";
}

TEST_F(BakeCache, ConcurrentWritersLoseNothing) {
    std::vector<std::jthread> writers;
    for (int w = 0; w < 8; ++w) {
        writers.emplace_back([this, w] {
            for (int i = 0; i < 8; ++i) {
                const std::string name = std::to_string(w) + "_" + std::to_string(i) + ".relief";
                put(name, name);
                EXPECT_TRUE(updateBakeCache(folder_, {{name, entry_}}));
            }
        });
    }
    writers.clear();
    EXPECT_EQ(required(loadBakeCache(folder_)).size(), 64U);
}

TEST_F(BakeCache, InvalidCachesAreRejected) {
    const std::string good = bakeCacheText({{"m.relief", entry_}});
    ASSERT_TRUE(parseBakeCache(good));
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    for (const std::string& text :
         {std::string(), std::string("[]"), std::string(100'000, '['), good.substr(0, good.size() / 2),
          replaced("relief-cache", "other-cache"), replaced("\"version\": 1", "\"version\": 2"),
          replaced("\"output_bytes\": 8", "\"output_bytes\": -8"), replaced("\"tool\"", "\"tol\""),
          replaced("\"inputs\": [", "\"inputs\": [1,"), replaced("\"options\": [", "\"options\": [1,"),
          replaced("\"output_hash\"", "\"containers\": {\"a\": 1}, \"output_hash\""),
          // Without inputs, no change would ever be detected.
          std::string(
              R"({"format":"relief-cache","version":1,"outputs":{"a":{"tool":"t","options":[],"inputs":[],)"
              R"("output_hash":"h","output_bytes":1}}})")}) {
        SCOPED_TRACE(text.substr(0, 300));
        expectError(parseBakeCache(text), ErrorCode::kInvalidInput);
    }
    put(kBakeCacheName, "{}");
    const auto loaded = loadBakeCache(folder_);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find(kBakeCacheName), std::string::npos);
    ASSERT_TRUE(updateBakeCache(folder_, {{"m.relief", entry_}})) << "must replace the invalid cache";
    EXPECT_EQ(loadBakeCache(folder_)->size(), 1U);
}

TEST(Depfile, EscapesForMakeAndNinja) {
    EXPECT_EQ(*depfileText({"o"}, {"a"}), "o: \\\n  a\n");
    EXPECT_EQ(
        *depfileText({"o", "p q"}, {"a b", "c#d", "e$f", "a b", "g:h", "i\\j"}),
        "o p\\ q: \\\n  a\\ b \\\n  c\\#d \\\n  e$$f \\\n  g\\:h \\\n  i\\j\nc\\#d:\ne$$f:\ng\\:h:\ni\\j:\n");
    for (const char* name : {"", "a\nb", "a\tb", "a;b", "a=b", "a\\ b", "a\\#b", "a\\"}) {
        SCOPED_TRACE(name);
        expectError(depfileText({"o"}, {name}), ErrorCode::kUnsupported);
        EXPECT_FALSE(depfileText({name}, {"a"})) << name;
    }
    EXPECT_FALSE(depfileText({"50%"}, {"a"})) << "'%' would make a pattern rule";
    EXPECT_TRUE(depfileText({"o"}, {"50%"}));
}

}  // namespace
}  // namespace relief::test
