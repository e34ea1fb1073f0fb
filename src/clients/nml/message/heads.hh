// SPDX-License-Identifier: GPL-2.0-or-later
// The base classes of NML messages (F5): the fields before those of every command and every status.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "messages/declarations/describe.hh"

namespace mw::nml {

/// State of a command. The numbers are those that LinuxCNC's clients compare.
enum class CommandState : std::uint8_t { UNKNOWN = 0, DONE = 1, EXECUTING = 2, ERROR = 3 };

/// Base class of a message.
enum class Base : std::uint8_t { PLAIN, COMMAND, STATUS };
constexpr const char *name_of(Base base) {
    return base == Base::COMMAND ? "command" : base == Base::STATUS ? "status" : "message";
}

struct PlainHead {};

struct CommandHead {
    std::uint64_t serial_number = 0;
};

/// Result of one command of the channel, or that it is being executed.
struct CommandOutcome {
    std::uint64_t serial_number = 0;  ///< 0: none
    CommandState state = CommandState::UNKNOWN;
    messages::FixedText<255> reason;  ///< reason for ERROR
};
/// Number of commands whose outcome a status reports, because several clients write to one channel.
inline constexpr std::size_t RECENT_COMMANDS = 16;

struct StatusHead {
    int command_type = 0;
    std::uint64_t echo_serial_number = 0;
    CommandState state = CommandState::UNKNOWN;
    messages::FixedText<255> reason;  ///< reason for ERROR
    std::array<CommandOutcome, RECENT_COMMANDS> recent{};
};

/// A message of a type that is known at compile time.
template <class Body>
struct PlainMessage {
    PlainHead head;
    Body body;
};
template <class Body>
struct CommandMessage {
    CommandHead head;
    Body body;
};
template <class Body>
struct StatusMessage {
    StatusHead head;
    Body body;
};

}  // namespace mw::nml

namespace mw::messages {

template <>
inline constexpr auto NAMES<nml::CommandState> =
    std::array{named(nml::CommandState::UNKNOWN, "UNKNOWN"), named(nml::CommandState::DONE, "DONE"),
               named(nml::CommandState::EXECUTING, "EXECUTING"), named(nml::CommandState::ERROR, "ERROR")};

template <>
inline constexpr auto DECLARED<nml::PlainHead> =
    declare("PlainHead", 0, "of a message that is neither command nor status");
template <>
inline constexpr auto DECLARED<nml::CommandHead> =
    declare("CommandHead", 0, "of every command",
            field<&nml::CommandHead::serial_number>("serial_number", "by which its status is recognised"));
template <>
inline constexpr auto DECLARED<nml::CommandOutcome> =
    declare("CommandOutcome", 0, "state of one command",
            field<&nml::CommandOutcome::serial_number>("serial_number", "of the command, 0: none"),
            field<&nml::CommandOutcome::state>("state", "of the command"),
            field<&nml::CommandOutcome::reason>("reason", "why it was rejected or has failed"));
template <>
inline constexpr auto DECLARED<nml::StatusHead> =
    declare("StatusHead", 0, "of every status",
            field<&nml::StatusHead::command_type>("command_type", "number of the last command, 0: none"),
            field<&nml::StatusHead::echo_serial_number>("echo_serial_number", "of that command"),
            field<&nml::StatusHead::state>("state", "state of that command"),
            field<&nml::StatusHead::reason>("reason", "why it was rejected or has failed"),
            field<&nml::StatusHead::recent>("recent", "the last commands, in no order"));

}  // namespace mw::messages
