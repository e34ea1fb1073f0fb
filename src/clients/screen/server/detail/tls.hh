// SPDX-License-Identifier: GPL-2.0-or-later
// Limits the work that an unknown client can cause in TLS, because all screens share one thread. Only
// server.cc includes it.
#pragma once

#include <openssl/ssl.h>

#include <boost/asio/ssl.hpp>
#include <string>

#include "clients/screen/access/secrets.hh"

namespace mw::screen::detail {

/// Maximum number of handshake messages of a peer: the handshake has at most six, the others are key updates,
/// which cost more to calculate than to send.
constexpr int MOST_TLS_MESSAGES = 64;

/// Called by OpenSSL for each message; `messages` is the peer's count. Data after the last permitted message
/// are discarded, and reading ends as if the peer had closed.
inline void count_tls_message(int isWritten, int, int type, const void *, std::size_t, SSL *tls,
                              void *messages) {
    if (isWritten == 0 && type == SSL3_RT_HANDSHAKE && messages != nullptr &&
        ++*static_cast<int *>(messages) >= MOST_TLS_MESSAGES) {
        SSL_set_shutdown(tls, SSL_get_shutdown(tls) | SSL_RECEIVED_SHUTDOWN);
    }
}

/// TLS 1.2 or later, without renegotiation, session resumption and slow groups (a key of ffdhe8192 takes as
/// long as several leases of jogs).
inline boost::system::error_code set_up(boost::asio::ssl::context &context, const Certificate &certificate) {
    SSL_CTX *raw = context.native_handle();
    SSL_CTX_set_options(raw, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    SSL_CTX_set_session_cache_mode(raw, SSL_SESS_CACHE_OFF);
    SSL_CTX_set_msg_callback(raw, count_tls_message);
    boost::system::error_code error;
    if (SSL_CTX_set_min_proto_version(raw, TLS1_2_VERSION) != 1 ||
        SSL_CTX_set1_groups_list(raw, "X25519:P-256") != 1) {
        error = boost::asio::error::no_protocol_option;
        return error;
    }
    context.use_certificate_chain(boost::asio::buffer(certificate.certificate_pem), error);
    if (!error) {
        context.use_private_key(boost::asio::buffer(certificate.key_pem), boost::asio::ssl::context::pem,
                                error);
    }
    return error;
}

}  // namespace mw::screen::detail
