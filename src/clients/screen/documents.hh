// SPDX-License-Identifier: GPL-2.0-or-later
// The JSON documents of docs/reference/api.md, except for the fields of the status.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "clients/screen/facts/machine_facts.hh"
#include "clients/screen/http/http_types.hh"
#include "clients/screen/path/time_chunks.hh"
#include "messages/client/client.hh"

namespace mw::screen {

/// {"error": "..."} with its HTTP status.
Response error_response(int status, std::string_view text);

/// Declarations of commands and status.
std::string schema_document();
/// An error if it is not a panel as described in docs/user/screen.md.
Result<> check_panel(std::string_view text);
/// HAL names that an operator may set by this panel without other rights.
std::vector<std::string> settable_names(std::string_view panel);
std::string machine_document(const MachineFacts &facts);

std::string lines_document(std::span<const std::string> lines);
/// Reads {"lines": [...]}; nothing if the text has another form or more than `most` lines.
std::optional<std::vector<std::string>> read_lines(std::string_view text, std::size_t most);
bool isObject(std::string_view json);
/// Nine offsets and the rotation [deg] of each coordinate system.
std::string offsets_document(std::span<const std::array<double, 10>> systems);

/// Report of a filter: its progress, or its result.
std::string filter_progress_text(int percent);
std::string filter_made_text(std::string_view path);
std::string filter_error_text(std::string_view why);
std::string time_sum_document(const TimeSum &sum);

struct FileFacts {
    std::string name;
    std::uint64_t size = 0;
    std::int64_t modified_s = 0;  ///< seconds since 1970
};
std::string files_document(std::span<const FileFacts> files);

/// {"ping": 12.5}
struct Ping {
    std::string number;  ///< the number of the ping as text, unchanged
};
/// {"id": 7, "command": {...}}
struct Ask {
    std::uint64_t id = 0;
    Result<messages::Command> command;
    std::optional<double> sent_ms{};  ///< time by the sender's clock
};
/// {"watch": ["joint.0.pos-cmd"]}: HAL pins, signals and parameters.
struct Watch {
    static constexpr std::size_t MOST = 256;
    std::vector<std::string> names;
};
/// Parses a text from a browser's socket; an error for other texts.
Result<std::variant<Ping, Ask, Watch>> read_text(std::string_view text);

/// The token of {"token": "..."}; nothing for other texts.
std::optional<std::string> token_of_login(std::string_view text);

struct Hello {
    std::string version;
    std::string_view role, protection;
    std::uint32_t client = 0;  ///< number in the mailbox, 0: no machine
    std::string session;
};
std::string hello_text(const Hello &hello);
std::string pong_text(const Ping &ping);
std::string outcome_text(std::uint64_t id, const client::Outcome &outcome);
/// "ERROR", "TEXT", "DISPLAY".
std::string message_kind(const client::Client::Message &message);
/// `run` is that of the machine (client::Viewer::run).
std::string message_text(const client::Client::Message &message, std::uint64_t run);
std::string machine_up_text(std::uint32_t client);
std::string machine_gone_text(std::string_view reason);
/// {"questions": [...]}; the argument is JSON.
std::string questions_text(std::string_view questions);
/// {"note": "..."}: a note of HAL to the operator.
std::string note_text(std::string_view note);
/// {"hal": {"joint.0.pos-cmd": 1.5}}; the values are JSON.
std::string values_text(const std::map<std::string, std::string> &values);
/// `status` is JSON.
std::string status_text(std::string_view status, bool isWhole);

}  // namespace mw::screen
