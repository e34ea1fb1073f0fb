// SPDX-License-Identifier: GPL-2.0-or-later
// A server, its requests, and browsers that connect over a loopback socket, byte by byte.
#pragma once

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "clients/screen/server/server.hh"

namespace mw::screen::test {

using std::chrono::milliseconds;

/// Answers with the request; a socket receives its own texts.
class Echo final : public Application {
  public:
    void answer(const Request &request, Reply reply) override {
        asked.push_back(request);
        if (pieces != nullptr) {
            reply({.pieces = pieces});
        } else if (make_source) {
            reply({.source = make_source()});
        } else if (!body.empty()) {
            reply({.body = body});
        } else if (is_later) {
            later = std::move(reply);
        } else {
            reply({.type = "text/plain", .body = request.method + ' ' + request.path + '|' + request.body});
        }
    }
    void read(std::shared_ptr<BodySource> source, std::function<void(std::string)> take) override {
        take(source->read());
    }
    void opened(SessionId session, Role role, Protection protection) override {
        open.push_back(session);
        rights.push_back({role, protection});
    }
    void received(SessionId session, std::string_view text) override {
        texts.emplace_back(text);
        server->send(session, std::string(text));
    }
    void closed(SessionId session) override { ended.push_back(session); }

    Server *server = nullptr;
    std::vector<Request> asked;
    std::vector<SessionId> open, ended;
    std::vector<std::string> texts;
    std::vector<Rights> rights;
    std::shared_ptr<PieceQueue> pieces;
    std::function<std::shared_ptr<BodySource>()> make_source;
    std::string body;
    bool is_later = false;
    Reply later;
};

/// Counts the bytes read from it.
class LargeFile final : public BodySource {
  public:
    LargeFile(std::uint64_t size, std::uint64_t &read) : size_(size), left_(size), read_(read) {}
    std::uint64_t size() const override { return size_; }
    std::string read() override {
        const std::uint64_t count = std::min<std::uint64_t>(left_, PIECE);
        left_ -= count;
        read_ += count;
        return std::string(count, 'x');
    }

  private:
    std::uint64_t size_, left_;
    std::uint64_t &read_;
};

/// One connection of a browser, byte by byte.
class Peer {
  public:
    explicit Peer(int port, std::uint32_t address = INADDR_LOOPBACK)
        : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(static_cast<std::uint16_t>(port));
        place.sin_addr.s_addr = htonl(address);
        static_cast<void>(::connect(fd_, reinterpret_cast<sockaddr *>(&place), sizeof place));
    }
    ~Peer() { ::close(fd_); }
    Peer(const Peer &) = delete;
    Peer &operator=(const Peer &) = delete;

    /// Writes as much as possible; false if the peer has disconnected.
    bool write(std::string &bytes) const {
        const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        bytes.erase(0, sent > 0 ? static_cast<std::size_t>(sent) : 0);
        return sent >= 0 || errno == EAGAIN || errno == ENOTCONN || errno == EINPROGRESS;
    }
    /// Reads the available bytes.
    void read() {
        char bytes[65536];
        ssize_t got = 0;
        while ((got = ::recv(fd_, bytes, sizeof bytes, 0)) > 0) {
            received.append(bytes, static_cast<std::size_t>(got));
        }
        isClosed = isClosed || got == 0 || (errno != EAGAIN && errno != ENOTCONN);
    }

    std::string received;
    bool isClosed = false;

  private:
    int fd_;
};

class ServerTest : public testing::Test {
  protected:
    void listen(const ServerLimits &limits = {}) { listen(ServerOptions{.port = 0, .limits = limits}); }
    void listen(const ServerOptions &options) {
        auto made = Server::listen(options);
        ASSERT_TRUE(made.has_value()) << made.error().str();
        server = std::move(*made);
        echo.server = server.get();
    }
    bool run_until(const std::function<bool()> &isDone) {
        for (int i = 0; i < 5000 && !isDone(); ++i) {
            server->run_for(echo, milliseconds(1));
        }
        return isDone();
    }
    /// The server registers sockets slightly after their peers have received its answer.
    bool areOpened(std::size_t count) {
        return run_until([&] { return echo.open.size() == count; });
    }
    std::string host() const { return "Host: 127.0.0.1:" + std::to_string(server->port()) + "\r\n"; }
    void write(Peer &peer, std::string bytes) {
        run_until([&] { return !peer.write(bytes) || bytes.empty(); });
    }
    /// The bytes of the answer until they contain `end` or the connection closes.
    std::string ask(Peer &peer, const std::string &bytes, const std::string &end) {
        peer.received.clear();
        write(peer, bytes);
        run_until([&] {
            peer.read();
            return peer.isClosed || (!end.empty() && peer.received.find(end) != std::string::npos);
        });
        return peer.received;
    }
    /// The first line of the answer, on a separate connection.
    std::string status_of(const std::string &bytes) {
        Peer peer(server->port());
        const std::string answer = ask(peer, bytes, "\r\n\r\n");
        return answer.substr(0, answer.find('\r'));
    }
    std::string get(const std::string &path, const std::string &more = "") const {
        return "GET " + path + " HTTP/1.1\r\n" + host() + more + "Connection: close\r\n\r\n";
    }
    std::string upgrade(const std::string &path = "/api/socket", const std::string &more = "") const {
        return "GET " + path + " HTTP/1.1\r\n" + host() + more +
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    }
    /// A masked frame of a browser.
    static std::string frame(const std::string &text, unsigned char opcode = 0x81) {
        std::string bytes(1, static_cast<char>(opcode));
        if (text.size() < 126) {
            bytes += static_cast<char>(0x80 | text.size());
        } else {
            bytes += static_cast<char>(0x80 | 127);
            for (int shift = 56; shift >= 0; shift -= 8) {
                bytes += static_cast<char>(text.size() >> shift & 0xff);
            }
        }
        const std::string mask = "\x11\x22\x33\x44";
        bytes += mask;
        for (std::size_t i = 0; i < text.size(); ++i) {
            bytes += static_cast<char>(text[i] ^ mask[i % 4]);
        }
        return bytes;
    }

    std::unique_ptr<Server> server;
    Echo echo;  ///< may hold a reply, which ends before the server
};

}  // namespace mw::screen::test
