// SPDX-License-Identifier: GPL-2.0-or-later
// The rights of a client, from its connection and its token: the table of docs/reference/api.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "clients/screen/access/origin_check.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// "local", "tls", "none".
std::string_view protection_name(Protection protection);
/// "view", "operate", "configure". "" without a role; "view" also for STATUS, because screens treat both the
/// same.
std::string_view role_name(Role role);
std::optional<Role> role_of_name(std::string_view name);

/// Secrets of 256 bits with their roles. A process that can read the file can operate the machine of this
/// computer anyway, so the secrets are not encrypted.
class Tokens {
  public:
    struct Token {
        Role role = Role::NOBODY;
        std::string secret;
    };

    Tokens() = default;
    explicit Tokens(std::vector<Token> all) : all_(std::move(all)) {}
    /// Reads lines of "ROLE SECRET". If the file is missing, creates it with one secret for each role. An
    /// error if another user could read it.
    static Result<Tokens> read_or_make(const std::string &path);
    /// A new secret for each role.
    static Result<Tokens> random();

    /// Takes the same time for each wrong secret.
    Role role_of(std::string_view secret) const;
    /// A secret with this role; empty if there is none.
    std::string_view secret_of(Role role) const;
    const std::vector<Token> &all() const { return all_; }

  private:
    std::vector<Token> all_;
};

/// Credentials of a request.
struct Credentials {
    std::string_view authorization;  ///< header: "Bearer SECRET"
    std::string_view cookie;         ///< header
    /// The user of the server, or root, has opened the connection on this computer.
    bool isOfServerUser = false;
};

/// Access rules of one port.
class Access {
  public:
    /// All requests have this role.
    Access(Protection protection, Role everybody) : protection_(protection), everybody_(everybody) {}
    /// With TLS: a request has the role of its token.
    explicit Access(Tokens tokens)
        : protection_(Protection::TLS), tokens_(std::move(tokens)), cookies_(tokens_) {}
    /// For this computer: CONFIGURE for the user of the server and root, the role of the token for another
    /// user with a token, STATUS for all others. Browsers receive one of `cookies`, which end with the
    /// server, because any user of this computer may later listen on its port and would receive the browser's
    /// cookies.
    static Access of_this_computer(Tokens tokens, Tokens cookies);

    Protection protection() const { return protection_; }
    /// Without a token, or with an invalid token, there is no role. `port` is that of the server; it
    /// separates the cookies of servers on one computer.
    Role role_of(const Credentials &shown, int port) const;
    /// GET: the role of the request. POST {"token": "..."}: a cookie that scripts cannot read, for the
    /// browser; 403 for a wrong token, 429 after too many wrong tokens. DELETE: removes the cookie.
    Response login(const Request &request, int port, std::int64_t now_ns);

  private:
    Role role_of_token(const Credentials &shown, int port) const;

    Protection protection_;
    Role everybody_ = Role::NOBODY;
    Tokens tokens_, cookies_;
    RateLimit wrong_{0.2, 10};
};

}  // namespace mw::screen
