// SPDX-License-Identifier: GPL-2.0-or-later
// A TLS client that collects its records in `out`, where they can be delayed, cut and corrupted. Also used by
// tests/fuzz/fuzz_web_tls.cc.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>

namespace mw::screen::test {

class TlsPeer {
  public:
    struct Wish {
        int version = 0;               ///< TLS1_2_VERSION; 0: the newest
        const char *groups = nullptr;  ///< in the format of SSL_set1_groups_list()
        bool hasTls = true;            ///< false: only sends `out` and counts `taken`
    };

    TlsPeer(int port, const Wish &wish)
        : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), context_(SSL_CTX_new(TLS_client_method())),
          tls_(SSL_new(context_)), hasTls_(wish.hasTls), in_(BIO_new(BIO_s_mem())),
          out_(BIO_new(BIO_s_mem())) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(static_cast<std::uint16_t>(port));
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        isClosed = ::connect(fd_, reinterpret_cast<sockaddr *>(&place), sizeof place) != 0;
        ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) | O_NONBLOCK);
        SSL_set_bio(tls_, in_, out_);
        SSL_set_connect_state(tls_);
        if (wish.version != 0) {
            SSL_set_max_proto_version(tls_, wish.version);
        }
        if (wish.groups != nullptr) {
            SSL_set1_groups_list(tls_, wish.groups);
        }
    }
    ~TlsPeer() {
        SSL_free(tls_);
        SSL_CTX_free(context_);
        ::close(fd_);
        ERR_clear_error();
    }
    TlsPeer(const TlsPeer &) = delete;
    TlsPeer &operator=(const TlsPeer &) = delete;

    bool isUp() const { return SSL_is_init_finished(tls_) == 1; }
    SSL *tls() { return tls_; }

    /// Processes received data, and writes the next data to `out`.
    void think() {
        char some[16384];
        ssize_t got = 0;
        while ((got = ::recv(fd_, some, sizeof some, 0)) > 0) {
            taken += static_cast<std::size_t>(got);
            BIO_write(in_, some, static_cast<int>(got));
        }
        isClosed = isClosed || got == 0 || errno != EAGAIN;
        if (!isUp() && hasTls_) {
            SSL_do_handshake(tls_);
        }
        int size = 0;
        while (isUp() && (size = SSL_read(tls_, some, sizeof some)) > 0) {
            received.append(some, static_cast<std::size_t>(size));
        }
        while ((size = BIO_read(out_, some, sizeof some)) > 0) {
            out.append(some, static_cast<std::size_t>(size));
        }
        ERR_clear_error();
    }
    void say(std::string_view text) {
        if (isUp() && !text.empty()) {
            SSL_write(tls_, text.data(), static_cast<int>(text.size()));
        }
        think();
    }
    /// Sends at most this many bytes of `out`.
    void send(std::size_t most = std::string::npos) {
        const std::size_t size = std::min(most, out.size());
        const ssize_t sent = ::send(fd_, out.data(), size, MSG_NOSIGNAL);
        out.erase(0, sent > 0 ? static_cast<std::size_t>(sent) : 0);
        isClosed = isClosed || (sent < 0 && errno != EAGAIN);
    }

    std::string out, received;
    std::size_t taken = 0;  ///< number of received bytes
    bool isClosed = false;

  private:
    int fd_;
    SSL_CTX *context_;
    SSL *tls_;
    bool hasTls_;
    BIO *in_, *out_;
};

}  // namespace mw::screen::test
