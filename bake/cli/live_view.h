// A page that follows its files: `relief view --serve`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>

#include "bake/cli/view_source.h"
#include "bake/view/page_server.h"
#include "formats/base/result.h"

namespace relief {

class LiveView {
  public:
    explicit LiveView(ViewSource source);

    /// Makes the first page. Fails as makeViewPage does.
    [[nodiscard]] Result<void> start();

    /// The page, made anew if any of its files has changed. While they cannot be read it is the last one that could;
    /// a warning says why, once.
    [[nodiscard]] ServedPage current();

  private:
    /// What tells one state of a file from another: device, inode, size and time of change; zeros if there is none.
    using Stamp = std::tuple<std::uint64_t, std::uint64_t, std::int64_t, std::int64_t>;
    using Stamps = std::map<std::filesystem::path, Stamp>;

    [[nodiscard]] static Stamp stampOf(const std::filesystem::path& path);
    [[nodiscard]] Stamps stampsNow() const;
    [[nodiscard]] Result<void> make(Stamps before);

    ViewSource source_;
    std::uint64_t made_ = 0;  ///< pages
    Stamps stamps_;
    ServedPage page_;
};

}  // namespace relief
