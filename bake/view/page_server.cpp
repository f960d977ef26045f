#include "bake/view/page_server.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <list>
#include <string_view>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kConnectionsMax = 64;
constexpr std::size_t kStreamsMax = 32;
constexpr std::size_t kHeadMax = std::size_t{16} << 10;
constexpr std::size_t kStreamBacklogMax = std::size_t{64} << 10;
constexpr milliseconds kLook{200};  ///< from one look at the files to the next
constexpr seconds kHeadTime{5};     ///< for a request to arrive
constexpr seconds kStallTime{20};   ///< for a client to take more of an answer
constexpr seconds kDrainTime{2};    ///< for a client to close, once it has been answered
constexpr seconds kHeartbeat{15};   ///< tells windows that are gone from windows that wait

enum class Stage : std::uint8_t { kRequest, kAnswer, kStream, kDrain, kDone };

struct Connection {
    Descriptor socket;
    Stage stage = Stage::kRequest;
    std::string request;
    bool head_only = false;
    std::string text;                         ///< to be sent: a head, or events
    std::shared_ptr<const std::string> body;  ///< to be sent after it
    std::size_t sent = 0;                     ///< of both
    std::string version;                      ///< that a stream's window shows
    Clock::time_point deadline;

    [[nodiscard]] std::size_t size() const { return text.size() + (body ? body->size() : 0); }
    [[nodiscard]] bool sends() const {
        return (stage == Stage::kAnswer || stage == Stage::kStream) && sent < size();
    }
    /// For poll(). Nothing is read while an answer is under way: a client may have closed its own half.
    [[nodiscard]] short wants() const {
        return static_cast<short>((stage == Stage::kAnswer ? 0 : POLLIN) | (sends() ? POLLOUT : 0));
    }
};

/// What the head of a request says, as far as anything here depends on it.
struct Request {
    std::string_view method;
    std::string_view path;
    std::string_view query;
    std::string host;
};

/// \param head  up to the empty line.
Request parseRequest(std::string_view head) {
    Request request;
    std::string_view line = trimmed(takeLine(head));
    request.method = takeWord(line);
    request.path = takeWord(line);
    if (const std::size_t mark = request.path.find('?'); mark != std::string_view::npos) {
        request.query = request.path.substr(mark + 1);
        request.path = request.path.substr(0, mark);
    }
    while (!head.empty()) {
        line = takeLine(head);
        const std::size_t colon = line.find(':');
        if (colon != std::string_view::npos && lowerCase(line.substr(0, colon)) == "host") {
            request.host = lowerCase(trimmed(line.substr(colon + 1)));
        }
    }
    return request;
}

/// With any port: it may have been forwarded.
bool isThisMachine(std::string_view host) {
    const std::size_t colon = host.rfind(':');
    const std::string_view name = host.substr(0, colon);
    return name == "127.0.0.1" || name == "localhost";
}

class Service {
  public:
    Service(int listener, const std::function<ServedPage()>& current)
        : listener_(listener), current_(current), page_(current()) {}

    Result<void> run() {
        for (;;) {
            std::vector<pollfd> polled{{listener_, POLLIN, 0}};
            for (const Connection& c : connections_) {
                polled.push_back({c.socket.get(), c.wants(), 0});
            }
            if (::poll(polled.data(), polled.size(), static_cast<int>(kLook.count())) < 0 && errno != EINTR) {
                return fail(ErrorCode::kIo,
                            std::string("cannot wait for connections: ") + std::strerror(errno));
            }
            std::size_t i = 1;
            for (Connection& c : connections_) {
                attend(c, polled[i++].revents);
            }
            if ((polled[0].revents & POLLIN) != 0) {
                accept();
            }
            look();
            connections_.remove_if([](const Connection& c) { return c.stage == Stage::kDone; });
        }
    }

  private:
    void accept() {
        Descriptor socket(::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!socket || (connections_.size() >= kConnectionsMax && !makeRoom())) {
            return;
        }
        connections_.emplace_back();
        connections_.back().socket = std::move(socket);
        connections_.back().deadline = Clock::now() + kHeadTime;
    }

    /// Drops the oldest connection that has not asked for anything, or has been answered.
    bool makeRoom() {
        const auto oldest = std::find_if(connections_.begin(), connections_.end(), [](const Connection& c) {
            return c.stage != Stage::kAnswer && c.stage != Stage::kStream;
        });
        if (oldest == connections_.end()) {
            return false;
        }
        connections_.erase(oldest);
        return true;
    }

    void attend(Connection& c, short events) {
        if ((events & (POLLHUP | POLLERR)) != 0) {
            c.stage = Stage::kDone;
            return;
        }
        if ((events & POLLIN) != 0) {
            receive(c);
        }
        if ((events & POLLOUT) != 0 && c.sends()) {
            send(c);
        }
        if (c.stage != Stage::kStream && Clock::now() > c.deadline) {
            c.stage = Stage::kDone;
        }
    }

