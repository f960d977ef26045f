// A page on this machine alone, and word to every window that shows it when there is another: `relief view --serve`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "formats/base/result.h"

namespace httplib {
class Server;
}

namespace relief {

struct ServedPage {
    std::string version;  ///< digits and letters; another page has another one
    std::shared_ptr<const std::string> html;
};

/// HTTP on 127.0.0.1, for a few windows of one person. Serves `/`, the page, and `/events?page=VERSION`, a stream of
/// server-sent events that carries "data: VERSION" as soon as the page is another one than that.
///
/// No request names a file, so none can leave a folder. Clients that pause for two seconds within a request, lines of a head
/// beyond 8 kB, and ranges are refused. So is a Host that is not this machine's own: no page from elsewhere reads this one by
/// a name that it gave to 127.0.0.1.
class PageServer {
  public:
    /// \param port  0: any that is free.
    /// Errors: kIo (the port is taken or not ours to take).
    [[nodiscard]] static Result<PageServer> listen(std::uint16_t port);
    PageServer(PageServer&&) noexcept;
    ~PageServer();

    /// "http://127.0.0.1:8321/"
    [[nodiscard]] std::string address() const;

    /// Serves until a signal ends the program.
    /// \param current  the page as it is now: called at each load, and five times a second; never twice at once.
    /// Errors: kIo.
    [[nodiscard]] Result<void> serve(const std::function<ServedPage()>& current);

  private:
    PageServer(std::unique_ptr<httplib::Server> server, int port);

    std::unique_ptr<httplib::Server> server_;
    int port_;
};

}  // namespace relief
