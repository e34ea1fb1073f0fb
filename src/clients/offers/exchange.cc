// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/offers/exchange.hh"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
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

/// The kinds of files that a shop collects.
constexpr std::array<std::string_view, 1> KINDS{"tools"};

std::string read_kind(Fields &fields) {
    std::string kind = fields.text("kind");
    if (std::ranges::find(KINDS, kind) == KINDS.end()) {
        fields.set_problem("\"kind\" is not a kind of copy");
    }
    return kind;
}

CopyFacts read_facts(Fields &fields) {
    CopyFacts facts{read_kind(fields), fields.text("sha256"),
                    static_cast<TimeMs>(fields.whole("at", 0, LAST_TIME_MS))};
    constexpr std::size_t DIGITS = 64;
    if (facts.sha256.size() != DIGITS ||
        facts.sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
        fields.set_problem("\"sha256\" is not a SHA-256");
    }
    return facts;
}

nlohmann::json json_of(const CopyFacts &facts) {
    return {{"kind", facts.kind}, {"sha256", facts.sha256}, {"at", facts.at}};
}

std::string to_base64(std::string_view bytes) {
    constexpr std::size_t GROUP = 3, LETTERS = 4;
    std::string text((bytes.size() + GROUP - 1) / GROUP * LETTERS + 1, '\0');
    const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char *>(text.data()),
                                     reinterpret_cast<const unsigned char *>(bytes.data()),
                                     static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(size));
    return text;
}

/// Nothing if it is not base64 with its padding.
std::optional<std::string> from_base64(std::string_view text) {
    constexpr std::size_t GROUP = 3, LETTERS = 4;
    std::string bytes(text.size() / LETTERS * GROUP + 1, '\0');
    const int size =
        EVP_DecodeBlock(reinterpret_cast<unsigned char *>(bytes.data()),
                        reinterpret_cast<const unsigned char *>(text.data()), static_cast<int>(text.size()));
    const auto padding = static_cast<std::size_t>(std::ranges::count(text, '='));
    if (size < 0 || padding >= GROUP || static_cast<std::size_t>(size) < padding) {
        return std::nullopt;
    }
    bytes.resize(static_cast<std::size_t>(size) - padding);
    return to_base64(bytes) == text ? std::optional(std::move(bytes)) : std::nullopt;
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
std::string copy_topic(std::string_view host, std::string_view group, std::string_view node,
                       std::string_view device) {
    return topic("copy", host, group, node, device);
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
    auto copies = nlohmann::json::array();
    for (const CopyFacts &one : report.copies) {
        copies.push_back(json_of(one));
    }
    return nlohmann::json{
        {"changes", changes}, {"open", report.open}, {"copies", copies}, {"room", report.hasRoom}}
        .dump();
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
    for (const nlohmann::json &one : fields.list("copies", MOST_COPIES)) {
        Fields copy(one);
        report.copies.push_back(read_facts(copy));
        fields.take_problem(copy);
    }
    report.hasRoom = fields.boolean("room");
    return fields.problem().empty() ? Result<Report>(std::move(report)) : fail(fields.problem());
}

std::string encode(const Copy &copy) {
    nlohmann::json document = json_of(copy.facts);
    document["name"] = copy.name;
    document["base64"] = to_base64(copy.bytes);
    return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<Copy> decode_copy(std::string_view json) {
    const auto document = parse(json, "copy");
    if (!document.has_value()) {
        return std::unexpected(document.error());
    }
    Fields fields(*document);
    Copy copy{read_facts(fields), read_words(fields, "name", MOST_NAME_BYTES), {}};
    const auto bytes = from_base64(fields.text("base64"));
    if (copy.name.empty() || copy.name.find_first_of("/\\") != std::string::npos) {
        fields.set_problem("\"name\" is not a plain file name");
    }
    if (!bytes.has_value() || bytes->size() > MOST_COPY_BYTES) {
        fields.set_problem(fmt::format("\"base64\" is damaged, or has more than {} bytes", MOST_COPY_BYTES));
    } else if (sha256_of_bytes(*bytes) != copy.facts.sha256) {
        fields.set_problem("the SHA-256 of the copy does not fit its bytes");
    }
    copy.bytes = bytes.value_or("");
    return fields.problem().empty() ? Result<Copy>(std::move(copy)) : fail(fields.problem());
}

std::string encode(const Reply &reply) {
    auto noted = nlohmann::json::array();
    for (const Note &one : reply.noted) {
        noted.push_back({{"id", one.id}, {"state", name_of(one.state)}});
    }
    nlohmann::json document{
        {"noted", std::move(noted)}, {"withdrawn", reply.withdrawn}, {"wanted", reply.wanted}};
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
    if (fields.has("wanted")) {  // take_report() of the database has none
        for (const nlohmann::json &one : fields.list("wanted", MOST_COPIES)) {
            reply.wanted.push_back(one.is_string() ? one.get<std::string>() : "");
        }
    }
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
