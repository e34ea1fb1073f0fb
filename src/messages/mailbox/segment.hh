// SPDX-License-Identifier: GPL-2.0-or-later
// The memory between task and its clients, in one process or shared between several. It contains no pointers
// and no locks: if a process is killed at any instruction, the memory is still usable for all others.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "base/seqlock.hh"
#include "base/spsc_ring.hh"
#include "messages/declarations/status_parts.hh"
#include "messages/mailbox/right_to_operate.hh"
#include "messages/mailbox/stops.hh"

namespace mw::mailbox {

/// Number of a command, counted over all clients from 1.
using Serial = std::uint64_t;

inline constexpr int MAX_CLIENTS = 32;
/// Maximum number of commands of one client that task has not taken yet.
inline constexpr std::uint32_t MAX_POSTED = 16;
/// Number of commands of one client whose outcomes are stored; outcomes of commands under way are always
/// stored.
inline constexpr int MAX_OUTCOMES = 64;
inline constexpr int MAX_MESSAGES = 256;
/// Maximum size of one command in the binary form. [bytes]
inline constexpr std::size_t MAX_COMMAND = 1100;
/// Maximum size of a tool table in the binary form. [bytes]
inline constexpr std::size_t MAX_TOOL_BYTES = 512UL * 1024;

struct Posted {
    Serial serial = 0;
    std::uint32_t size = 0;
    std::array<char, MAX_COMMAND> bytes{};
};

struct Outcome {
    Serial serial = 0;
    messages::Progress progress = messages::Progress::STARTED;
    messages::FixedText<491> reason;  ///< reason of a rejection or failure
};

struct NumberedMessage {
    std::uint64_t number = 0;  ///< from 1
    std::int64_t at_ns = 0;    ///< time of the message (CLOCK_MONOTONIC)
    messages::MessageKind kind = messages::MessageKind::OPERATOR_ERROR;
    messages::FixedText<1023> text;
};

struct Bytes {
    std::uint64_t version = 0;  ///< 0: no data yet
    std::uint64_t size = 0;
    std::array<char, MAX_TOOL_BYTES> bytes{};
};

/// Role of a client at the mailbox.
enum class Role : std::uint8_t {
    OPERATOR,  ///< another client's right to operate affects it
    PANEL,     ///< wired to the machine (halui): the right to operate never affects it
    ATTENDED,  ///< as OPERATOR, and work that it has started is aborted when it leaves or dies
};

/// Resources of this computer that the commands of a client may access (docs/integrator/security.md). The
/// lesser of two values is their std::min; an empty slot has the least.
enum class Authority : std::uint8_t {
    OPERATE,    ///< programs in the program folder, logs in it, no lines of Python
    CONFIGURE,  ///< all files of the machine's user, and Python
};

/// Identity of the machine, written when it is ready for clients.
struct Identity {
    messages::FixedText<1023> ini;  ///< path of the INI file
    bool isLasting = false;         ///< the machine keeps running after a program has ended, for any client
};

/// Slot of a client. A free slot has no owner. The owner's word is set in one step, so that task always knows
/// whether the process that took the slot is alive.
struct Slot {
    std::atomic<std::uint64_t> owner{0};     ///< [client takes the slot, task frees it] owner_word(), 0: free
    std::atomic<std::uint32_t> client{0};    ///< id of the client, written after the owner
    std::atomic<std::uint8_t> role{0};       ///< Role
    std::atomic<std::uint8_t> isLeaving{0};  ///< the client has ended; task frees the slot
    std::atomic<std::uint8_t> authority{0};  ///< Authority, written before the first command
    std::atomic<Serial> taken{0};            ///< [task] the last command taken from the slot
    SpscRing<Posted, MAX_POSTED> posted;     ///< client -> task
    /// Stops for which `posted` has no space: the number of the newest stop of each type, 0: none. The client
    /// writes the number; task clears it after it has written the stop's outcome.
    std::array<std::atomic<Serial>, STOP_PLACES> stops{};
    std::atomic<Serial> newest_stop{0};                   ///< [client] written after the stop in `stops`
    std::array<Seqlock<Outcome>, MAX_OUTCOMES> outcomes;  ///< task -> client
    std::atomic<std::uint64_t> told{0};                   ///< [task] number of outcomes written
};

/// An all-zero segment is empty.
struct Segment {
    std::atomic<Serial> serials{0};       ///< numbers assigned to commands
    std::atomic<ClientId> client_ids{0};  ///< numbers assigned to clients
    std::array<Slot, MAX_CLIENTS> slots;
    Seqlock<Identity> identity;  ///< [machine's process] written once

    messages::PublishedStatus status;  ///< [task] written once in each cycle
    std::atomic<std::uint64_t> cycles{0};
    Seqlock<Bytes> tools;  ///< [task] written when the table changes
    std::atomic<std::uint64_t> tools_version{0};

    std::array<Seqlock<NumberedMessage>, MAX_MESSAGES> messages;  ///< [task] message n is at index n modulo
                                                                  ///< the size
    std::atomic<std::uint64_t> newest_message{0};
    std::atomic<std::uint64_t> read_message{0};    ///< number of the newest message that any client has read
    std::atomic<std::uint64_t> logged_message{0};  ///< number of the newest message written to
                                                   ///< [DISPLAY]LOG_FILE
    /// [task] A random number of this start of the machine, not 0. Together with it a message number is
    /// unique.
    std::atomic<std::uint64_t> run{0};

    std::atomic<std::uint32_t> bell{0};  ///< a futex: changes once in each cycle
    std::atomic<std::uint32_t> waiting{
        0};  ///< number of clients that may sleep at the bell; a killed client remains counted
};

}  // namespace mw::mailbox
