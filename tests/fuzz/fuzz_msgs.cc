// SPDX-License-Identifier: GPL-2.0-or-later
// Commands and statuses of clients, as bytes and as JSON.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "messages/declarations/binary.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/status.hh"

namespace {

void require(bool isTrue) {
    if (!isTrue) {
        std::abort();
    }
}

/// Accepted messages are within their ranges, and both forms have the same meaning.
void check_taken(const mw::messages::Command &command) {
    require(mw::messages::check(command).has_value());
    const std::string bytes = mw::messages::encode(command);
    const auto again = mw::messages::decode_command(bytes);
    require(again.has_value() && mw::messages::encode(*again) == bytes);
    require(mw::messages::to_text(command).find('\n') == std::string::npos);
    static_cast<void>(mw::messages::to_json(command));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text(reinterpret_cast<const char *>(data), size);
    if (const auto command = mw::messages::decode_command(text)) {
        require(mw::messages::encode(*command) == text);
        check_taken(*command);
    }
    if (const auto command = mw::messages::command_from_json(text)) {
        check_taken(*command);
        const auto again = mw::messages::command_from_json(mw::messages::to_json(*command));
        require(again.has_value() && mw::messages::encode(*again) == mw::messages::encode(*command));
    }
    static mw::messages::MachineStatus status;
    static mw::messages::ToolTable tools;
    static_cast<void>(mw::messages::decode(text, mw::messages::object(status)));
    static_cast<void>(mw::messages::decode(text, mw::messages::object(tools)));
    static_cast<void>(mw::messages::from_json(text, mw::messages::object(tools)));
    return 0;
}
