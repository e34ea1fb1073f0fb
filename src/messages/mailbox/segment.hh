// SPDX-License-Identifier: GPL-2.0-or-later
// The memory between task and its clients: in one process or shared between several. Holds no pointers and no
// locks: a process that is killed, at any instruction, leaves it usable for all others.
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

/// One count for the commands of all clients, from 1.
using Serial = std::uint64_t;

inline constexpr int MAX_CLIENTS = 32;
/// Commands of one client that task has not taken yet.
inline constexpr std::uint32_t MAX_POSTED = 16;
/// Commands of one client whose outcome is remembered; those under way always are.
inline constexpr int MAX_OUTCOMES = 64;
inline constexpr int MAX_MESSAGES = 256;
/// Bytes of one command in the binary form.
inline constexpr std::size_t MAX_COMMAND = 1100;
/// Bytes of a tool table in the binary form.
inline constexpr std::size_t MAX_TOOL_BYTES = 512UL * 1024;

struct Posted {
    Serial serial = 0;
    std::uint32_t size = 0;
    std::array<char, MAX_COMMAND> bytes{};
};

struct Outcome {
    Serial serial = 0;
    messages::Progress progress = messages::Progress::STARTED;
    messages::FixedText<491> reason;  ///< why it was rejected or has failed
};

struct NumberedMessage {
    std::uint64_t number = 0;  ///< from 1
    std::int64_t at_ns = 0;    ///< CLOCK_MONOTONIC when it appeared
    messages::MessageKind kind = messages::MessageKind::OPERATOR_ERROR;
    messages::FixedText<1023> text;
};

struct Bytes {
    std::uint64_t version = 0;  ///< 0: nothing yet
    std::uint64_t size = 0;
    std::array<char, MAX_TOOL_BYTES> bytes{};
};

/// Role of a client at the mailbox.
enum class Role : std::uint8_t {
    OPERATOR,  ///< subject to another's right to operate
    PANEL,     ///< wired to the machine (halui): never
    ATTENDED,  ///< as OPERATOR; what it has begun is aborted when it leaves or dies: it watches over its work
};

/// What the commands of a client may reach on this computer besides the machine
/// (docs/integrator/security.md). The lesser of two is their std::min; an empty slot has the
/// least.
enum class Authority : std::uint8_t {
    OPERATE,    ///< programs of the program folder, logs in it, no lines of Python
    CONFIGURE,  ///< all files of the machine's user, and Python
};

/// Identity of the machine, written when it is ready for clients.
struct Identity {
    messages::FixedText<1023> ini;  ///< path of the INI file
    bool isLasting = false;         ///< stays up when a program has ended, for any client
};

/// A client's place. A free one has no owner; the owner's word is set in one step, so that task always
/// knows whether the process that took it is alive.
struct Slot {
    std::atomic<std::uint64_t> owner{0};     ///< [client takes it, task frees it] owner_word(), 0: free
    std::atomic<std::uint32_t> client{0};    ///< its id, written after the owner
    std::atomic<std::uint8_t> role{0};       ///< Role
    std::atomic<std::uint8_t> isLeaving{0};  ///< the client is done; task frees the slot
    std::atomic<std::uint8_t> authority{0};  ///< Authority, written before the first command
    std::atomic<Serial> taken{0};            ///< [task] the last command taken from it
    SpscRing<Posted, MAX_POSTED> posted;     ///< client -> task
    /// Stops for which `posted` has no space: the number of the newest one of each type, 0: none. The client
    /// writes it, task clears it once the stop's outcome is written.
    std::array<std::atomic<Serial>, STOP_PLACES> stops{};
    std::atomic<Serial> newest_stop{0};                   ///< [client] written after its place in `stops`
    std::array<Seqlock<Outcome>, MAX_OUTCOMES> outcomes;  ///< task -> client
    std::atomic<std::uint64_t> told{0};                   ///< [task] counts what it has written there
};

/// All zero is an empty one.
struct Segment {
    std::atomic<Serial> serials{0};       ///< given out
    std::atomic<ClientId> client_ids{0};  ///< given out
    std::array<Slot, MAX_CLIENTS> slots;
    Seqlock<Identity> identity;  ///< [the process of the machine] once

    messages::PublishedStatus status;  ///< [task] once a cycle
    std::atomic<std::uint64_t> cycles{0};
    Seqlock<Bytes> tools;  ///< [task] when the table changes
    std::atomic<std::uint64_t> tools_version{0};

    std::array<Seqlock<NumberedMessage>, MAX_MESSAGES> messages;  ///< [task] number n at n modulo their count
    std::atomic<std::uint64_t> newest_message{0};
    std::atomic<std::uint64_t> read_message{0};    ///< the newest that any client has read
    std::atomic<std::uint64_t> logged_message{0};  ///< the newest that is written to [DISPLAY]LOG_FILE
    /// [task] A random number of this start of the machine, not 0. With its number a message is unique.
    std::atomic<std::uint64_t> run{0};

    std::atomic<std::uint32_t> bell{0};  ///< a futex: changes once a cycle
    std::atomic<std::uint32_t> waiting{
        0};  ///< clients that may be asleep at it; one that was killed stays counted
};

}  // namespace mw::mailbox
