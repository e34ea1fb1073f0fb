// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/web/shop_page.hh"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/shop/web/page_text.hh"

namespace mw::shop {
namespace {

/// An answer is reused for a multiple of the time that it took. So many browsers and many machines use at
/// most a fifth of one connection: a tenth for each of two queries.
constexpr double FRESH_FACTOR = 10;
constexpr std::uint64_t MOST_DAYS = 366;

screen::Response plain(int status, std::string text) {
    return {.status = status, .type = "text/plain; charset=utf-8", .body = std::move(text)};
}

}  // namespace

ShopPage::ShopPage(std::string database, std::function<double()> steady_s)
    : name_(database), offers_(std::move(database)), steady_s_(std::move(steady_s)) {}

Result<std::string> ShopPage::ask(const std::string &sql, std::span<const Parameter> parameters) {
    if (!database_.has_value()) {
        auto opened = Database::open(name_);
        if (!opened.has_value()) {
            return std::unexpected(opened.error());
        }
        const auto set = opened->run(
            "SET default_transaction_read_only = on; SET statement_timeout = '60s'; SET jit = off");
        if (!set.has_value()) {
            return std::unexpected(set.error());
        }
        database_ = std::move(*opened);
    }
    const auto rows = database_->ask(sql, parameters);
    if (!rows.has_value()) {
        database_.reset();
        return std::unexpected(rows.error());
    }
    return rows->text(0, 0).value_or("{}");
}

screen::Response ShopPage::kept(Kept &answer) {
    const double begin_s = steady_s_();
    if (begin_s >= answer.fresh_until_s) {
        auto found = ask(answer.sql);
        if (!found.has_value()) {
            return plain(503, found.error().message);
        }
        answer.json = std::move(*found);
        const double end_s = steady_s_();
        answer.fresh_until_s = end_s + std::max(answer.fresh_s, FRESH_FACTOR * (end_s - begin_s));
    }
    return {.body = answer.json};
}

screen::Response ShopPage::history(const screen::Request &request) {
    const auto number = [&request](const char *name) {
        const auto found = request.query.find(name);
        return found == request.query.end() ? std::nullopt : parse_uint(found->second);
    };
    const auto machine = number("machine"), days = number("days");
    if (!machine.has_value() || *machine > INT32_MAX || !days.has_value() || *days < 1 || *days > MOST_DAYS) {
        return plain(400, "history needs machine=ID and days=1 to 366\n");
    }
    const std::array parameters{Parameter{std::to_string(*machine), false, false},
                                Parameter{std::to_string(*days), false, false}};
    auto found = ask("SELECT page_history($1::int, $2::int)", parameters);
    return found.has_value() ? screen::Response{.body = std::move(*found)}
                             : plain(503, found.error().message);
}

void ShopPage::answer(const screen::Request &request, screen::Reply reply) {
    const bool isPart = request.path == "/" || request.path == "/page.css" || request.path == "/page.js";
    if (request.role == screen::Role::NOBODY && !isPart) {
        reply(plain(403, "Sign in with a token.\n"));
    } else if (request.path == "/offers" || request.path.starts_with("/offers/") ||
               request.path == "/copies" || request.path.starts_with("/copies/")) {
        reply(offers_.answer(request));
    } else if (request.method != "GET") {
        reply(plain(405, "The page is read-only: only GET requests are possible.\n"));
    } else if (request.path == "/") {
        reply({.type = "text/html; charset=utf-8", .body = std::string(PAGE_HTML)});
    } else if (request.path == "/page.css") {
        reply({.type = "text/css; charset=utf-8", .body = std::string(PAGE_CSS)});
    } else if (request.path == "/page.js") {
        reply({.type = "text/javascript; charset=utf-8", .body = std::string(PAGE_JS)});
    } else if (request.path == "/machines") {
        reply(kept(machines_));
    } else if (request.path == "/machines/sums") {
        reply(kept(sums_));
    } else if (request.path == "/machines/history") {
        reply(history(request));
    } else {
        reply(plain(404, "There is no such page.\n"));
    }
}

}  // namespace mw::shop
