// SPDX-License-Identifier: GPL-2.0-or-later
// Task's side of the mailbox: takes commands, reports outcomes, messages and status.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "messages/declarations/command.hh"
#include "messages/mailbox/right_to_operate.hh"
#include "messages/mailbox/segment.hh"

namespace mw::mailbox {

/// One thread. Never waits for a client. Everything that clients have written is checked before it is used.
class CommandServer {
  public:
    struct Delivery {
        Serial serial = 0;
        ClientId client = 0;
        messages::Command command;
        bool isPanel = false;
        Authority authority = Authority::OPERATE;
        std::uint64_t owner = 0;  ///< owner_word() of the client's process
    };

    /// Where commands about the right to operate end.
    enum class Rights : std::uint8_t { HERE, DELIVERED };

    /// `clock` gives the time of messages [ns]; without one it is CLOCK_MONOTONIC, which all processes share.
    explicit CommandServer(Segment &segment, Rights rights = Rights::HERE,
                           std::function<std::int64_t()> clock = {});

    /// Once a cycle. The new commands of all clients in the order of their numbers. Invalid
    /// commands (bytes that are no command, values out of range, no right to operate) are rejected here;
    /// commands about the right to operate end here. Places of dead clients become free.
    std::vector<Delivery> take(std::int64_t now_ns);
    /// How far a command has come. An end is final. That of the newest command is also in the status.
    void tell(Serial serial, messages::Progress progress, const std::string &reason);

    /// The same of commands that have not started.
    void refuse(const std::vector<Serial> &commands, const std::string &reason) {
        for (const Serial command : commands) {
            tell(command, messages::Progress::REFUSED, reason);
        }
    }

    /// A line for the operator; a longer one ends with "...".
    void post(messages::MessageKind kind, std::string_view text);
    std::uint64_t newest_message() const { return segment_.newest_message.load(std::memory_order_relaxed); }
    /// The status of this cycle; the right to operate and the last command are filled in. Wakes clients. Of
    /// the values of motion only `motion_parts` (messages::status_part) may differ from the last cycle.
    void publish(messages::MachineStatus &status, PartMask motion_parts = messages::PublishedStatus::ALL);
    /// False when the table is larger than MAX_TOOL_BYTES; clients keep the one before.
    bool publish_tools(const messages::ToolTable &table);

  private:
    struct Place {
        int slot = 0, outcome = 0;
        Outcome written;
    };

    void take_slot(int index, std::vector<Delivery> &out);
    struct WaitingStop {
        Serial serial = 0;
        int place = 0;
    };
    /// Stops that wait beside the queue of a client, in the order of their numbers.
    std::vector<WaitingStop> waiting_stops(int index);
    void accept(int index, Serial serial, Result<messages::Command> command, std::vector<Delivery> &out);
    /// The end of a command that task never gets is also that of the last command.
    void note(Serial serial, messages::Progress progress);
    /// The command ends here when it is about the right to operate.
    bool operate(const Delivery &delivery);
    int free_outcome(int slot) const;
    void write(const Place &place);
    void check_owner(int index, std::vector<Delivery> &out);
    /// The stop that ends the work of an attended client that has ended.
    void stop_unattended(int index, std::vector<Delivery> &out);
    bool isConnected(ClientId client) const;

    Segment &segment_;
    Rights rights_;
    std::function<std::int64_t()> clock_;
    RightToOperate right_;
    std::map<Serial, Place> going_;  ///< commands under way
    /// Which command each outcome belongs to, and whether it is under way.
    std::array<std::array<Serial, MAX_OUTCOMES>, MAX_CLIENTS> serials_{};
    std::array<Serial, MAX_CLIENTS> newest_stops_{};  ///< as each client reported, all checked
    Posted posted_;                                   ///< the one being taken
    bool full_ = false;  ///< in the last cycle each place for ordinary clients had an owner
    Serial last_command_ = 0;
    messages::Progress last_progress_ = messages::Progress::DONE;
    std::uint64_t cycles_ = 0;
    std::int64_t now_ns_ = 0;
};

}  // namespace mw::mailbox
