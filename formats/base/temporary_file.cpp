#include "formats/base/temporary_file.h"

#include <dirent.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <climits>
#include <csignal>
#include <cstdio>
#include <ctime>

#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr int kNamesTried = 100;
constexpr std::string_view kPrefix = ".relief-";
constexpr std::string_view kSuffix = ".tmp";

/// The name of a temporary file, where a signal handler finds it.
struct Slot {
    std::atomic<bool> taken = false;
    std::atomic<bool> live = false;
    std::array<char, PATH_MAX> name{};
};

std::array<Slot, 16> slots;
std::atomic<int> creating = 0;
std::atomic<bool> ending = false;

/// Keeps the thread's signals out of the moment in which a file has come to be and no slot names it.
class SignalsHeld {
  public:
    SignalsHeld() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_BLOCK, &all, &before_);
        creating.fetch_add(1);
        while (ending) {
            creating = 0;
            ::pause();  // another thread is ending the program
        }
    }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;
    ~SignalsHeld() {
        creating.fetch_sub(1);
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t before_{};
};

/// \return the slot's index, −1 if all are taken or the name is too long: the file is removed by other ways.
int takeSlot(const std::string& name) {
    for (std::size_t i = 0; i < slots.size() && name.size() < PATH_MAX; ++i) {
        if (!slots[i].taken.exchange(true)) {
            std::memcpy(slots[i].name.data(), name.c_str(), name.size() + 1);
            slots[i].live = true;
            return static_cast<int>(i);
        }
    }
    return -1;
}

int lockFile(int fd, int how) {
    int result = 0;
    do {
        result = ::flock(fd, how);
    } while (result != 0 && errno == EINTR);
    return result == 0 ? 0 : errno;
}

bool hasName(int fd) {
    struct stat status {};
    return ::fstat(fd, &status) == 0 && status.st_nlink > 0;
}

void removeIfStale(int folder, const char* name) {
    // No device and no pipe is waited for, and no link followed: the name may be anyone's.
    const Descriptor file(::openat(folder, name, O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC | O_NOCTTY));
    struct stat status {};
    if (file && ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode) &&
        lockFile(file.get(), LOCK_EX | LOCK_NB) == 0) {
        ::unlinkat(folder, name, 0);
    }
}

/// True once for each folder: a film of thousands of pictures need not look again before each.
bool isFirstVisit(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<std::string> visited;
    const std::scoped_lock lock(mutex);
    return visited.insert(folder.native()).second;
}

}  // namespace

TemporaryFile::~TemporaryFile() {
    if (!name_.empty()) {
        ::unlink(name_.c_str());
    }
    forget();
}

void TemporaryFile::forget() {
    name_.clear();
    if (slot_ >= 0) {
        Slot& slot = slots[static_cast<std::size_t>(std::exchange(slot_, -1))];
        slot.live = false;
        slot.taken = false;
    }
}

int TemporaryFile::createNamed(const fs::path& name, mode_t mode) {
    const SignalsHeld held;
    file_ = Descriptor(openRetry(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, mode));
    if (!file_) {
        return errno;
    }
    name_ = name;
    slot_ = takeSlot(name.native());
    return 0;
}

int TemporaryFile::create(const fs::path& folder, mode_t mode) {
    if (isFirstVisit(folder)) {
        removeStaleTemporaryFiles(folder);
    }
    static std::atomic<unsigned> counter = 0;
    for (int i = 0; i < kNamesTried; ++i) {
        unsigned random = 0;  // stays 0 where the system has none to give: O_EXCL alone keeps this safe
        [[maybe_unused]] const ssize_t got = ::getrandom(&random, sizeof(random), GRND_NONBLOCK);
        char text[64];
        std::snprintf(text, sizeof(text), "%s%ld-%u-%08x%s", kPrefix.data(), static_cast<long>(::getpid()),
                      counter.fetch_add(1), random, kSuffix.data());
        if (const int code = createNamed(folder / text, mode)) {
            if (code == EEXIST) {
                continue;
            }
            return code;
        }
        lock_ = Descriptor(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
        if (!lock_) {
            return errno;
        }
        // A file system without locks is no error: nobody can lock it there to remove it, either.
        static_cast<void>(lockFile(lock_.get(), LOCK_EX));
        if (hasName(lock_.get())) {
            return 0;
        }
        forget();  // taken for a dead writer's before it was locked
    }
    return EEXIST;
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
    return file_.close();
}

int TemporaryFile::renameTo(const fs::path& target) {
    if (::rename(name_.c_str(), target.c_str()) != 0) {
        return errno;
    }
    forget();
    return 0;
}

void removeTemporaryFiles() {
    const int before = errno;
    ending = true;
    for (int i = 0; i < 1000 && creating > 0; ++i) {
        const timespec moment{0, 1'000'000};
        ::nanosleep(&moment, nullptr);
    }
    for (const Slot& slot : slots) {
        if (slot.live) {
            ::unlink(slot.name.data());
        }
    }
    errno = before;
}

void removeStaleTemporaryFiles(const fs::path& folder) {
    DIR* const listing = ::opendir(folder.c_str());
    if (listing == nullptr) {
        return;
    }
    while (const dirent* entry = ::readdir(listing)) {
        const std::string_view name = entry->d_name;
        if (name.starts_with(kPrefix) && name.ends_with(kSuffix)) {
            removeIfStale(::dirfd(listing), entry->d_name);
        }
    }
    ::closedir(listing);
}

}  // namespace relief
