// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/store/offer_store.hh"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include <fmt/format.h>

namespace mw::shop {
namespace {

Parameter words(const std::string &text) {
    return {text, false, false};
}

/// An array of PostgreSQL as text. The elements have no special characters.
std::string array_of(const std::vector<std::string> &ids) {
    return fmt::format("{{{}}}", fmt::join(ids, ","));
}

}  // namespace

Result<> OfferStore::open() {
    auto opened = Database::open(name_);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    if (auto set = opened->run("SET statement_timeout = '15s'"); !set.has_value()) {
        return set;
    }
    const std::array parameters{words("millwright-offers/" + collector_)};
    const auto taken = opened->ask(
        "SELECT pg_try_advisory_lock(hashtext($1)), to_regclass('offer') IS NOT NULL", parameters);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    if (taken->text(0, 0) != "t") {
        return fail(fmt::format("another collector {} answers the machines of this database", collector_));
    }
    if (taken->text(0, 1) != "t") {
        return fail("the collector has not created the tables yet");
    }
    database_ = std::move(*opened);
    return {};
}

Result<offers::Reply> OfferStore::take(const MachineName &machine, const offers::Report &report) {
    if (!database_.has_value()) {
        return fail("the database is not connected");
    }
    const auto document = nlohmann::json::parse(offers::encode(report));
    const std::string changes = document.at("changes").dump();
    const std::array parameters{words(machine.node.group),    words(machine.node.node),
                                words(machine.device),        words(changes),
                                words(array_of(report.open)), words(report.hasRoom ? "t" : "f")};
    const auto rows =
        database_->ask("SELECT take_report($1, $2, $3, $4::json, $5::uuid[], $6::boolean)", parameters);
    if (!rows.has_value()) {
        database_.reset();
        return std::unexpected(rows.error());
    }
    auto reply = offers::decode_reply(rows->text(0, 0).value_or(""));
    if (reply.has_value() && reply->broken.has_value()) {
        return fail(fmt::format("the offer {} in the database: {}", reply->broken->id, reply->broken->why));
    }
    if (reply.has_value() && !report.copies.empty()) {
        const std::array of_copies{words(machine.node.group), words(machine.node.node), words(machine.device),
                                   words(document.at("copies").dump())};
        const auto wanted = database_->ask("SELECT wanted_copies($1, $2, $3, $4::json)", of_copies);
        if (!wanted.has_value()) {
            database_.reset();
            return std::unexpected(wanted.error());
        }
        reply->wanted =
            nlohmann::json::parse(wanted->text(0, 0).value_or("[]")).get<std::vector<std::string>>();
    }
    return reply;
}

Result<> OfferStore::take(const MachineName &machine, const offers::Copy &copy) {
    if (!database_.has_value()) {
        return fail("the database is not connected");
    }
    const std::array parameters{words(machine.node.group),
                                words(machine.node.node),
                                words(machine.device),
                                words(copy.facts.kind),
                                words(std::to_string(copy.facts.at)),
                                words(copy.facts.sha256),
                                words(copy.name),
                                Parameter{copy.bytes, true, false}};
    const auto rows =
        database_->ask("SELECT add_copy($1, $2, $3, $4, $5::bigint, $6, $7, $8::bytea)", parameters);
    if (!rows.has_value()) {
        database_.reset();
        return std::unexpected(rows.error());
    }
    return {};
}

}  // namespace mw::shop
