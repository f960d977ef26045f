// A progress bar on standard error, for people: only where that is a terminal.
#pragma once

#include <chrono>
#include <string>

namespace relief {

class ProgressBar {
  public:
    /// \param wanted  false: draws nothing.
    ProgressBar(std::string label, bool wanted);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    /// Wipes the bar off the terminal.
    ~ProgressBar();

    /// \param share  of the work done, in [0, 1]. Draws at most ten times a second, and nothing in the first
    ///               half second: short work shows no bar.
    void set(double share);

  private:
    std::string label_;
    bool enabled_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace relief
