// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/session/socket_texts.hh"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "clients/screen/http/json_text.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json_parse.hh"

namespace mw::screen {
namespace {

/// Larger numbers are not exact in a browser.
constexpr std::uint64_t MOST_ID = std::uint64_t{1} << 53;

Result<Watch> read_watch(const Json &names) {
    const bool is_list = names.is_array() && names.size() <= Watch::MOST;
    if (!is_list || !std::ranges::all_of(names, [](const Json &name) { return name.is_string(); })) {
        return fail("what is watched is a list of at most " + std::to_string(Watch::MOST) + " names");
    }
    return Watch{names.get<std::vector<std::string>>()};
}

}  // namespace

Result<std::variant<Ping, Ask, Watch>> read_text(std::string_view text) {
    const Json json = messages::parse_json(text);
    if (!json.is_object()) {
        return fail("this is no JSON object of at most 16 levels");
    }
    const auto ping = json.find("ping");
    if (ping != json.end() && ping->is_number() && json.size() == 1) {
        return Ping{ping->dump()};
    }
    if (json.contains("watch") && json.size() == 1) {
        auto watch = read_watch(json["watch"]);
        return watch.has_value() ? Result<std::variant<Ping, Ask, Watch>>(std::move(*watch))
                                 : std::unexpected(watch.error());
    }
    const auto id = json.find("id");
    const auto command = json.find("command");
    const auto sent = json.find("sent");
    const bool dated = sent != json.end() && sent->is_number() && std::isfinite(sent->get<double>());
    if (id == json.end() || command == json.end() || json.size() != (dated ? 3 : 2)) {
        return fail(R"(a text is {"ping": number}, {"watch": [names]} or {"id": number, "command": {...}}, )"
                    R"(with "sent": number)");
    }
    if (!id->is_number_unsigned() || id->get<std::uint64_t>() > MOST_ID) {
        return fail("the id of a command is a whole number from 0 to 2^53");
    }
    return Ask{id->get<std::uint64_t>(), messages::command_from_json(text_of(*command)),
               dated ? std::optional(sent->get<double>()) : std::nullopt};
}

std::string hello_text(const Hello &hello) {
    return member_text("hello", Json{{"version", hello.version},
                                     {"client", hello.client},
                                     {"role", hello.role},
                                     {"protection", hello.protection},
                                     {"session", hello.session}});
}

std::string pong_text(const Ping &ping) {
    return R"({"pong":)" + ping.number + '}';
}

std::string outcome_text(std::uint64_t id, const client::Outcome &outcome) {
    const auto found = std::ranges::find(messages::NAMES<messages::Progress>,
                                         static_cast<std::int64_t>(outcome.progress), &messages::Name::value);
    Json json{{"id", id}, {"progress", found->name}};
    if (!outcome.reason.empty()) {
        json["reason"] = outcome.reason;
    }
    return member_text("outcome", std::move(json));
}

std::string message_kind(const client::Client::Message &message) {
    const auto found = std::ranges::find(messages::NAMES<messages::MessageKind>,
                                         static_cast<std::int64_t>(message.kind), &messages::Name::value);
    return found != messages::NAMES<messages::MessageKind>.end() ? std::string(found->name) : "TEXT";
}

std::string message_text(const client::Client::Message &message, std::uint64_t run) {
    return member_text("message", Json{{"number", message.number},
                                       {"run", fmt::format("{:016x}", run)},
                                       {"kind", "OPERATOR_" + message_kind(message)},
                                       {"text", message.text}});
}

std::string machine_up_text(std::uint32_t client) {
    return text_of(Json{{"machine", "up"}, {"client", client}});
}

std::string machine_gone_text(std::string_view reason) {
    return text_of(Json{{"machine", "gone"}, {"reason", std::string(reason)}});
}

std::string questions_text(std::string_view questions) {
    return R"({"questions":)" + std::string(questions) + '}';
}

std::string note_text(std::string_view note) {
    return member_text("note", std::string(note));
}

std::string values_text(const std::map<std::string, std::string> &values) {
    std::string text = R"({"hal":{)";
    bool is_first = true;
    for (const auto &[name, value] : values) {
        text += (is_first ? "" : ",") + text_of(name) + ':' + value;
        is_first = false;
    }
    return text + "}}";
}

std::string status_text(std::string_view status, bool whole) {
    return R"({"status":)" + std::string(status) + (whole ? R"(,"full":true})" : "}");
}

}  // namespace mw::screen
