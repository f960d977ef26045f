// A page on this machine alone, and word to every window that shows it when there is another: `relief view --serve`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "formats/base/descriptor.h"
#include "formats/base/result.h"

namespace relief {

struct ServedPage {
    std::string version;  ///< digits and letters; another page has another one
    std::shared_ptr<const std::string> html;
};

/// HTTP on 127.0.0.1, for a few windows of one person. Serves `/`, the page, and `/events?page=VERSION`, a stream of
/// server-sent events that says "data: VERSION" as soon as the page is another one than that.
///
/// One thread serves all. No request names a file, so none can leave a folder. Requests above 16 KiB and slow ones are
/// dropped, and so is the oldest idle one of 64 connections when another comes. A Host that is not this machine's own
/// is refused, so that no page from elsewhere reads this one by a name that it gave to 127.0.0.1.
class PageServer {
  public:
    /// \param port  0: any that is free.
    /// Errors: kIo (the port is taken or not ours to take).
    [[nodiscard]] static Result<PageServer> listen(std::uint16_t port);

    /// "http://127.0.0.1:8321/"
    [[nodiscard]] std::string address() const;

    /// Serves until a signal ends the program.
    /// \param current  the page as it is now: asked for at each load, and five times a second.
    /// Errors: kIo.
    [[nodiscard]] Result<void> serve(const std::function<ServedPage()>& current);

  private:
    PageServer(Descriptor listener, std::uint16_t port) : listener_(std::move(listener)), port_(port) {}

    Descriptor listener_;
    std::uint16_t port_;
};

}  // namespace relief
