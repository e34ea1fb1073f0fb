// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/access/access.hh"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/screen/access/secrets.hh"
#include "clients/screen/http/error_response.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, 3> NAMES{
    {{Role::VIEW, "view"}, {Role::OPERATE, "operate"}, {Role::CONFIGURE, "configure"}}};

/// Shorter secrets could be guessed.
constexpr std::size_t SHORTEST_SECRET = 32;

Result<Tokens> make(const std::string &path) {
    auto made = Tokens::random();
    if (!made.has_value()) {
        return made;
    }
    std::string text =
        "# Who shows one of these to the screen's server may do what its role allows. A line taken away is\n"
        "# good for nothing once the server has been started again.\n";
    for (const Tokens::Token &one : made->all()) {
        text += fmt::format("{} {}\n", role_name(one.role), one.secret);
    }
    const auto written = write_secret_file(path, text);
    return written.has_value() ? made : std::unexpected(written.error());
}

/// The value of a cookie; empty if there is no cookie of this name.
std::string_view cookie_value(std::string_view header, std::string_view name) {
    while (!header.empty()) {
        const std::size_t end = std::min(header.find(';'), header.size());
        const std::string_view one = trim(header.substr(0, end));
        header.remove_prefix(std::min(end + 1, header.size()));
        if (one.starts_with(name) && one.size() > name.size() && one[name.size()] == '=') {
            return one.substr(name.size() + 1);
        }
    }
    return {};
}

std::string cookie_name(int port) {
    return "millwright_token_" + std::to_string(port);
}

}  // namespace

std::string_view protection_name(Protection protection) {
    switch (protection) {
    case Protection::LOCAL: return "local";
    case Protection::TLS: return "tls";
    case Protection::NONE: return "none";
    }
    return "";
}

std::string_view role_name(Role role) {
    role = role == Role::STATUS ? Role::VIEW : role;
    const auto found = std::ranges::find(NAMES, role, &std::pair<Role, std::string_view>::first);
    return found == NAMES.end() ? "" : found->second;
}

std::optional<Role> role_of_name(std::string_view name) {
    const auto found = std::ranges::find(NAMES, name, &std::pair<Role, std::string_view>::second);
    return found == NAMES.end() ? std::nullopt : std::optional(found->first);
}

Result<Tokens> Tokens::read_or_make(const std::string &path) {
    const auto text = read_secret_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    if (!text->has_value()) {
        return make(path);
    }
    std::vector<Token> all;
    std::istringstream lines(**text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const auto words = split_words(line);
        if (words.empty() || words[0].starts_with('#')) {
            continue;
        }
        const auto role = role_of_name(words[0]);
        if (!role.has_value() || words.size() != 2 || words[1].size() < SHORTEST_SECRET) {
            return fail("a line is ROLE SECRET: view, operate or configure, and at least 32 characters",
                        {path, number, 1}, "take the file away: one with new tokens is made");
        }
        all.push_back({*role, words[1]});
    }
    return Tokens(std::move(all));
}

Result<Tokens> Tokens::random() {
    std::vector<Token> all;
    for (const auto &[role, name] : NAMES) {
        auto secret = random_secret();
        if (!secret.has_value()) {
            return std::unexpected(secret.error());
        }
        all.push_back({role, std::move(*secret)});
    }
    return Tokens(std::move(all));
}

std::string_view Tokens::secret_of(Role role) const {
    const auto found = std::ranges::find(all_, role, &Token::role);
    return found == all_.end() ? std::string_view{} : std::string_view(found->secret);
}

Role Tokens::role_of(std::string_view secret) const {
    Role role = Role::NOBODY;
    for (const Token &one : all_) {
        role = areSame(one.secret, secret) ? std::max(role, one.role) : role;
    }
    return role;
}

Access Access::of_this_computer(Tokens tokens, Tokens cookies) {
    Access made(std::move(tokens));
    made.protection_ = Protection::LOCAL;
    made.cookies_ = std::move(cookies);
    return made;
}

Role Access::role_of(const Credentials &shown, int port) const {
    if (everybody_ != Role::NOBODY) {
        return everybody_;
    }
    const bool is_local = protection_ == Protection::LOCAL;
    return is_local && shown.isOfServerUser ? Role::CONFIGURE
           : is_local                       ? std::max(Role::STATUS, role_of_token(shown, port))
                                            : role_of_token(shown, port);
}

Role Access::role_of_token(const Credentials &shown, int port) const {
    constexpr std::string_view BEARER = "Bearer ";
    if (shown.authorization.starts_with(BEARER)) {
        return tokens_.role_of(shown.authorization.substr(BEARER.size()));
    }
    const std::string_view kept = cookie_value(shown.cookie, cookie_name(port));
    return kept.empty() ? Role::NOBODY : cookies_.role_of(kept);
}

namespace {

/// The token of {"token": "..."}; nothing for other texts.
std::optional<std::string> token_of_login(std::string_view text) {
    const nlohmann::ordered_json json = messages::parse_json(text);
    const auto token = json.is_object() ? json.find("token") : json.end();
    const bool is_token = json.is_object() && token != json.end() && token->is_string();
    return is_token ? std::optional(token->get<std::string>()) : std::nullopt;
}

}  // namespace

Response Access::login(const Request &request, int port, std::int64_t now_ns) {
    const auto answer = [this](Role role) {
        Response response;
        const std::string_view name = role == Role::STATUS ? "" : role_name(role);  // a token would permit it
        response.body =
            fmt::format(R"({{"role":"{}","protection":"{}"}})", name, protection_name(protection_));
        return response;
    };
    if (request.method == "GET") {
        return answer(request.role);
    }
    if (everybody_ != Role::NOBODY) {
        return error_response(404, "this server needs no token");
    }
    const std::string rules = fmt::format("; Path=/{}; HttpOnly; SameSite=Strict",
                                          protection_ == Protection::LOCAL ? "" : "; Secure");
    if (request.method == "DELETE") {
        Response response = answer(Role::NOBODY);
        response.cookie = cookie_name(port) + "=" + rules + "; Max-Age=0";
        return response;
    }
    const auto secret = request.method == "POST" ? token_of_login(request.body) : std::nullopt;
    if (!secret.has_value()) {
        return error_response(400, R"(it is GET, POST with {"token": "..."}, or DELETE)");
    }
    const Role role = tokens_.role_of(*secret);
    if (role == Role::NOBODY) {
        return wrong_.take(now_ns) ? error_response(403, "this token opens nothing here")
                                   : error_response(429, "too many wrong tokens: try again in a minute");
    }
    constexpr long KEPT_S = 30L * 24 * 3600;
    Response response = answer(role);
    const std::string_view kept = protection_ == Protection::LOCAL ? cookies_.secret_of(role) : *secret;
    response.cookie = fmt::format("{}={}{}; Max-Age={}", cookie_name(port), kept, rules, KEPT_S);
    return response;
}

}  // namespace mw::screen
