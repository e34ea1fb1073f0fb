// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the port for other computers, over real sockets: TLS, tokens, names, and reserves for this computer
// (J3).
#include <arpa/inet.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "clients/screen/server/server.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

const std::string VIEW(64, 'a'), OPERATE(64, 'b');

/// Answers with the request and its role.
class Ear final : public Application {
  public:
    void answer(const Request &request, Reply reply) override {
        reply({.type = "text/plain", .body = request.path + " by " + std::string(role_name(request.role))});
    }
    void opened(SessionId, Role role, Protection protection) override { open.push_back({role, protection}); }
    void received(SessionId session, std::string_view text) override {
        server->send(session, std::string(text));
    }
    void closed(SessionId) override {}

    Server *server = nullptr;
    std::vector<Rights> open;
};

/// A blocking client, for a separate thread.
class Caller {
  public:
    Caller(int port, bool has_tls) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(static_cast<std::uint16_t>(port));
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        timeval patience{10, 0};
        ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        up_ = ::connect(fd_, reinterpret_cast<sockaddr *>(&place), sizeof place) == 0;
        if (up_ && has_tls) {
            context_ = SSL_CTX_new(TLS_client_method());
            tls_ = SSL_new(context_);
            SSL_set_fd(tls_, fd_);
            up_ = SSL_connect(tls_) == 1;
        }
    }
    ~Caller() {
        SSL_free(tls_);
        SSL_CTX_free(context_);
        ::close(fd_);
    }
    Caller(const Caller &) = delete;
    Caller &operator=(const Caller &) = delete;

    bool isUp() const { return up_; }
    std::string ask(const std::string &bytes, const std::string &end) {
        if (!up_) {
            return "";
        }
        const int size = static_cast<int>(bytes.size());
        const bool sent = tls_ != nullptr ? SSL_write(tls_, bytes.data(), size) == size
                                          : ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == size;
        std::string answer;
        char some[4096];
        while (sent && answer.find(end) == std::string::npos) {
            const auto got =
                tls_ != nullptr ? SSL_read(tls_, some, sizeof some) : ::recv(fd_, some, sizeof some, 0);
            if (got <= 0) {
                break;
            }
            answer.append(some, static_cast<std::size_t>(got));
        }
        return answer;
    }

  private:
    int fd_;
    SSL_CTX *context_ = nullptr;
    SSL *tls_ = nullptr;
    bool up_ = false;
};

class RemoteTest : public testing::Test {
  protected:
    void listen(bool has_tls, const ServerLimits &limits = {}) {
        hasTls_ = has_tls;
        RemoteDoor door{"127.0.0.1", 0, {"mill"}, Access(Protection::NONE, Role::OPERATE), {}};
        if (has_tls) {
            folder = fs::temp_directory_path() / ("mw_remote_" + std::to_string(::getpid()));
            auto certificate = read_or_make_certificate(folder.string(), {"127.0.0.1"});
            ASSERT_TRUE(certificate.has_value()) << certificate.error().str();
            door.tls = std::move(*certificate);
            door.access = Access(Tokens({{Role::VIEW, VIEW}, {Role::OPERATE, OPERATE}}));
        }
        auto made = Server::listen({.port = 0, .limits = limits, .remote = std::move(door)});
        ASSERT_TRUE(made.has_value()) << made.error().str();
        server = std::move(*made);
        ear.server = server.get();
    }
    ~RemoteTest() override {
        if (!folder.empty()) {
            fs::remove_all(folder);
        }
    }
    /// `call` in a separate thread, while the server runs.
    void with_server(const std::function<void()> &call) {
        std::atomic<bool> isDone{false};
        std::thread caller([&] {
            call();
            isDone = true;
        });
        while (!isDone) {
            server->run_for(ear, std::chrono::milliseconds(5));
        }
        caller.join();
    }
    /// The status and the body of one request.
    std::string ask(const std::string &path, const std::string &more, const std::string &host = "127.0.0.1") {
        std::string answer;
        with_server([&] {
            Caller caller(server->remote_port(), hasTls_);
            answer = caller.ask("GET " + path + " HTTP/1.1\r\nHost: " + host + ":" +
                                    std::to_string(server->remote_port()) + "\r\n" + more +
                                    "Connection: close\r\n\r\n",
                                "never");
        });
        return answer.empty() ? "" : answer.substr(9, 3) + answer.substr(answer.find("\r\n\r\n") + 3);
    }
    static std::string bearer(const std::string &secret) {
        return "Authorization: Bearer " + secret + "\r\n";
    }

    fs::path folder;
    std::unique_ptr<Server> server;
    Ear ear;
    bool hasTls_ = true;
};

TEST_F(RemoteTest, OnlyATokenOpensIt) {
    listen(true);
    EXPECT_EQ(ask("/api/machine", bearer(VIEW)), "200\n/api/machine by view");
    EXPECT_EQ(ask("/api/machine", bearer(OPERATE)), "200\n/api/machine by operate");
    const std::string cookie =
        "Cookie: millwright_token_" + std::to_string(server->remote_port()) + "=" + VIEW + "\r\n";
    EXPECT_EQ(ask("/api/machine", cookie), "200\n/api/machine by view");
    for (const char *path : {"/api/machine", "/api/socket", "/api/files/x", "/metrics"}) {
        EXPECT_EQ(ask(path, "").substr(0, 3), "401") << path;
        EXPECT_EQ(ask(path, bearer("wrong")).substr(0, 3), "401") << path;
    }
    EXPECT_EQ(ask("/", ""), "200\n/ by ");  // the screen, which asks for the token
    EXPECT_EQ(ask("/api/login", ""), "200\n{\"role\":\"\",\"protection\":\"tls\"}");
}

