// Videos through ffmpeg, which a script stands in for: what it is given, and what its failures lead to.
#include "runtime/files/video.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace relief {
namespace {

namespace fs = std::filesystem;

/// A folder to write into, and a PATH that begins with a folder for a false ffmpeg.
class Video : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "relief_video_XXXXXX").native();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        base_ = pattern;
        fs::create_directories(base_ / "bin");
        fs::create_directories(base_ / "out");
        path_ = std::getenv("PATH");
    }
    void TearDown() override {
        setenv("PATH", path_.c_str(), 1);
        fs::remove_all(base_);
    }
    /// \param body  of a shell script; "$out" is the file that ffmpeg is to write.
    void ffmpegIs(const std::string& body) {
        const fs::path file = base_ / "bin/ffmpeg";
        std::ofstream(file) << "#!/bin/sh\nfor out; do :; done\nout=${out#file:}\n" << body;
        ASSERT_EQ(chmod(file.c_str(), 0755), 0);
        setenv("PATH", ((base_ / "bin").native() + ":" + path_).c_str(), 1);
    }
    [[nodiscard]] std::string read(const fs::path& name) const {
        std::ifstream file(base_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] std::size_t filesLeft() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(base_ / "out"), fs::directory_iterator()));
    }
    Result<std::unique_ptr<VideoWriter>> create(const char* name = "a.mp4", std::uint32_t width = 5,
                                                std::uint32_t height = 3, double rate = 30.0) {
        return VideoWriter::create(base_ / "out" / name, {width, height, rate});
    }

    fs::path base_;
    std::string path_;
};

TEST_F(Video, FramesGoThroughThePipeAsTheyAre) {
    ffmpegIs("printf '%s\\n' \"$@\" > \"${0%/*}/../arguments\"\ncat > \"$out\"\n");
    std::string all;
    {
        auto writer = create("it's: 50% $(a).mp4", 5, 3, 6.0000002);
        ASSERT_TRUE(writer) << writer.error().message;
        for (int frame = 0; frame < 7; ++frame) {
            std::vector<std::uint8_t> rgb(45);
            for (std::size_t i = 0; i < rgb.size(); ++i) {
                rgb[i] = static_cast<std::uint8_t>(31 * frame + static_cast<int>(5 * i));
            }
            all.append(rgb.begin(), rgb.end());
            ASSERT_TRUE((*writer)->add(rgb));
        }
        EXPECT_FALSE(fs::exists(base_ / "out/it's: 50% $(a).mp4")) << "not before it is whole";
        const auto done = (*writer)->finish();
        ASSERT_TRUE(done) << done.error().message;
        EXPECT_FALSE((*writer)->finish());
    }
    EXPECT_EQ(read("out/it's: 50% $(a).mp4"), all);
    EXPECT_EQ(filesLeft(), 1U);
    const std::string arguments = "\n" + read("arguments");
    for (const char* words : {"\n-f\nrawvideo\n", "\n-pix_fmt\nrgb24\n", "\n-s\n5x3\n", "\n-r\n6\n",
                              "\n-i\npipe:0\n", "\nfile:"}) {
        EXPECT_NE(arguments.find(words), std::string::npos) << words << arguments;
    }
}

// More than a pipe holds, and a reader that is slow to begin.
TEST_F(Video, AFrameMayBeLargerThanThePipe) {
    ffmpegIs("sleep 0.1\nwc -c > \"$out\"\n");
    auto writer = create("a.mkv", 1000, 700);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->add(std::vector<std::uint8_t>(2'100'000)));
    ASSERT_TRUE((*writer)->finish());
    EXPECT_EQ(std::stol(read("out/a.mkv")), 2'100'000);
}

TEST_F(Video, WhatALinkPointsToIsReplaced) {
    ffmpegIs("cat > \"$out\"\n");
    std::ofstream(base_ / "real.mp4") << "older";
    fs::create_symlink("../real.mp4", base_ / "out/a.mp4");
    auto writer = create();
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->add(std::vector<std::uint8_t>(45)));
    ASSERT_TRUE((*writer)->finish());
    EXPECT_TRUE(fs::is_symlink(base_ / "out/a.mp4"));
    EXPECT_EQ(read("real.mp4"), std::string(45, '\0'));
}

