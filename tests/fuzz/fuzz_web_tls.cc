// SPDX-License-Identifier: GPL-2.0-or-later
// Input at the port for other computers: a TLS client whose records the bytes corrupt, cut, mix with
// others and fill. Meanwhile the server answers a screen of this computer in each turn, and afterwards a
// correct client gets a slot.
#include <openssl/rand.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "clients/screen/server/server.hh"
#include "clients/screen/test/tls_peer.hh"
#include "tests/fuzz/web_rig.hh"

#pragma clang diagnostic ignored                                                                             \
    "-Wdeprecated-declarations"  // for RAND_METHOD, which is the only interface for all of OpenSSL

namespace {

using namespace mw;
using screen::test::TlsPeer;

const std::string TOKEN(64, 'f');
constexpr int PATIENCE = 400;  // turns

/// The same bytes give the same numbers.
std::uint64_t dice = 1;
int roll(unsigned char *bytes, int size) {
    for (int i = 0; i < size; ++i) {
        dice = dice * 6364136223846793005ULL + 1442695040888963407ULL;
        bytes[i] = static_cast<unsigned char>(dice >> 56);
    }
    return 1;
}
int is_seeded() {
    return 1;
}

void require(bool isSo, const char *what) {
    if (!isSo) {
        std::fprintf(stderr, "%s\n", what);
        std::abort();
    }
}

struct Rig {
    Rig() {
        static const RAND_METHOD METHOD{nullptr, roll, nullptr, nullptr, roll, is_seeded};
        RAND_set_rand_method(&METHOD);
        auto certificate = screen::read_or_make_certificate(web.folder, {"127.0.0.1"});
        require(certificate.has_value(), "there is no certificate");
        screen::RemoteDoor door{"127.0.0.1",
                                0,
                                {},
                                screen::Access(screen::Tokens({{screen::Role::OPERATE, TOKEN}})),
                                std::move(*certificate)};
        screen::ServerLimits limits;
        limits.body_bytes = 4096;
        limits.connections = 12;
        limits.kept_connections = 4;
        limits.requests_per_s = limits.requests_at_once = 1e9;
        limits.greetings_per_s = limits.greetings_at_once = 1e9;
        limits.greeting_time = limits.request_time = std::chrono::milliseconds(50);
        auto made =
            screen::Server::listen({.port = 0, .limits = limits, .remote = std::move(door), .frames = {}});
        require(made.has_value(), "no port is free");
        server = std::move(*made);
        api = web.api(*server);
        own = std::make_unique<TlsPeer>(server->port(), TlsPeer::Wish{.hasTls = false});
        own->out = socket(server->port());
        own->send();
    }
    void run() {
        web.cycle();
        server->run_for(*api, std::chrono::microseconds(200));
        api->tick();
    }
    static std::string host(int port) { return "Host: 127.0.0.1:" + std::to_string(port) + "\r\n"; }
    static std::string socket(int port) {
        return "GET /api/socket HTTP/1.1\r\n" + host(port) + "Authorization: Bearer " + TOKEN +
               "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";
    }
    std::string request() const {
        return "GET /api/machine HTTP/1.1\r\n" + host(server->remote_port()) + "Authorization: Bearer " +
               TOKEN + "\r\n\r\n";
    }
    /// The screen of this computer sends a request and receives its answer.
    void require_answer() {
        own->think();
        const std::size_t before = own->taken;
        own->out += std::string("\x81\x8a\0\0\0\0{\"ping\":1}", 16);
        for (int i = 0; i < PATIENCE && own->taken == before; ++i) {
            own->send();
            run();
            own->think();
        }
        require(own->taken != before && !own->isClosed, "a screen of this computer is not answered");
    }
    bool pump(TlsPeer &peer, const std::function<bool()> &isDone) {
        for (int i = 0; i < PATIENCE && !peer.isClosed && !isDone(); ++i) {
            peer.think();
            peer.send();
            run();
        }
        return isDone();
    }
    /// A correct client gets a slot; slots of interrupted clients may be in use until their timeout.
    void require_place() {
        for (int i = 0; i < PATIENCE; ++i) {
            TlsPeer peer(server->remote_port(), {});
            if (pump(peer, [&] { return peer.isUp(); })) {
                peer.say(request());
                if (pump(peer, [&] { return peer.received.starts_with("HTTP/1.1 200"); })) {
                    return;
                }
            }
        }
        require(false, "a correct client gets no slot");
    }

    fuzz::WebRig web;
    std::unique_ptr<screen::Server> server;
    std::unique_ptr<screen::Api> api;
    std::unique_ptr<TlsPeer> own;  ///< without TLS: only its socket is used
};

struct Script {
    std::string_view bytes;
    unsigned next() {
        const unsigned value = bytes.empty() ? 0 : static_cast<unsigned char>(bytes[0]);
        bytes.remove_prefix(bytes.empty() ? 0 : 1);
        return value;
    }
    std::string_view take(std::size_t size) {
        const std::string_view part = bytes.substr(0, size);
        bytes.remove_prefix(part.size());
        return part;
    }
};

void change_keys(TlsPeer &peer, unsigned count) {
    if (!peer.isUp()) {
        return;
    }
    for (unsigned i = 0; i < count; ++i) {
        if (SSL_version(peer.tls()) == TLS1_3_VERSION) {
            SSL_key_update(peer.tls(),
                           (count & 1U) != 0 ? SSL_KEY_UPDATE_REQUESTED : SSL_KEY_UPDATE_NOT_REQUESTED);
        } else {
            SSL_renegotiate(peer.tls());
        }
        SSL_do_handshake(peer.tls());
    }
}

/// One action of a client, with any effect on the connection.
void act(Rig &rig, TlsPeer &peer, Script &script) {
    const unsigned what = script.next(), size = script.next();
    switch (what % 11) {
    case 0: peer.think(); break;
    case 1: peer.send(size); break;
    case 2: peer.send(); break;
    case 3:  // a bit is inverted
        if (!peer.out.empty()) {
            char &one = peer.out[size % peer.out.size()];
            one = static_cast<char>(static_cast<unsigned char>(one) ^ (1U << (what / 11 % 8)));
        }
        break;
    case 4: peer.out.erase(0, size); break;
    case 5: peer.out += script.take(size); break;  // no records
    case 6: peer.say(script.take(size)); break;
    case 7: peer.say(rig.request()); break;
    case 8: peer.say(Rig::socket(rig.server->remote_port())); break;
    case 9: {  // a frame
        const std::string_view text = script.take(size % 126);
        peer.say(std::string{'\x81', static_cast<char>(0x80U | text.size()), 0, 0, 0, 0} + std::string(text));
        break;
    }
    case 10:
        if (size < 8) {
            SSL_shutdown(peer.tls());
        } else {
            change_keys(peer, size);
        }
        break;
    }
    if (what >= 128) {
        rig.run();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    static Rig rig;
    static int inputs = 0;
    dice = 1;
    {
        Script script{{reinterpret_cast<const char *>(data), size}};
        const unsigned kind = script.next();
        TlsPeer peer(rig.server->remote_port(), {.version = (kind & 1U) != 0 ? TLS1_2_VERSION : 0});
        if ((kind & 2U) != 0) {
            rig.pump(peer, [&] { return peer.isUp() && peer.out.empty(); });
        }
        while (!script.bytes.empty() && !peer.isClosed) {
            act(rig, peer, script);
        }
        peer.think();
        peer.send();
        rig.require_answer();
    }
    rig.run();
    if (++inputs % 64 == 0) {
        rig.require_place();
    }
    return 0;
}