    void receive(Connection& c) {
        char buffer[4096];
        const ssize_t count = ::recv(c.socket.get(), buffer, sizeof(buffer), 0);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
            return;
        }
        if (count <= 0) {
            c.stage = Stage::kDone;
            return;
        }
        if (c.stage != Stage::kRequest) {
            return;  // whatever else it says is not read
        }
        c.request.append(buffer, static_cast<std::size_t>(count));
        if (const std::size_t end = c.request.find("\r\n\r\n"); end != std::string::npos) {
            answer(c, parseRequest(std::string_view(c.request).substr(0, end)));
        } else if (c.request.size() > kHeadMax) {
            reply(c, "431 Request Header Fields Too Large");
        }
    }

    void answer(Connection& c, const Request& request) {
        if (!isThisMachine(request.host)) {
            reply(c, "403 Forbidden");
        } else if (request.method != "GET" && request.method != "HEAD") {
            reply(c, "405 Method Not Allowed");
        } else if (request.path == "/events" && request.method == "GET") {
            stream(c, request.query);
        } else if (request.path == "/favicon.ico") {
            reply(c, "204 No Content");  // browsers ask for it, and complain without
        } else if (request.path == "/") {
            update();
            c.head_only = request.method == "HEAD";
            reply(c, "200 OK", page_.html);
        } else {
            reply(c, "404 Not Found");
        }
    }

    static void reply(Connection& c, const std::string& status,
                      std::shared_ptr<const std::string> body = std::make_shared<std::string>()) {
        c.text =
            "HTTP/1.1 " + status +
            "\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: " + std::to_string(body->size()) +
            "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
        c.body = c.head_only ? nullptr : std::move(body);
        c.stage = Stage::kAnswer;
        c.deadline = Clock::now() + kStallTime;
        send(c);
    }

    void stream(Connection& c, std::string_view query) {
        std::size_t streams = 0;
        for (const Connection& other : connections_) {
            streams += other.stage == Stage::kStream ? 1 : 0;
        }
        if (streams >= kStreamsMax) {
            reply(c, "503 Service Unavailable");
            return;
        }
        c.version = query.starts_with("page=") ? query.substr(5) : std::string_view(page_.version);
        c.text =
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n"
            "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\nretry: 1000\n\n";
        c.stage = Stage::kStream;
        c.deadline = Clock::now() + kHeartbeat;
        send(c);
        tell(c);
    }

    /// Tells a window that it shows an older page.
    void tell(Connection& c) {
        if (c.stage == Stage::kStream && c.version != page_.version) {
            c.version = page_.version;
            c.text += "data: " + page_.version + "\n\n";
            send(c);
        }
    }

    static void send(Connection& c) {
        while (c.sent < c.size()) {
            const std::string& part = c.sent < c.text.size() ? c.text : *c.body;
            const std::size_t from = c.sent < c.text.size() ? c.sent : c.sent - c.text.size();
            const ssize_t count =
                ::send(c.socket.get(), part.data() + from, part.size() - from, MSG_NOSIGNAL);
            if (count < 0 && errno == EINTR) {
                continue;
            }
            if (count < 0) {
                c.stage = errno == EAGAIN ? c.stage : Stage::kDone;
                return;
            }
            c.sent += static_cast<std::size_t>(count);
            if (c.stage == Stage::kAnswer) {
                c.deadline = Clock::now() + kStallTime;
            }
        }
        if (c.stage == Stage::kStream) {
            c.text.clear();
            c.sent = 0;
        } else {
            // To close at once, with words of the client unread, would take the answer back.
            ::shutdown(c.socket.get(), SHUT_WR);
            c.stage = Stage::kDrain;
            c.body = nullptr;
            c.deadline = Clock::now() + kDrainTime;
        }
    }

    void update() {
        page_ = current_();
        looked_ = Clock::now();
    }

    /// At the files, now and then; and whom to tell of it.
    void look() {
        if (Clock::now() - looked_ >= kLook) {
            update();
        }
        for (Connection& c : connections_) {
            tell(c);
            if (c.stage == Stage::kStream && Clock::now() > c.deadline) {
                c.deadline = Clock::now() + kHeartbeat;
                c.text += ":\n\n";
                send(c);
            }
            if (c.stage == Stage::kStream && c.text.size() > kStreamBacklogMax) {
                c.stage = Stage::kDone;
            }
        }
    }

    int listener_;
    const std::function<ServedPage()>& current_;
    ServedPage page_;
    Clock::time_point looked_ = Clock::now();
    std::list<Connection> connections_;
};

}  // namespace

Result<PageServer> PageServer::listen(std::uint16_t port) {
    const auto cannot = [port] {
        const std::string name = port == 0 ? "any port" : "port " + std::to_string(port);
        return fail(ErrorCode::kIo, "cannot serve on " + name + " of 127.0.0.1: " + std::strerror(errno) +
                                        "; name another with --serve PORT, or 0 for any that is free");
    };
    Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!listener) {
        return cannot();
    }
    // Else a port is not to be had for a minute after a server with open windows has ended.
    const int on = 1;
    ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener.get(), generic, size) != 0 || ::listen(listener.get(), 64) != 0 ||
        ::getsockname(listener.get(), generic, &size) != 0) {
        return cannot();
    }
    return PageServer(std::move(listener), ntohs(address.sin_port));
}

std::string PageServer::address() const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/";
}

Result<void> PageServer::serve(const std::function<ServedPage()>& current) {
    return Service(listener_.get(), current).run();
}

}  // namespace relief
