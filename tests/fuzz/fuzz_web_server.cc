// SPDX-License-Identifier: GPL-2.0-or-later
// Bytes at the port of the web server. The first byte selects the form: a request, raw bytes after the
// handshake of a web socket, or frames of a web socket whose types and sizes the bytes define.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "clients/screen/server/server.hh"
#include "tests/fuzz/web_rig.hh"

namespace {

using namespace mw;

constexpr std::size_t FRAME_HEAD = 2;

struct Rig {
    Rig() {
        screen::ServerLimits limits;
        limits.body_bytes = 4096;
        limits.requests_per_s = 1e9;
        limits.requests_at_once = 1e9;
        limits.request_time = std::chrono::milliseconds(50);
        auto made = screen::Server::listen({.port = 0, .limits = limits, .remote = {}, .frames = {}});
        if (!made.has_value()) {
            std::abort();
        }
        server = std::move(*made);
        api = web.api(*server);
    }
    void run() {
        web.cycle();
        server->run_for(*api, std::chrono::microseconds(200));
        api->tick();
    }
    fuzz::WebRig web;
    std::unique_ptr<screen::Server> server;
    std::unique_ptr<screen::Api> api;
};

std::string host(int port) {
    return "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
}

std::string handshake(int port) {
    return "GET /api/socket HTTP/1.1\r\n" + host(port) +
           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";
}

/// Valid frame headers with a zero mask; the first of two bytes is the type with its flags, the second the
/// size.
std::string frames(std::string_view bytes) {
    constexpr std::size_t LONGEST = 125;
    constexpr char MASKED = static_cast<char>(0x80);
    std::string out;
    while (bytes.size() > FRAME_HEAD) {
        const std::size_t size =
            std::min(static_cast<unsigned char>(bytes[1]) % (LONGEST + 1), bytes.size() - FRAME_HEAD);
        out += bytes[0];
        out += static_cast<char>(static_cast<unsigned char>(MASKED) | size);
        out.append(4, '\0');
        out += bytes.substr(FRAME_HEAD, size);
        bytes.remove_prefix(FRAME_HEAD + size);
    }
    return out;
}

/// Sends all data, and reads until the server has closed or sends nothing more.
void talk(Rig &rig, std::string_view bytes) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(rig.server->port()));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(::connect(fd, reinterpret_cast<const sockaddr *>(&place), sizeof place));
    bool isShut = false;
    for (int quiet = 0; quiet < 4;) {
        rig.run();
        const ssize_t sent = bytes.empty() ? 0 : ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        if (bytes.empty() && !isShut) {
            isShut = ::shutdown(fd, SHUT_WR) == 0;
        }
        std::array<char, 16384> part{};
        const ssize_t got = ::recv(fd, part.data(), part.size(), 0);
        if (got == 0) {
            break;
        }
        quiet = got > 0 || sent > 0 ? 0 : quiet + 1;
    }
    ::close(fd);
    rig.run();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    if (size < 1) {
        return 0;
    }
    static Rig rig;
    const std::string_view bytes(reinterpret_cast<const char *>(data) + 1, size - 1);
    const int port = rig.server->port();
    switch (data[0] % 4) {
    case 0: talk(rig, bytes); break;
    case 1: {  // after a first line and a host that are accepted
        std::string request(bytes);
        const std::size_t end = request.find("\r\n");
        request.insert(end == std::string::npos ? request.size() : end + 2, host(port));
        talk(rig, request);
        break;
    }
    case 2: talk(rig, handshake(port) + std::string(bytes)); break;
    case 3: talk(rig, handshake(port) + frames(bytes)); break;
    }
    return 0;
}