// An ffmpeg that ends early closes the pipe: an error with its words, no signal, the older video as it was.
TEST_F(Video, AnFfmpegThatFailsLeavesTheOlderVideo) {
    std::ofstream(base_ / "out/a.mp4") << "precious";
    ffmpegIs("echo first >&2\necho 'no encoder \033[31m' >&2\nexit 3\n");
    struct sigaction before {};
    sigaction(SIGPIPE, nullptr, &before);
    {
        auto writer = create("a.mp4", 1000, 700);
        ASSERT_TRUE(writer);
        const auto added = (*writer)->add(std::vector<std::uint8_t>(2'100'000));
        ASSERT_FALSE(added);
        EXPECT_EQ(added.error().code, ErrorCode::kFailure);
        EXPECT_NE(added.error().message.find("code 3: 'no encoder \\x1b[31m'"), std::string::npos)
            << added.error().message;
        EXPECT_EQ(added.error().message.find('\n'), std::string::npos);
        EXPECT_FALSE((*writer)->add(std::vector<std::uint8_t>(2'100'000)));
    }
    sigset_t pending;
    sigpending(&pending);
    EXPECT_EQ(sigismember(&pending, SIGPIPE), 0);
    struct sigaction after {};
    sigaction(SIGPIPE, nullptr, &after);
    EXPECT_EQ(after.sa_handler, before.sa_handler);
    EXPECT_EQ(read("out/a.mp4"), "precious");
    EXPECT_EQ(filesLeft(), 1U);
}

TEST_F(Video, AnFfmpegThatFailsAtTheEnd) {
    for (const char* body :
         {"cat > \"$out\"\nexit 1\n", "cat > \"$out\"\nkill -9 $$\n", "cat > /dev/null\n"}) {
        ffmpegIs(body);
        auto writer = create();
        ASSERT_TRUE(writer);
        ASSERT_TRUE((*writer)->add(std::vector<std::uint8_t>(45)));
        const auto done = (*writer)->finish();
        ASSERT_FALSE(done) << body;
        EXPECT_EQ(done.error().code, ErrorCode::kFailure);
        writer->reset();
        EXPECT_EQ(filesLeft(), 0U) << body;
    }
}

TEST_F(Video, AnAbandonedVideoLeavesNothing) {
    ffmpegIs("cat > \"$out\"\n");
    {
        auto writer = create();
        ASSERT_TRUE(writer);
        ASSERT_TRUE((*writer)->add(std::vector<std::uint8_t>(45)));
    }
    EXPECT_EQ(filesLeft(), 0U);
}

TEST_F(Video, WithoutFfmpegItIsUnsupported) {
    setenv("PATH", (base_ / "bin").c_str(), 1);
    const auto none = create();
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::kUnsupported);
    EXPECT_NE(none.error().message.find("ffmpeg"), std::string::npos);
    EXPECT_NE(none.error().message.find("install"), std::string::npos);
    EXPECT_EQ(filesLeft(), 0U);
}

TEST_F(Video, WhatCannotBeWrittenIsFoundFirst) {
    ffmpegIs("cat > \"$out\"\n");
    EXPECT_EQ(create("a.avi").error().code, ErrorCode::kUsage);
    EXPECT_EQ(create("mp4").error().code, ErrorCode::kUsage);
    EXPECT_EQ(create("none/a.mp4").error().code, ErrorCode::kIo);
    fs::create_directory(base_ / "out/folder.mp4");
    EXPECT_EQ(create("folder.mp4").error().code, ErrorCode::kIo);
    EXPECT_EQ(create("a.mp4", 0).error().code, ErrorCode::kUsage);
    EXPECT_EQ(create("a.mp4", 5, 70000).error().code, ErrorCode::kUsage);
    EXPECT_EQ(create("a.mp4", 5, 3, 0.0).error().code, ErrorCode::kUsage);
    auto writer = create();
    ASSERT_TRUE(writer);
    EXPECT_EQ((*writer)->add(std::vector<std::uint8_t>(44)).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace relief
