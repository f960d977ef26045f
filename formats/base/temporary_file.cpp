// SPDX-License-Identifier: Apache-2.0
#include "formats/base/temporary_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <vector>

namespace relief {

namespace fs = std::filesystem;

struct TemporaryFile::Slot {
    std::atomic<bool> taken = false;
    std::atomic<bool> live = false;  ///< the file may exist
    std::array<char, PATH_MAX> name{};

    static std::array<Slot, 32> all;  ///< global, for signal handlers
};
std::array<TemporaryFile::Slot, 32> TemporaryFile::Slot::all;

namespace {

constexpr int kAttempts = 8;

/// Removes a decimal number without leading zeros, and the character `behind` after it, from the start of `text`.
std::optional<std::uint64_t> takeNumber(std::string_view& text, char behind) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const auto length = static_cast<std::size_t>(end - text.data());
    if (error != std::errc() || length == text.size() || *end != behind || (text[0] == '0' && length > 1)) {
        return std::nullopt;
    }
    text.remove_prefix(length + 1);
    return number;
}

/// Returns the process id in a name made by create(); nullopt for other names.
std::optional<pid_t> processOf(std::string_view name) {
    constexpr std::string_view kStart = ".relief-";
    constexpr std::string_view kEnd = ".tmp";
    constexpr std::size_t kRandomDigits = 8;
    if (!name.starts_with(kStart) || !name.ends_with(kEnd)) {
        return std::nullopt;
    }
    name.remove_prefix(kStart.size());
    const std::optional<std::uint64_t> process = takeNumber(name, '-');
    const bool valid = process && *process > 0 && *process <= INT_MAX && takeNumber(name, '-') &&
                       name.size() == kRandomDigits + kEnd.size() &&
                       name.find_first_not_of("0123456789abcdef") == kRandomDigits;
    return valid ? std::optional(static_cast<pid_t>(*process)) : std::nullopt;
}

}  // namespace

TemporaryFile::~TemporaryFile() {
    if (slot_ != nullptr) {
        if (slot_->live.exchange(false)) {
            ::unlink(slot_->name.data());
        }
        slot_->taken = false;
    }
}

int TemporaryFile::create(const fs::path& folder, mode_t mode) {
    const auto slot =
        std::find_if(Slot::all.begin(), Slot::all.end(), [](Slot& one) { return !one.taken.exchange(true); });
    if (slot == Slot::all.end()) {
        return EMFILE;
    }
    slot_ = &*slot;
    // If another machine or container removed the file as a leftover before it was locked, try the next name.
    int code = EAGAIN;
    for (int attempt = 0; code == EAGAIN && attempt < kAttempts; ++attempt) {
        code = createOnce(folder, mode);
    }
    return code;
}

int TemporaryFile::createOnce(const fs::path& folder, mode_t mode) {
    static std::atomic<unsigned> counter = 0;
    unsigned random = 0;  // stays 0 if the system has no random numbers; O_EXCL keeps this safe
    [[maybe_unused]] const ssize_t got = ::getrandom(&random, sizeof(random), GRND_NONBLOCK);
    const int length =
        std::snprintf(slot_->name.data(), slot_->name.size(), "%s/.relief-%ld-%u-%08x.tmp", folder.c_str(),
                      static_cast<long>(::getpid()), counter.fetch_add(1), random);
    if (length < 0 || static_cast<std::size_t>(length) >= slot_->name.size()) {
        return ENAMETOOLONG;
    }
    // Set before the file exists, so that a signal handler always finds it.
    slot_->live = true;
    file_ = Descriptor(openRetry(slot_->name.data(), O_WRONLY | O_CREAT | O_EXCL, mode));
    if (!file_) {
        const int code = errno;
        slot_->live = false;
        return code;
    }
    // Other errors mean that the file system does not support locks.
    const bool held = ::flock(file_.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    struct stat status {};
    return held && (::fstat(file_.get(), &status) != 0 || status.st_nlink > 0) ? 0 : EAGAIN;
}

int TemporaryFile::fill(std::span<const std::byte> bytes, std::optional<mode_t> mode) {
    if (const int code = writeAll(file_.get(), bytes)) {
        return code;
    }
    if (mode && ::fchmod(file_.get(), *mode) != 0) {
        return errno;
    }
    if (const int code = syncToDisk(file_.get())) {
        return code;
    }
    lock_ = Descriptor(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
    return file_.close();
}

int TemporaryFile::renameTo(const fs::path& target) {
    if (::rename(slot_->name.data(), target.c_str()) != 0) {
        return errno;
    }
    slot_->live = false;
    lock_.reset();
    return 0;
}

void TemporaryFile::removeAll() {
    const int before = errno;
    for (const Slot& slot : Slot::all) {
        if (slot.live) {
            ::unlink(slot.name.data());
        }
    }
    errno = before;
}

void TemporaryFile::removeLeftovers(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> left;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::optional<pid_t> process = processOf(entry->path().filename().native());
        if (process && ::kill(*process, 0) != 0 && errno == ESRCH) {
            left.push_back(entry->path());
        }
    }
    for (const fs::path& path : left) {
        const Descriptor file(openRetry(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK));
        struct stat status {};
        if (file && ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode) &&
            status.st_uid == ::geteuid() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) {
            ::unlink(path.c_str());
        }
    }
}

void endCleanlyOnSignals() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        struct sigaction before {};
        if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
            struct sigaction action {};
            action.sa_handler = [](int ending) {
                TemporaryFile::removeAll();
                // SA_RESETHAND has restored the default action, and SA_NODEFER unblocked the signal.
                ::raise(ending);
            };
            action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
            ::sigaction(number, &action, nullptr);
        }
    }
    ::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace relief
