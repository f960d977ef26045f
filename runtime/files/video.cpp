#include "runtime/files/video.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "formats/base/descriptor.h"
#include "formats/base/destination.h"
#include "formats/base/file_io.h"
#include "formats/base/process.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kEndings{".mp4", ".mkv", ".mov", ".webm"};
constexpr int kNamesTried = 1000;       // of temporary files
constexpr std::size_t kWordsMax = 400;  // bytes of ffmpeg's errors that a message takes

bool knownEnding(const fs::path& path) {
    return std::ranges::find(kEndings, path.extension()) != kEndings.end();
}

/// Writes everything, and never raises SIGPIPE, which belongs to the program that embeds this.
/// \return 0 or an errno.
int writePipe(int fd, std::span<const std::uint8_t> bytes) {
    sigset_t pipe_signal;
    sigset_t old_mask;
    sigset_t pending;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    sigpending(&pending);
    const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &old_mask);
    int code = 0;
    while (!bytes.empty() && code == 0) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        } else if (errno != EINTR) {
            code = errno;
        }
    }
    if (code == EPIPE && !was_pending) {
        const timespec at_once{};
        while (sigtimedwait(&pipe_signal, nullptr, &at_once) < 0 && errno == EINTR) {
        }
    }
    pthread_sigmask(SIG_SETMASK, &old_mask, nullptr);
    return code;
}

/// The last line that ffmpeg printed, which names the cause.
std::string lastWords(std::FILE* errors) {
    std::fseek(errors, 0, SEEK_END);
    const long size = std::ftell(errors);
    const auto length = static_cast<std::size_t>(std::max(0L, std::min<long>(size, kWordsMax)));
    std::string text(length, '\0');
    std::fseek(errors, -static_cast<long>(length), SEEK_END);
    text.resize(std::fread(text.data(), 1, length, errors));
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) {
        text.pop_back();
    }
    text.erase(0, text.find_last_of('\n') + 1);
    return text;
}

}  // namespace

struct VideoWriter::Impl {
    fs::path target;
    fs::path temporary;
    std::size_t frame_bytes = 0;
    Process ffmpeg;
    Descriptor pipe;
    std::FILE* errors = nullptr;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (ffmpeg.running()) {  // abandoned
            ffmpeg.kill(SIGTERM);
            wait();
        }
        if (errors != nullptr) {
            std::fclose(errors);
        }
        removeTemporary();
    }

    void removeTemporary() const {
        if (!temporary.empty()) {
            ::unlink(temporary.c_str());
        }
    }
    /// Closes the pipe, which ends ffmpeg, and waits for that.
    ProcessEnd wait() {
        pipe.reset();
        return ffmpeg.wait();
    }
    [[nodiscard]] tl::unexpected<Error> ffmpegFailed(const ProcessEnd& end) const {
        std::string text = lastWords(errors);
        text = text.empty() ? "" : ": " + quotedPath(text);
        const std::string how = end.signal != 0 ? "was ended by signal " + std::to_string(end.signal)
                                                : "ended with code " + std::to_string(end.exit_code);
        return fail(ErrorCode::kFailure, "ffmpeg could not write " + quotedPath(target) + ": it " + how +
                                             text +
                                             "; write pictures with --frames to see whether they are right");
    }

    /// Makes the temporary file now, so that its name is ours alone and a folder that cannot be written is
    /// found before the run.
    /// \return 0 or an errno, as of the next.
    int reserve(const fs::path& folder) {
        for (int i = 0; i < kNamesTried; ++i) {
            const std::string name = ".relief-" + std::to_string(::getpid()) + "-" + std::to_string(i);
            const fs::path path = folder / (name + target.extension().native());
            if (Descriptor(openRetry(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666))) {
                temporary = path;
                return 0;
            }
            if (errno != EEXIST) {
                return errno;
            }
        }
        return EEXIST;
    }

    int start(const VideoOptions& options) {
        char rate[32];
        std::snprintf(rate, sizeof(rate), "%.6g", options.frames_per_second);
        const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
        // Padded to even sides, which the usual 4:2:0 needs. Bit-exact: no version or date in the file. The
        // protocol is named, or a colon or dash in the name would be read as one.
        ProcessStart start;
        start.program = "ffmpeg";
        start.arguments = {"ffmpeg"};
        const std::string words = "-hide_banner -loglevel error -nostdin -y -f rawvideo -pix_fmt rgb24 -s " +
                                  size + " -r " + rate +
                                  " -i pipe:0 -an -vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -pix_fmt yuv420p "
                                  "-map_metadata -1 -fflags +bitexact -flags:v +bitexact";
        for (const std::string_view word : split(words, ' ')) {
            start.arguments.emplace_back(word);
        }
        start.arguments.push_back("file:" + temporary.native());
        Descriptor frames;
        if (const int code = makePipe(frames, pipe)) {
            return code;
        }
        start.files = {frames.get(), -1, ::fileno(errors)};
        return ffmpeg.start(start);
    }
};

