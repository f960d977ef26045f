#include "bake/view/page_server.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kThreads = 64;  // a window's stream holds one
constexpr std::size_t kStreamsMax = 32;
constexpr milliseconds kLook{200};  // from one look at the files to the next
constexpr int kHeadSeconds = 2;     // for a request to arrive
constexpr int kStallSeconds = 20;   // for a client to take more of an answer
constexpr const char* kHost = "127.0.0.1";

/// With any port: it may have been forwarded.
bool isThisMachine(const std::string& host) {
    const std::string name = lowerCase(host.substr(0, host.rfind(':')));
    return name == kHost || name == "localhost";
}

/// The page for all threads.
class Service {
  public:
    explicit Service(const std::function<ServedPage()>& current) : current_(current), page_(current()) {}

    void addTo(httplib::Server& server) {
        server.Get("/", [this](const httplib::Request&, httplib::Response& response) { load(response); });
        server.Get("/events", [this](const httplib::Request& request, httplib::Response& response) {
            stream(request.get_param_value("page"), response);
        });
        // Browsers complain without it.
        server.Get("/favicon.ico",
                   [](const httplib::Request&, httplib::Response& response) { response.status = 204; });
    }

    void look() {
        const std::scoped_lock lock(mutex_);
        page_ = current_();
        changed_.notify_all();
    }

  private:
    /// By a provider, since a body would be compressed, which takes longer than to send it.
    void load(httplib::Response& response) {
        look();
        const std::scoped_lock lock(mutex_);
        response.set_content_provider(
            page_.html->size(), "text/html; charset=utf-8",
            [html = page_.html](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                return offset < html->size() &&
                       sink.write(html->data() + offset, std::min(length, html->size() - offset));
            });
    }

    void stream(std::string shown, httplib::Response& response) {
        const std::scoped_lock lock(mutex_);
        if (streams_ >= kStreamsMax) {
            response.status = 503;
            return;
        }
        ++streams_;
        shown = shown.empty() ? page_.version : shown;
        response.set_content_provider(
            "text/event-stream",
            [this, shown](std::size_t offset, httplib::DataSink& sink) mutable {
                const std::string text = offset == 0 ? "retry: 1000\n\n" : nextEvent(shown);
                return text.empty() ? sink.is_writable() : sink.write(text.data(), text.size());
            },
            [this](bool) {
                const std::scoped_lock ended(mutex_);
                --streams_;
            });
    }

    /// Waits for a while for another page than is shown; "" if there is none.
    std::string nextEvent(std::string& shown) {
        std::unique_lock lock(mutex_);
        if (!changed_.wait_for(lock, 2 * kLook, [&] { return page_.version != shown; })) {
            return "";
        }
        shown = page_.version;
        return "data: " + shown + "\n\n";
    }

    const std::function<ServedPage()>& current_;
    std::mutex mutex_;
    std::condition_variable changed_;
    ServedPage page_;
    std::size_t streams_ = 0;
};

httplib::Server::HandlerResponse refuse(const httplib::Request& request, httplib::Response& response) {
    if (!isThisMachine(request.get_header_value("Host"))) {
        response.status = 403;
    } else if (request.method != "GET" && request.method != "HEAD") {
        response.status = 405;
    } else if (!request.ranges.empty()) {
        response.status =
            416;  // this version of the library does not hold ranges against the size of the page
    } else {
        return httplib::Server::HandlerResponse::Unhandled;
    }
    return httplib::Server::HandlerResponse::Handled;
}

}  // namespace

PageServer::PageServer(std::unique_ptr<httplib::Server> server, int port)
    : server_(std::move(server)), port_(port) {}
PageServer::PageServer(PageServer&&) noexcept = default;
PageServer::~PageServer() = default;

Result<PageServer> PageServer::listen(std::uint16_t port) {
    auto server = std::make_unique<httplib::Server>();
    server->new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    // Else a port is not to be had for a minute after a server with open windows has ended. The library's own options let
    // two programs share a port.
    server->set_socket_options([](socket_t socket) {
        const int on = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    });
    server->set_keep_alive_max_count(1);
    server->set_keep_alive_timeout(kHeadSeconds);
    server->set_read_timeout(kHeadSeconds);
    server->set_write_timeout(kStallSeconds);
    server->set_default_headers({{"Cache-Control", "no-store"}, {"X-Content-Type-Options", "nosniff"}});
    server->set_pre_routing_handler(refuse);
    const int bound = port == 0                           ? server->bind_to_any_port(kHost)
                      : server->bind_to_port(kHost, port) ? int{port}
                                                          : -1;
    if (bound < 0) {
        const std::string name = port == 0 ? "any port" : "port " + std::to_string(port);
        return fail(ErrorCode::kIo,
                    "cannot serve on " + name + " of " + kHost +
                        ", which is taken or needs rights; name another with --serve PORT, or 0 "
                        "for any that is free");
    }
    return PageServer(std::move(server), bound);
}

std::string PageServer::address() const {
    return std::string("http://") + kHost + ":" + std::to_string(port_) + "/";
}

Result<void> PageServer::serve(const std::function<ServedPage()>& current) {
    try {
        Service service(current);
        service.addTo(*server_);
        const std::jthread watcher([&service](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
                std::this_thread::sleep_for(kLook);
                service.look();
            }
        });
        server_->listen_after_bind();
    } catch (const std::exception& error) {
        return fail(ErrorCode::kIo, std::string("cannot serve: ") + error.what());
    }
    return fail(ErrorCode::kIo, "cannot wait for connections any more");
}

}  // namespace relief
