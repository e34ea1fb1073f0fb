// SPDX-License-Identifier: GPL-2.0-or-later
// The rights of a client, by its connection and its token: the table of docs/reference/api.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "clients/screen/http_types.hh"
#include "clients/screen/origin_check.hh"

namespace mw::screen {

/// "local", "tls", "none".
std::string_view protection_name(Protection protection);
/// "view", "operate", "configure"; "" without a role, "view" for STATUS, which is the same for screens.
std::string_view role_name(Role role);
std::optional<Role> role_of_name(std::string_view name);

/// Secrets of 256 bits and what they open. A process that can read the file can operate the machine of this
/// computer anyway, so the file keeps them unencrypted.
class Tokens {
  public:
    struct Token {
        Role role = Role::NOBODY;
        std::string secret;
    };

    Tokens() = default;
    explicit Tokens(std::vector<Token> all) : all_(std::move(all)) {}
    /// Reads lines of "ROLE SECRET"; makes the file with one secret for each role where it is missing. An
    /// error when another user could read it.
    static Result<Tokens> read_or_make(const std::string &path);
    /// A new secret for each role.
    static Result<Tokens> random();

    /// Takes as long for each wrong one.
    Role role_of(std::string_view secret) const;
    /// A secret that opens `role`; empty where there is none.
    std::string_view secret_of(Role role) const;
    const std::vector<Token> &all() const { return all_; }

  private:
    std::vector<Token> all_;
};

/// Credentials of a request.
struct Credentials {
    std::string_view authorization;  ///< header: "Bearer SECRET"
    std::string_view cookie;         ///< header
    /// The connection was opened on this computer by the user of the server, or root.
    bool isOfServerUser = false;
};

/// Of one way in.
class Access {
  public:
    /// All requests have this role.
    Access(Protection protection, Role everybody) : protection_(protection), everybody_(everybody) {}
    /// With TLS: who shows a token has its role.
    explicit Access(Tokens tokens)
        : protection_(Protection::TLS), tokens_(std::move(tokens)), cookies_(tokens_) {}
    /// Of this computer: CONFIGURE for the user of the server and root, the role of a token for another user
    /// that shows one, STATUS for all others. Browsers get one of `cookies`, which end with the server: any
    /// user of this computer may listen on its port later, and a browser would send them there.
    static Access of_this_computer(Tokens tokens, Tokens cookies);

    Protection protection() const { return protection_; }
    /// No role without a token or with a wrong one. `port`: of the server; keeps the cookies of servers
    /// on one computer apart.
    Role role_of(const Credentials &shown, int port) const;
    /// GET: the role of the request. POST {"token": "..."}: a cookie that no script can read, for the
    /// browser; 403 for a wrong one, 429 when there were too many wrong ones. DELETE: forgets the cookie.
    Response login(const Request &request, int port, std::int64_t now_ns);

  private:
    Role role_of_token(const Credentials &shown, int port) const;

    Protection protection_;
    Role everybody_ = Role::NOBODY;
    Tokens tokens_, cookies_;
    RateLimit wrong_{0.2, 10};
};

}  // namespace mw::screen
