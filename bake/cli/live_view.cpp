#include "bake/cli/live_view.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <exception>
#include <string>

namespace relief {

LiveView::LiveView(ViewSource source) : source_(std::move(source)) {}

LiveView::Stamp LiveView::stampOf(const std::filesystem::path& path) {
    struct stat s {};
    if (::stat(path.c_str(), &s) != 0) {
        return {};
    }
    return {s.st_dev, s.st_ino, s.st_size,
            std::int64_t{s.st_mtim.tv_sec} * 1'000'000'000 + s.st_mtim.tv_nsec};
}

LiveView::Stamps LiveView::stampsNow() const {
    Stamps now;
    for (const auto& [path, stamp] : stamps_) {
        now[path] = stampOf(path);
    }
    return now;
}

Result<void> LiveView::make(Stamps before) {
    // Another process has other versions, so that a window that outlives this one loads the next one's page.
    const std::string version = std::to_string(::getpid()) + "x" + std::to_string(made_ + 1);
    ViewSource source = source_;
    source.events = "/events?page=" + version;
    MadePage page = RELIEF_TRY(makeViewPage(source));
    ++made_;
    stamps_.clear();
    for (const std::filesystem::path& file : page.files) {
        // As it was before it was read: what has changed since then counts as changed.
        const auto known = before.find(file);
        stamps_[file] = known != before.end() ? known->second : stampOf(file);
    }
    page_ = {version, std::make_shared<const std::string>(std::move(page.html))};
    return {};
}

Result<void> LiveView::start() {
    const std::filesystem::path file = source_.file;
    return make({{file, stampOf(file)}});
}

ServedPage LiveView::current() {
    Stamps now = stampsNow();
    if (now == stamps_) {
        return page_;
    }
    stamps_ = now;  // a failure is told once
    std::string failure;
    try {
        const Result<void> made = make(std::move(now));
        failure = made ? "" : made.error().message;
    } catch (const std::exception& error) {  // no memory, for one; nobody above this thread could tell
        failure = error.what();
    }
    if (!failure.empty()) {
        spdlog::warn("{}; the page stays as it was", failure);
    } else {
        spdlog::info("made anew");
    }
    return page_;
}

}  // namespace relief