TEST_F(RemoteTest, WithoutATokenOnlyThePageAndTheLoginAreThere) {
    listen(true);
    for (const char *path : {"/", "/api/login"}) {
        EXPECT_EQ(ask(path, "").find("401"), std::string::npos) << path;
    }
    for (const char *path : {"/metrics", "/api/machine", "/api/schema", "/api/tools", "/api/files",
                             "/api/files/a.ngc", "/api/path?file=a.ngc", "/api/offsets", "/api/preferences",
                             "/api/mdi_history", "/api/icon", "/api/hal", "/api/hal/x", "/api/scope",
                             "/api/scope/record", "/api/questions", "/api/socket", "/api/nothing"}) {
        EXPECT_NE(ask(path, "").find("401"), std::string::npos) << path;
        EXPECT_NE(ask(path, "Authorization: Bearer 0123456789abcdef0123456789abcdef\r\n").find("401"),
                  std::string::npos)
            << path;
    }
}

TEST_F(RemoteTest, OtherNamesAndOtherSitesReachNothing) {
    listen(true);
    const std::string port = std::to_string(server->remote_port());
    EXPECT_EQ(ask("/api/machine", bearer(VIEW), "mill").substr(0, 3), "200");
    EXPECT_EQ(ask("/api/machine", bearer(VIEW), "MILL").substr(0, 3), "200");
    EXPECT_EQ(ask("/api/machine", bearer(VIEW) + "Origin: https://mill:" + port + "\r\n").substr(0, 3),
              "200");
    for (const char *host : {"evil.example", "mill.evil.example", "127.0.0.11", "localhost"}) {
        EXPECT_EQ(ask("/api/machine", bearer(VIEW), host).substr(0, 3), "403") << host;
    }
    for (const std::string &origin :
         {"http://mill:" + port, std::string("https://evil.example"), std::string("null")}) {
        EXPECT_EQ(ask("/api/machine", bearer(VIEW) + "Origin: " + origin + "\r\n").substr(0, 3), "403")
            << origin;
    }
    EXPECT_EQ(ask("/api/login", "Sec-Fetch-Site: cross-site\r\n").substr(0, 3), "403");
}

TEST_F(RemoteTest, ASocketIsOpenedWithItsRole) {
    listen(true);
    const std::string head =
        "GET /api/socket HTTP/1.1\r\nHost: mill:" + std::to_string(server->remote_port()) +
        "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    std::string refused, taken, echoed;
    with_server([&] {
        Caller without(server->remote_port(), true), with(server->remote_port(), true);
        refused = without.ask(head + "\r\n", "\r\n\r\n");
        taken = with.ask(head + bearer(VIEW) + "\r\n", "\r\n\r\n");
        const std::string hello =
            std::string("\x81\x85\x11\x22\x33\x44") + "\x79\x47\x5f\x28\x7e";  // "hello", masked
        echoed = with.ask(hello, "hello");
    });
    EXPECT_TRUE(refused.starts_with("HTTP/1.1 401")) << refused;
    EXPECT_TRUE(taken.starts_with("HTTP/1.1 101")) << taken;
    EXPECT_EQ(echoed, "\x81\x05hello");
    ASSERT_EQ(ear.open.size(), 1U);
    EXPECT_EQ(ear.open[0].role, Role::VIEW);
    EXPECT_EQ(ear.open[0].protection, Protection::TLS);
}

TEST_F(RemoteTest, WhoSpeaksNoTlsGetsNothing) {
    listen(true);
    std::string answer = "something";
    with_server([&] {
        Caller caller(server->remote_port(), false);
        answer = caller.ask("GET / HTTP/1.1\r\nHost: mill\r\n\r\n", "\r\n\r\n");
    });
    EXPECT_EQ(answer.find("HTTP/"), std::string::npos);
    EXPECT_EQ(ask("/api/machine", bearer(VIEW)).substr(0, 3), "200");
}

TEST_F(RemoteTest, WithoutProtectionEverybodyHasTheRoleThatWasChosen) {
    listen(false);
    EXPECT_EQ(ask("/api/machine", ""), "200\n/api/machine by operate");
    EXPECT_EQ(ask("/api/login", ""), "200\n{\"role\":\"operate\",\"protection\":\"none\"}");
    EXPECT_EQ(ask("/api/machine", "", "evil.example").substr(0, 3), "403");
}

TEST_F(RemoteTest, OthersCannotTakeTheLastPlacesOfThisComputer) {
    ServerLimits limits;
    limits.connections = 4;
    limits.kept_connections = 2;
    listen(false, limits);
    std::string remote = "something", own;
    with_server([&] {
        const Caller first(server->remote_port(), false), second(server->remote_port(), false);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        Caller third(server->remote_port(), false), mine(server->port(), false);
        const auto get = [](int port) {
            return "GET /x HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                   "\r\nConnection: close\r\n\r\n";
        };
        remote = third.ask(get(server->remote_port()), "\r\n\r\n");
        own = mine.ask(get(server->port()), "\r\n\r\n");
    });
    EXPECT_EQ(remote, "");
    EXPECT_TRUE(own.starts_with("HTTP/1.1 200")) << own;
}

}  // namespace
}  // namespace mw::screen
