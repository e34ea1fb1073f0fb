// SPDX-License-Identifier: GPL-2.0-or-later
// The texts of a browser's socket, /api/socket, except for the fields of the status.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "messages/client/client.hh"

namespace mw::screen {

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
