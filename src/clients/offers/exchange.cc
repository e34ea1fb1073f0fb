// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/offers/exchange.hh"

#include <utility>

#include <fmt/format.h>

#include "clients/offers/json_fields.hh"

namespace mw::offers {
namespace {

/// The latest time that JSON readers of all languages represent exactly.
constexpr std::int64_t LAST_TIME_MS = 253'402'214'400'000;

State read_state(Fields &fields) {
    const auto state = state_of(fields.text("state"));
    if (!state.has_value()) {
        fields.set_problem("\"state\" is not the state of an offer");
    }
    return state.value_or(State::SENT);
}

std::string read_id(Fields &fields) {
    std::string id = fields.text("id");
    if (!isOfferId(id)) {
        fields.set_problem("\"id\" is not the id of an offer");
    }
    return id;
}

std::vector<std::string> read_ids(Fields &fields, const char *name) {
    std::vector<std::string> ids;
    for (const nlohmann::json &one : fields.list(name, MOST_ENTRIES)) {
        ids.push_back(one.is_string() ? one.get<std::string>() : "");
        if (!isOfferId(ids.back())) {
            fields.set_problem(fmt::format("\"{}\" has an entry that is not the id of an offer", name));
        }
    }
    return ids;
}

/// Text that a person has entered, without control characters.
std::string read_words(Fields &fields, const char *name, std::size_t most) {
    std::string text = fields.text(name);
    if (text.size() > most || !isPlainText(text)) {
        fields.set_problem(
            fmt::format("\"{}\" is longer than {} bytes or has control characters", name, most));
    }
    return text;
}

Result<nlohmann::json> parse(std::string_view json, const char *what) {
    if (json.size() > MOST_MESSAGE_BYTES) {
        return fail(
            fmt::format("the {} has {} bytes; the maximum is {}", what, json.size(), MOST_MESSAGE_BYTES));
    }
    auto document = nlohmann::json::parse(json, nullptr, false);
    return document.is_object() ? Result<nlohmann::json>(std::move(document))
                                : fail(fmt::format("the {} is not a JSON object in UTF-8", what));
}

std::string topic(const char *kind, std::string_view host, std::string_view group, std::string_view node,
                  std::string_view device) {
    return fmt::format("millwright/{}/{}/{}/{}/{}", kind, host, group, node, device);
}

}  // namespace

std::string report_topic(std::string_view host, std::string_view group, std::string_view node,
                         std::string_view device) {
    return topic("report", host, group, node, device);
}
std::string reply_topic(std::string_view host, std::string_view group, std::string_view node,
                        std::string_view device) {
    return topic("offer", host, group, node, device);
}

std::string encode(const Report &report) {
    auto changes = nlohmann::json::array();
    for (const Standing &one : report.changes) {
        changes.push_back({{"id", one.id},
                           {"state", name_of(one.state)},
                           {"at", one.at},
                           {"by", one.by},
                           {"reason", one.reason}});
    }
    return nlohmann::json{{"changes", changes}, {"open", report.open}, {"room", report.hasRoom}}.dump();
}

Result<Report> decode_report(std::string_view json) {
    const auto document = parse(json, "report");
    if (!document.has_value()) {
        return std::unexpected(document.error());
    }
    Fields fields(*document);
    Report report;
    for (const nlohmann::json &one : fields.list("changes", MOST_ENTRIES)) {
        Fields change(one);
        report.changes.push_back({.id = read_id(change),
                                  .state = read_state(change),
                                  .at = static_cast<TimeMs>(change.whole("at", 0, LAST_TIME_MS)),
                                  .by = read_words(change, "by", MOST_PERSON_BYTES),
                                  .reason = read_words(change, "reason", MOST_NOTE_BYTES)});
        if (report.changes.back().state == State::SENT) {
            change.set_problem("a machine does not report the state \"sent\"");
        }
        fields.take_problem(change);
    }
    report.open = read_ids(fields, "open");
    report.hasRoom = fields.boolean("room");
    return fields.problem().empty() ? Result<Report>(std::move(report)) : fail(fields.problem());
}

std::string encode(const Reply &reply) {
    auto noted = nlohmann::json::array();
    for (const Note &one : reply.noted) {
        noted.push_back({{"id", one.id}, {"state", name_of(one.state)}});
    }
    nlohmann::json document{{"noted", std::move(noted)}, {"withdrawn", reply.withdrawn}};
    if (reply.offer.has_value()) {
        document["offer"] = json_of(*reply.offer);
    }
    return document.dump();
}

Result<Reply> decode_reply(std::string_view json) {
    const auto document = parse(json, "reply");
    if (!document.has_value()) {
        return std::unexpected(document.error());
    }
    Fields fields(*document);
    Reply reply;
    for (const nlohmann::json &one : fields.list("noted", MOST_ENTRIES)) {
        Fields note(one);
        reply.noted.push_back({read_id(note), read_state(note)});
        fields.take_problem(note);
    }
    reply.withdrawn = read_ids(fields, "withdrawn");
    if (const auto found = document->find("offer"); found != document->end()) {
        auto offer = offer_of(*found);
        if (offer.has_value()) {
            reply.offer = std::move(*offer);
        } else {
            Fields broken(*found);
            const std::string id = read_id(broken);
            if (!broken.problem().empty()) {
                return fail(offer.error().message);
            }
            reply.broken = BrokenOffer{id, offer.error().message};
        }
    }
    return fields.problem().empty() ? Result<Reply>(std::move(reply)) : fail(fields.problem());
}

}  // namespace mw::offers
