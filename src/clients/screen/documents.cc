// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/documents.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json_parse.hh"
#include "messages/declarations/value.hh"
#include "messages/mailbox/stops.hh"

namespace mw::screen {
namespace {

using Json = nlohmann::ordered_json;

/// Larger numbers are not exact in a browser.
constexpr std::uint64_t MOST_ID = std::uint64_t{1} << 53;

std::string text_of(const Json &json) {
    constexpr int COMPACT = -1;
    constexpr bool IS_ASCII = false;
    return json.dump(COMPACT, ' ', IS_ASCII, Json::error_handler_t::replace);
}

std::string one(const char *key, Json value) {
    Json json = Json::object();
    json[key] = std::move(value);
    return text_of(json);
}

const char *kind_name(messages::Kind kind) {
    switch (kind) {
    case messages::Kind::BOOL: return "bool";
    case messages::Kind::INTEGER: return "integer";
    case messages::Kind::UNSIGNED: return "unsigned";
    case messages::Kind::REAL: return "real";
    case messages::Kind::NAMED: return "name";
    case messages::Kind::TEXT:
    case messages::Kind::FIXED_TEXT: return "text";
    case messages::Kind::PARTS: return "parts";
    }
    return "";
}

Json field_document(const messages::Field &field) {
    const messages::Type &type = field.type;
    Json json{{"name", field.name}, {"type", kind_name(type.kind)}};
    if (type.kind == messages::Kind::PARTS) {
        json["parts"] = type.parts->name;
    }
    if (!type.names.empty()) {
        Json &names = json["names"] = Json::array();
        for (const messages::Name &name : type.names) {
            names.push_back(name.name);
        }
    }
    if (type.list != nullptr) {
        json["list"] = true;
    } else if (type.isArray) {
        json["count"] = type.count;
    }
    const bool is_text = type.kind == messages::Kind::TEXT || type.kind == messages::Kind::FIXED_TEXT;
    if (std::isfinite(field.range.min)) {
        json["min"] = field.range.min;
    }
    if (std::isfinite(field.range.max)) {
        json["max"] = field.range.max;
    } else if (is_text) {
        json["max"] = messages::longest_text(field);
    }
    json["unit"] = field.unit;
    json["doc"] = field.doc;
    if (field.presence == messages::Presence::OPTIONAL) {
        json["optional"] = true;
    }
    return json;
}

Json declaration_document(const messages::Declaration &declaration) {
    Json json{{"name", declaration.name}, {"number", declaration.number}, {"doc", declaration.doc}};
    Json &fields = json["fields"] = Json::array();
    for (const messages::Field &field : declaration.fields) {
        fields.push_back(field_document(field));
    }
    return json;
}

Json declarations_document(std::span<const messages::Declaration *const> declarations) {
    Json json = Json::array();
    for (const messages::Declaration *declaration : declarations) {
        json.push_back(declaration_document(*declaration));
    }
    return json;
}

Result<Watch> read_watch(const Json &names) {
    const bool is_list = names.is_array() && names.size() <= Watch::MOST;
    if (!is_list || !std::ranges::all_of(names, [](const Json &name) { return name.is_string(); })) {
        return fail("what is watched is a list of at most " + std::to_string(Watch::MOST) + " names");
    }
    return Watch{names.get<std::vector<std::string>>()};
}

}  // namespace

Response error_response(int status, std::string_view text) {
    Response response;
    response.status = status;
    response.body = one("error", std::string(text));
    return response;
}

std::string schema_document() {
    return text_of(Json{{"commands", declarations_document(messages::command_declarations())},
                        {"status", declarations_document(messages::status_declarations())}});
}

namespace {

/// Parts of a panel, and whether the operator sets a value with them.
constexpr std::array<std::pair<std::string_view, bool>, 6> PARTS{{{"lamp", false},
                                                                  {"value", false},
                                                                  {"bar", false},
                                                                  {"button", true},
                                                                  {"switch", true},
                                                                  {"number", true}}};

Json tab_document(const Tab &tab) {
    switch (tab.kind) {
    case Tab::Kind::FRAME:
        return {{"name", tab.name}, {"location", tab.location}, {"kind", "frame"}, {"address", tab.content}};
    case Tab::Kind::PANEL:
        return {{"name", tab.name},
                {"location", tab.location},
                {"kind", "panel"},
                {"panel", messages::parse_json(tab.content)}};
    case Tab::Kind::PROGRAM: break;
    }
    return {{"name", tab.name}, {"location", tab.location}, {"kind", "program"}, {"command", tab.content}};
}

}  // namespace

Result<> check_panel(std::string_view text) {
    const Json json = messages::parse_json(text);
    const auto rows = json.is_object() ? json.find("parts") : json.end();
    if (!json.is_object() || rows == json.end() || !rows->is_array()) {
        return fail(R"(a panel is {"parts": [...]} in JSON)");
    }
    for (const Json &row : *rows) {
        const auto text_at = [&row](const char *key) {
            return row.is_object() && row.contains(key) && row[key].is_string() ? row[key].get<std::string>()
                                                                                : "";
        };
        const std::string kind = text_at("kind");
        if (std::ranges::find(PARTS, kind, &std::pair<std::string_view, bool>::first) == PARTS.end()) {
            return fail("'" + kind +
                        "' is no part of a panel: lamp, value, bar, button, switch and number are");
        }
        if (text_at("name").empty() || text_at("label").empty()) {
            return fail("each part of a panel has a label, and a name of HAL");
        }
    }
    return {};
}

std::vector<std::string> settable_names(std::string_view panel) {
    std::vector<std::string> names;
    if (check_panel(panel).has_value()) {
        const Json json = messages::parse_json(panel);  // must outlive its rows
        for (const Json &row : json["parts"]) {
            const auto kind = std::ranges::find(PARTS, row["kind"].get<std::string>(),
                                                &std::pair<std::string_view, bool>::first);
            if (kind->second) {
                names.push_back(row["name"].get<std::string>());
            }
        }
    }
    return names;
}

namespace {

const char *kind_name(MachineKind kind) {
    switch (kind) {
    case MachineKind::MILL: break;
    case MachineKind::LATHE: return "lathe";
    case MachineKind::BACK_LATHE: return "back_lathe";
    case MachineKind::FOAM: return "foam";
    }
    return "mill";
}

}  // namespace

std::string machine_document(const MachineFacts &facts) {
    Json increments = Json::array();
    for (const Increment &increment : facts.increments) {
        increments.push_back(
            {{"text", increment.text}, {"value", increment.value}, {"angular", increment.isAngular}});
    }
    Json spindles = Json::array();
    for (const SpindleFacts &spindle : facts.spindles) {
        spindles.push_back({{"min_override", spindle.min_override},
                            {"max_override", spindle.max_override},
                            {"min_speed", spindle.min_speed},
                            {"max_speed", spindle.max_speed},
                            {"default_speed", spindle.default_speed},
                            {"increment", spindle.increment}});
    }
    Json tabs = Json::array();
    for (const Tab &tab : facts.tabs) {
        tabs.push_back(tab_document(tab));
    }
    return text_of(Json{{"name", facts.name},
                        {"title", facts.title},
                        {"has_icon", !facts.files.icon.empty()},
                        {"keeps_mdi_history", !facts.files.mdi_history.empty()},
                        {"keeps_preferences", !facts.files.preferences.empty()},
                        {"tabs", std::move(tabs)},
                        {"min_linear_velocity", facts.min_linear_velocity},
                        {"min_angular_velocity", facts.min_angular_velocity},
                        {"spindles", std::move(spindles)},
                        {"ini", facts.ini},
                        {"instance", facts.instance},
                        {"axes", facts.axes},
                        {"kind", kind_name(facts.look.kind)},
                        {"geometry", facts.look.geometry},
                        {"foam_z", facts.look.foam_z},
                        {"foam_w", facts.look.foam_w},
                        {"joints", facts.joints},
                        {"joint_kinds", facts.joint_kinds},
                        {"is_homing_forced", facts.isHomingForced},
                        {"linear_unit", facts.linear_unit},
                        {"program_prefix", facts.program_prefix},
                        {"max_linear_velocity", facts.max_linear_velocity},
                        {"default_linear_velocity", facts.default_linear_velocity},
                        {"max_angular_velocity", facts.max_angular_velocity},
                        {"default_angular_velocity", facts.default_angular_velocity},
                        {"max_feed_override", facts.max_feed_override},
                        {"increments", std::move(increments)},
                        {"mdi_commands", facts.mdi_commands},
                        {"program_extensions", facts.program_extensions},
                        {"filter_extensions", facts.filters.extensions},
                        {"filtered_folder", facts.filters.folder}});
}

std::string lines_document(std::span<const std::string> lines) {
    return one("lines", std::vector<std::string>(lines.begin(), lines.end()));
}

std::optional<std::vector<std::string>> read_lines(std::string_view text, std::size_t most) {
    const Json json = messages::parse_json(text);
    const auto lines = json.is_object() ? json.find("lines") : json.end();
    if (!json.is_object() || lines == json.end() || !lines->is_array() || lines->size() > most) {
        return std::nullopt;
    }
    const bool are_lines = std::ranges::all_of(*lines, [](const Json &line) {
        return line.is_string() &&
               line.get_ref<const std::string &>().find_first_of("\r\n") == std::string::npos;
    });
    return are_lines ? std::optional(lines->get<std::vector<std::string>>()) : std::nullopt;
}

bool isObject(std::string_view json) {
    return messages::parse_json(json).is_object();
}

std::string offsets_document(std::span<const std::array<double, 10>> systems) {
    Json list = Json::array();
    for (const std::array<double, 10> &system : systems) {
        list.push_back({{"offset", std::vector<double>(system.begin(), system.end() - 1)},
                        {"rotation_deg", system.back()}});
    }
    return one("systems", std::move(list));
}

std::string filter_progress_text(int percent) {
    return one("progress", percent) + '\n';
}

std::string filter_made_text(std::string_view path) {
    return one("made", std::string(path)) + '\n';
}

std::string filter_error_text(std::string_view why) {
    return one("error", std::string(why)) + '\n';
}

std::string time_sum_document(const TimeSum &sum) {
    Json slowest = Json::array();
    for (const SlowSpot &spot : sum.slowest) {
        slowest.push_back({{"file", spot.file},
                           {"is_in_program", spot.in_program},
                           {"line", spot.line},
                           {"lost_s", spot.lost_s},
                           {"reason", spot.reason}});
    }
    return text_of(Json{{"total_s", sum.total_s},
                        {"cutting_s", sum.cutting_s},
                        {"rapid_s", sum.rapid_s},
                        {"dwell_s", sum.dwell_s},
                        {"is_complete", sum.isComplete},
                        {"slowest", std::move(slowest)}});
}

std::string files_document(std::span<const FileFacts> files) {
    Json list = Json::array();
    for (const FileFacts &file : files) {
        list.push_back({{"name", file.name}, {"size", file.size}, {"modified_s", file.modified_s}});
    }
    return one("files", std::move(list));
}

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

std::optional<std::string> token_of_login(std::string_view text) {
    const Json json = messages::parse_json(text);
    const auto token = json.is_object() ? json.find("token") : json.end();
    const bool is_token = json.is_object() && token != json.end() && token->is_string();
    return is_token ? std::optional(token->get<std::string>()) : std::nullopt;
}

std::string hello_text(const Hello &hello) {
    return one("hello", Json{{"version", hello.version},
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
    return one("outcome", std::move(json));
}

std::string message_kind(const client::Client::Message &message) {
    const auto found = std::ranges::find(messages::NAMES<messages::MessageKind>,
                                         static_cast<std::int64_t>(message.kind), &messages::Name::value);
    return found != messages::NAMES<messages::MessageKind>.end() ? std::string(found->name) : "TEXT";
}

std::string message_text(const client::Client::Message &message, std::uint64_t run) {
    return one("message", Json{{"number", message.number},
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
    return one("note", std::string(note));
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
