#include "runtime/files/video.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "formats/base/file_io.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kEndings{".mp4", ".mkv", ".mov", ".webm"};
constexpr int kNamesTried = 1000;       // of temporary files
constexpr std::size_t kWordsMax = 400;  // bytes of ffmpeg's errors that a message takes

bool knownEnding(const fs::path& path) {
    for (const char* ending : kEndings) {
        if (path.extension() == ending) {
            return true;
        }
    }
    return false;
}

/// Writes all of it, and never raises SIGPIPE: a program that embeds this has its own idea of that signal.
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

/// The last line that ffmpeg has said: by then it has come to the point.
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

struct Spawn {  // frees what posix_spawn needs
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    Spawn() {
        posix_spawn_file_actions_init(&files);
        posix_spawnattr_init(&attributes);
    }
    ~Spawn() {
        posix_spawn_file_actions_destroy(&files);
        posix_spawnattr_destroy(&attributes);
    }
    Spawn(const Spawn&) = delete;
    Spawn& operator=(const Spawn&) = delete;
};

}  // namespace

struct VideoWriter::Impl {
    fs::path target;
    fs::path temporary;
    std::size_t frame_bytes = 0;
    pid_t process = -1;
    int pipe = -1;
    std::FILE* errors = nullptr;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (process > 0) {  // abandoned
            ::kill(process, SIGTERM);
            wait();
        }
        closePipe();
        if (errors != nullptr) {
            std::fclose(errors);
        }
        removeTemporary();
    }

    void closePipe() {
        if (pipe >= 0) {
            ::close(std::exchange(pipe, -1));
        }
    }
    void removeTemporary() const {
        if (!temporary.empty()) {
            ::unlink(temporary.c_str());
        }
    }
    /// Closes the pipe, which ends ffmpeg, and takes its status.
    int wait() {
        closePipe();
        int status = 0;
        while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
        }
        process = -1;
        return status;
    }
    [[nodiscard]] tl::unexpected<Error> ffmpegFailed(int status) const {
        std::string text = lastWords(errors);
        text = text.empty() ? "" : ": " + quotedPath(text);
        const std::string how = WIFSIGNALED(status)
                                    ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                    : "ended with code " + std::to_string(WEXITSTATUS(status));
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
            const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (file >= 0) {
                ::close(file);
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
        std::vector<std::string> words{"ffmpeg",
                                       "-hide_banner",
                                       "-loglevel",
                                       "error",
                                       "-nostdin",
                                       "-y",
                                       "-f",
                                       "rawvideo",
                                       "-pix_fmt",
                                       "rgb24",
                                       "-s",
                                       size,
                                       "-r",
                                       rate,
                                       "-i",
                                       "pipe:0",
                                       "-an",
                                       "-vf",
                                       "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                       "-pix_fmt",
                                       "yuv420p",
                                       "-map_metadata",
                                       "-1",
                                       "-fflags",
                                       "+bitexact",
                                       "-flags:v",
                                       "+bitexact",
                                       "file:" + temporary.native()};
        std::vector<char*> arguments;
        for (std::string& word : words) {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);

        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            return errno;
        }
        pipe = ends[1];
        Spawn spawn;
        posix_spawn_file_actions_adddup2(&spawn.files, ends[0], STDIN_FILENO);
        posix_spawn_file_actions_addopen(&spawn.files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&spawn.files, ::fileno(errors), STDERR_FILENO);
        sigset_t defaults;
        sigset_t none;
        sigemptyset(&none);
        sigemptyset(&defaults);
        sigaddset(&defaults, SIGPIPE);
        posix_spawnattr_setsigmask(&spawn.attributes, &none);
        posix_spawnattr_setsigdefault(&spawn.attributes, &defaults);
        posix_spawnattr_setflags(&spawn.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        const int code =
            ::posix_spawnp(&process, "ffmpeg", &spawn.files, &spawn.attributes, arguments.data(), environ);
        ::close(ends[0]);
        process = code == 0 ? process : -1;
        return code;
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
    // What a link points to is replaced, and not the link.
    const fs::path followed = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
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
    if (impl_->process < 0 || rgb.size() != impl_->frame_bytes) {
        return fail(ErrorCode::kUsage, "a frame of " + std::to_string(rgb.size()) +
                                           " bytes does not fit into a video of " +
                                           std::to_string(impl_->frame_bytes) + " bytes a frame");
    }
    const int code = writePipe(impl_->pipe, rgb);
    if (code == EPIPE) {
        return impl_->ffmpegFailed(impl_->wait());
    }
    if (code != 0) {
        return fail(ErrorCode::kIo, "cannot hand a frame to ffmpeg: " + std::system_category().message(code));
    }
    return {};
}

void VideoWriter::abandon() {
    if (impl_->process > 0) {
        ::kill(impl_->process, SIGKILL);  // it would take the pipe's end for the video's
        impl_->wait();
    }
    impl_->removeTemporary();
    impl_->temporary.clear();
}

Result<void> VideoWriter::finish() {
    if (impl_->process < 0) {
        return fail(ErrorCode::kUsage, "a video is finished once");
    }
    const int status = impl_->wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return impl_->ffmpegFailed(status);
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
