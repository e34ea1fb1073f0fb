// SPDX-License-Identifier: GPL-2.0-or-later
// Requests from browsers and their answers, independent of the HTTP library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "clients/screen/http/piece_queue.hh"

namespace mw::screen {

/// Rights of a request; each role includes the rights of the roles before it. STATUS: reads the status and
/// messages of the machine, and may stop it.
enum class Role : std::uint8_t { NOBODY, STATUS, VIEW, OPERATE, CONFIGURE };

/// Protection of a connection.
enum class Protection : std::uint8_t {
    LOCAL,  ///< only on this computer
    TLS,    ///< encrypted, and only with a token
    NONE    ///< as selected at the start of the server
};

/// Rights of one browser.
struct Rights {
    Role role = Role::NOBODY;
    Protection protection = Protection::LOCAL;
};

/// The sender of a request.
struct Requester {
    std::string address;  ///< address of its computer
    Role role = Role::NOBODY;
};

struct Request {
    std::string method;  ///< "GET"
    std::string path;    ///< decoded, without the query
    std::map<std::string, std::string> query;
    std::string body;
    Role role = Role::NOBODY;
    std::string address{};  ///< address of the sender's computer
};

/// A path with its query as in a request; nothing when it is invalid (no leading '/', a broken
/// escape, a control character).
std::optional<Request> parse_target(std::string_view target);

/// A body of known size that is read while it is sent; for each client one piece is in memory.
class BodySource {
  public:
    /// Size of one piece. [bytes]
    static constexpr std::size_t PIECE = 256UL * 1024;

    virtual ~BodySource() = default;
    virtual std::uint64_t size() const = 0;
    /// The next piece; empty if there are no more, or the file can no longer be read. Blocks during disk
    /// access. One thread at a time.
    virtual std::string read() = 0;
};

struct Response {
    int status = 200;
    std::string type = "application/json";
    std::string body{};
    bool isKept = false;  ///< the browser may keep it without asking again, because another content has
                          ///< another name
    std::shared_ptr<PieceQueue> pieces{};  ///< instead of a body
    std::shared_ptr<BodySource> source{};  ///< instead of a body
    std::string cookie{};                  ///< cookie for the browser; empty: none
};

/// Must be called once, in the server's thread.
using Reply = std::function<void(Response)>;

/// A browser's open socket. Never 0, unique.
using SessionId = std::uint64_t;

/// Functions for open sockets. [server's thread]
class Sockets {
  public:
    virtual ~Sockets() = default;
    /// Sends after all earlier data. A browser with too many waiting data is disconnected.
    virtual void send(SessionId session, std::string text) = 0;
    /// True if no data wait to be sent.
    virtual bool isIdle(SessionId session) const = 0;
    virtual void close(SessionId session) = 0;
};

/// The receiver of requests. Never called from within a call to Sockets. [server's thread]
class Application {
  public:
    virtual ~Application() = default;
    virtual void answer(const Request &request, Reply reply) = 0;
    /// Reads the next piece of an answer; `take` is called once, in the server's thread.
    virtual void read(std::shared_ptr<BodySource> source, std::function<void(std::string)> take) {
        take(source->read());
    }
    virtual void opened(SessionId session, Role role, Protection protection) = 0;
    virtual void received(SessionId session, std::string_view text) = 0;
    virtual void closed(SessionId session) = 0;
};

}  // namespace mw::screen
