#include "bake/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace relief {
namespace {

constexpr int kBarWidth = 40;  // characters
constexpr auto kFirst = std::chrono::milliseconds(500);
constexpr auto kInterval = std::chrono::milliseconds(100);

}  // namespace

ProgressBar::ProgressBar(std::string label, bool wanted)
    : label_(std::move(label)),
      enabled_(wanted && ::isatty(STDERR_FILENO) == 1),
      next_(std::chrono::steady_clock::now() + kFirst) {}

ProgressBar::~ProgressBar() {
    if (drawn_) {
        std::fputs("\r\033[K", stderr);
    }
}

void ProgressBar::set(double share) {
    const auto now = std::chrono::steady_clock::now();
    if (!enabled_ || now < next_) {
        return;
    }
    next_ = now + kInterval;
    drawn_ = true;
    const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * kBarWidth);
    std::fprintf(stderr, "\r%s [%s%s] %3d %%", label_.c_str(),
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(kBarWidth - filled), '.').c_str(),
                 static_cast<int>(std::clamp(share, 0.0, 1.0) * 100.0));
    std::fflush(stderr);
}

}  // namespace relief
