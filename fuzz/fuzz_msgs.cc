// SPDX-License-Identifier: GPL-2.0-or-later
// Commands and statuses of clients, as bytes and as JSON.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "msgs/binary.hh"
#include "msgs/catalogue.hh"
#include "msgs/json.hh"
#include "msgs/status.hh"

namespace {

void require(bool isTrue) {
    if (!isTrue) {
        std::abort();
    }
}

/// What was taken is within its ranges, and each form of it means the same.
void check_taken(const mw::msgs::Command &command) {
    require(mw::msgs::check(command).has_value());
    const std::string bytes = mw::msgs::encode(command);
    const auto again = mw::msgs::decode_command(bytes);
    require(again.has_value() && mw::msgs::encode(*again) == bytes);
    require(mw::msgs::to_text(command).find('\n') == std::string::npos);
    static_cast<void>(mw::msgs::to_json(command));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text(reinterpret_cast<const char *>(data), size);
    if (const auto command = mw::msgs::decode_command(text)) {
        require(mw::msgs::encode(*command) == text);
        check_taken(*command);
    }
    if (const auto command = mw::msgs::command_from_json(text)) {
        check_taken(*command);
        const auto again = mw::msgs::command_from_json(mw::msgs::to_json(*command));
        require(again.has_value() && mw::msgs::encode(*again) == mw::msgs::encode(*command));
    }
    static mw::msgs::MachineStatus status;
    static mw::msgs::ToolTable tools;
    static_cast<void>(mw::msgs::decode(text, mw::msgs::object(status)));
    static_cast<void>(mw::msgs::decode(text, mw::msgs::object(tools)));
    static_cast<void>(mw::msgs::from_json(text, mw::msgs::object(tools)));
    return 0;
}