VideoWriter::~VideoWriter() = default;

Result<std::unique_ptr<VideoWriter>> VideoWriter::create(const fs::path& path, const VideoOptions& options) {
    if (options.width == 0 || options.height == 0 || options.width > 65535 || options.height > 65535 ||
        !(options.frames_per_second > 0.0)) {
        return fail(ErrorCode::kUsage, "a video needs sides of 1 to 65535 pixels, and frames to come");
    }
    if (!knownEnding(path)) {
        return fail(ErrorCode::kUsage,
                    quotedPath(path) + " is no name for a video; let it end in .mp4, .mkv, .mov or .webm");
    }
    std::error_code error;
    // The target of a link is replaced, not the link.
    const fs::path followed = fs::is_symlink(path, error) ? destination(path, error) : path;
    const fs::path folder = followed.has_parent_path() ? followed.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + ": there is no folder " +
                                        quotedPath(folder) + "; make it, or choose another place");
    }
    if (fs::is_directory(path, error)) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + ": it is a folder; name a file");
    }
    auto impl = std::make_unique<Impl>();
    impl->target = followed;
    impl->frame_bytes = std::size_t{3} * options.width * options.height;
    impl->errors = std::tmpfile();
    if (impl->errors == nullptr) {
        return fail(ErrorCode::kIo, "cannot make a temporary file: " + std::system_category().message(errno) +
                                        "; free some space");
    }
    if (const int code = impl->reserve(folder)) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(path) + ": " +
                                        std::system_category().message(code) +
                                        "; choose a folder that can be written");
    }
    if (const int code = impl->start(options)) {
        return fail(ErrorCode::kUnsupported,
                    "a video needs the program ffmpeg, which cannot be started from PATH (" +
                        std::system_category().message(code) +
                        "); install it, or write pictures with --frames");
    }
    std::unique_ptr<VideoWriter> writer(new VideoWriter);
    writer->impl_ = std::move(impl);
    return writer;
}

Result<void> VideoWriter::add(std::span<const std::uint8_t> rgb) {
    if (!impl_->ffmpeg.running() || rgb.size() != impl_->frame_bytes) {
        return fail(ErrorCode::kUsage, "a frame of " + std::to_string(rgb.size()) +
                                           " bytes does not fit into a video of " +
                                           std::to_string(impl_->frame_bytes) + " bytes a frame");
    }
    const int code = writePipe(impl_->pipe.get(), rgb);
    if (code == EPIPE) {
        return impl_->ffmpegFailed(impl_->wait());
    }
    if (code != 0) {
        return fail(ErrorCode::kIo, "cannot hand a frame to ffmpeg: " + std::system_category().message(code));
    }
    return {};
}

void VideoWriter::abandon() {
    if (impl_->ffmpeg.running()) {
        impl_->ffmpeg.kill(SIGKILL);  // it would take the pipe's end for the video's
        impl_->wait();
    }
    impl_->removeTemporary();
    impl_->temporary.clear();
}

Result<void> VideoWriter::finish() {
    if (!impl_->ffmpeg.running()) {
        return fail(ErrorCode::kUsage, "a video is finished once");
    }
    const ProcessEnd end = impl_->wait();
    if (end.signal != 0 || end.exit_code != 0) {
        return impl_->ffmpegFailed(end);
    }
    std::error_code error;
    if (const std::uintmax_t size = fs::file_size(impl_->temporary, error); error || size == 0) {
        return fail(ErrorCode::kFailure, "ffmpeg has left no video for " + quotedPath(impl_->target) +
                                             "; try it by hand on the pictures of --frames");
    }
    if (::rename(impl_->temporary.c_str(), impl_->target.c_str()) != 0) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(impl_->target) + ": " +
                                        std::system_category().message(errno) + "; check the folder");
    }
    impl_->temporary.clear();
    return {};
}

}  // namespace relief
