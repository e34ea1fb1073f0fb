// SPDX-License-Identifier: GPL-2.0-or-later
// The JSON of docs/api.md, but for the fields of the status.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "client/client.hh"
#include "ui/web/exchange.hh"
#include "ui/web/machine_facts.hh"

namespace mw::ui::web {

/// {"error": "..."} with its status.
Response error_response(int status, std::string_view text);

/// Commands and status as they are declared.
std::string schema_document();
std::string machine_document(const MachineFacts &facts);

struct FileFacts {
    std::string name;
    std::uint64_t size = 0;
    std::int64_t modified_s = 0;  ///< since 1970
};
std::string files_document(std::span<const FileFacts> files);

/// {"ping": 12.5}
struct Ping {
    std::string number;  ///< as it came
};
/// {"id": 7, "command": {...}}
struct Ask {
    std::uint64_t id = 0;
    Result<msgs::Command> command;
};
/// What a text from a browser's socket is; an error when it is neither.
Result<std::variant<Ping, Ask>> read_text(std::string_view text);

struct Hello {
    std::string version;
    std::uint32_t client = 0;  ///< number in the mailbox, 0: no machine
    std::string session;
};
std::string hello_text(const Hello &hello);
std::string pong_text(const Ping &ping);
std::string outcome_text(std::uint64_t id, const client::Outcome &outcome);
std::string message_text(const client::Client::Message &message);
std::string machine_up_text(std::uint32_t client);
std::string machine_gone_text(std::string_view reason);
/// `status` is JSON already.
std::string status_text(std::string_view status, bool isWhole);

}  // namespace mw::ui::web
