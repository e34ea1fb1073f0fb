// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/web/offer_page.hh"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/offers/offer.hh"

namespace mw::shop {
namespace {

constexpr int OK = 200, BAD_REQUEST = 400, FORBIDDEN = 403, NOT_FOUND = 404, NOT_ALLOWED = 405,
              CONFLICT = 409, UNAVAILABLE = 503;
constexpr std::size_t MOST_MACHINES = 1000;

screen::Response plain(int status, std::string text) {
    return {.status = status, .type = "text/plain; charset=utf-8", .body = std::move(text) + '\n'};
}

Parameter words(const std::string &text) {
    return {text, false, false};
}

/// The machines of a request as an array of PostgreSQL.
Result<std::string> machines_of(const nlohmann::json &request) {
    const auto found = request.find("machines");
    if (found == request.end() || !found->is_array() || found->empty() || found->size() > MOST_MACHINES) {
        return fail(fmt::format("\"machines\" must be a list of 1 to {} machines.", MOST_MACHINES));
    }
    std::string list;
    for (const nlohmann::json &one : *found) {
        if (!one.is_number_unsigned() || one.get<std::uint64_t>() > INT32_MAX) {
            return fail("\"machines\" has an entry that is not the number of a machine.");
        }
        list += (list.empty() ? "" : ",") + std::to_string(one.get<std::uint64_t>());
    }
    return '{' + list + '}';
}

/// The offer of a request; its id is that of the request. The hash is calculated if it is missing.
Result<offers::Offer> offer_of(nlohmann::json request) {
    request["id"] = request.value("request", nlohmann::json());
    if (!request.contains("sha256")) {
        std::vector<offers::OfferedFile> files;
        for (const nlohmann::json &one : request.value("files", nlohmann::json::array())) {
            const bool isFile = one.is_object() && one.contains("name") && one.contains("text") &&
                                one["name"].is_string() && one["text"].is_string();
            files.push_back(isFile ? offers::OfferedFile{one["name"], one["text"]} : offers::OfferedFile{});
        }
        request["sha256"] = offers::sha256_of(files);
    }
    return offers::decode_offer(request.dump());
}

std::string files_text(const offers::Offer &offer) {
    return nlohmann::json::parse(offers::encode(offer)).at("files").dump();
}

}  // namespace

Result<std::string> OfferPage::ask(const std::string &sql, std::span<const Parameter> parameters) {
    if (!database_.has_value()) {
        auto opened = Database::open(name_);
        if (!opened.has_value()) {
            return std::unexpected(opened.error());
        }
        if (const auto set = opened->run("SET statement_timeout = '15s'"); !set.has_value()) {
            return std::unexpected(set.error());
        }
        database_ = std::move(*opened);
    }
    const auto rows = database_->ask(sql, parameters);
    if (!rows.has_value()) {
        database_.reset();
        return std::unexpected(rows.error());
    }
    return rows->text(0, 0).value_or("");
}

/// The answer of a function that returns {"error": text} if it has changed nothing.
screen::Response OfferPage::written(const std::string &sql, std::span<const Parameter> parameters) {
    auto found = ask(sql, parameters);
    if (!found.has_value()) {
        return plain(UNAVAILABLE, found.error().message);
    }
    if (found->empty()) {
        return plain(NOT_FOUND, "There is no such offer.");
    }
    const auto document = nlohmann::json::parse(*found, nullptr, false);
    if (document.is_object() && document.contains("error")) {
        return plain(CONFLICT, document["error"].get<std::string>());
    }
    return {.status = OK, .body = std::move(*found)};
}

screen::Response OfferPage::list() {
    auto found = ask("SELECT page_offers()");
    return found.has_value() ? screen::Response{.body = std::move(*found)}
                             : plain(UNAVAILABLE, found.error().message);
}

screen::Response OfferPage::add(const std::string &body) {
    const auto request = nlohmann::json::parse(body, nullptr, false);
    if (!request.is_object()) {
        return plain(BAD_REQUEST, "The request is not a JSON object in UTF-8.");
    }
    const auto machines = machines_of(request);
    if (!machines.has_value()) {
        return plain(BAD_REQUEST, machines.error().message);
    }
    const auto offer = offer_of(request);
    if (!offer.has_value()) {
        return plain(BAD_REQUEST, fmt::format("The offer is rejected: {}.", offer.error().message));
    }
    const std::array parameters{words(offer->id),
                                words(*machines),
                                words(offer->from),
                                words(offer->note),
                                words(std::to_string(offer->parts)),
                                words(offer->name()),
                                words(offer->sha256),
                                words(std::to_string(offer->bytes())),
                                words(files_text(*offer))};
    return written("SELECT add_offers($1::uuid, $2::int[], $3, $4, $5::int, $6, $7, $8::int, $9)",
                   parameters);
}

screen::Response OfferPage::withdraw(const std::string &body) {
    const auto request = nlohmann::json::parse(body, nullptr, false);
    const auto text = [&request](const char *name) {
        return request.is_object() && request.contains(name) && request[name].is_string()
                   ? request[name].get<std::string>()
                   : std::string();
    };
    const std::string id = text("id"), person = text("by");
    const bool isPerson =
        !person.empty() && person.size() <= offers::MOST_PERSON_BYTES && offers::isPlainText(person);
    if (!offers::isOfferId(id) || !isPerson) {
        return plain(BAD_REQUEST,
                     "A withdrawal needs the \"id\" of an offer, and \"by\": the name of a person.");
    }
    const std::array parameters{words(id), words(person)};
    return written("SELECT withdraw_offer($1::uuid, $2)", parameters);
}

screen::Response OfferPage::copy(const screen::Request &request) {
    if (request.path == "/copies") {
        auto found = ask("SELECT page_copies()");
        return found.has_value() ? screen::Response{.body = std::move(*found)}
                                 : plain(UNAVAILABLE, found.error().message);
    }
    if (request.role < screen::Role::OPERATE) {
        return plain(FORBIDDEN, "Copies need a token of the role operate.");
    }
    const auto number =
        parse_uint(std::string_view(request.path).substr(std::string_view("/copies/").size()));
    if (!number.has_value() || *number > INT32_MAX) {
        return plain(NOT_FOUND, "There is no such copy.");
    }
    const std::array parameters{words(std::to_string(*number))};
    const auto found = ask("SELECT encode(bytes, 'hex') FROM machine_copy WHERE id = $1::bigint", parameters);
    if (!found.has_value()) {
        return plain(UNAVAILABLE, found.error().message);
    }
    constexpr int HEX = 16;
    std::string bytes;
    for (std::size_t at = 0; at + 1 < found->size(); at += 2) {
        bytes += static_cast<char>(std::stoi(found->substr(at, 2), nullptr, HEX));
    }
    return found->empty() ? plain(NOT_FOUND, "There is no such copy.")
                          : screen::Response{.type = "application/octet-stream", .body = std::move(bytes)};
}

screen::Response OfferPage::answer(const screen::Request &request) {
    if (request.method == "GET" && request.path.starts_with("/copies")) {
        return copy(request);
    }
    if (request.method == "GET" && request.path == "/offers") {
        return list();
    }
    if (request.method != "POST") {
        return plain(NOT_ALLOWED, "Only GET /offers, POST /offers and POST /offers/withdraw are possible.");
    }
    if (request.role < screen::Role::OPERATE) {
        return plain(FORBIDDEN, "Offers need a token of the role operate.");
    }
    if (request.path == "/offers") {
        return add(request.body);
    }
    return request.path == "/offers/withdraw" ? withdraw(request.body)
                                              : plain(NOT_FOUND, "There is no such page.");
}

}  // namespace mw::shop
