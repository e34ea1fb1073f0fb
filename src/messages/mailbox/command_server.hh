// SPDX-License-Identifier: GPL-2.0-or-later
// Task's side of the mailbox: takes commands; reports outcomes, messages and status.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "messages/declarations/command.hh"
#include "messages/mailbox/right_to_operate.hh"
#include "messages/mailbox/segment.hh"

namespace mw::mailbox {

/// All calls come from one thread. Never waits for a client. All data from clients is checked before use.
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

    /// The handler of commands about the right to operate.
    enum class Rights : std::uint8_t { HERE, DELIVERED };

    /// `clock` returns the time of messages [ns]; without a clock it is CLOCK_MONOTONIC, which all processes
    /// share.
    explicit CommandServer(Segment &segment, Rights rights = Rights::HERE,
                           std::function<std::int64_t()> clock = {});

    /// Called once in each cycle. Returns the new commands of all clients in the order of their numbers.
    /// Rejects invalid commands (bytes that are not a command, values out of range, no right to operate).
    /// Handles commands about the right to operate. Slots of dead clients become free.
    std::vector<Delivery> take(std::int64_t now_ns);
    /// Reports the progress of a command. An end is final. The end of the newest command is also in the
    /// status.
    void tell(Serial serial, messages::Progress progress, const std::string &reason);

    /// Rejects commands that have not started.
    void refuse(const std::vector<Serial> &commands, const std::string &reason) {
        for (const Serial command : commands) {
            tell(command, messages::Progress::REFUSED, reason);
        }
    }

    /// Posts a line for the operator; a longer text ends with "...".
    void post(messages::MessageKind kind, std::string_view text);
    std::uint64_t newest_message() const { return segment_.newest_message.load(std::memory_order_relaxed); }
    /// Publishes the status of this cycle, with the right to operate and the last command filled in, and
    /// wakes clients. Of the values of motion only `motion_parts` (messages::status_part) may differ from the
    /// last cycle.
    void publish(messages::MachineStatus &status, PartMask motion_parts = messages::PublishedStatus::ALL);
    /// False when the table is larger than MAX_TOOL_BYTES; clients keep the previous table.
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
    /// Stores the end of a command that task never receives as the end of the last command.
    void note(Serial serial, messages::Progress progress);
    /// Handles a command about the right to operate; true if the command ends here.
    bool operate(const Delivery &delivery);
    int free_outcome(int slot) const;
    void write(const Place &place);
    void check_owner(int index, std::vector<Delivery> &out);
    /// Posts the stop that ends the work of an attended client that has ended.
    void stop_unattended(int index, std::vector<Delivery> &out);
    bool isConnected(ClientId client) const;

    Segment &segment_;
    Rights rights_;
    std::function<std::int64_t()> clock_;
    RightToOperate right_;
    std::map<Serial, Place> going_;  ///< commands under way
    /// The command of each outcome, and whether it is under way.
    std::array<std::array<Serial, MAX_OUTCOMES>, MAX_CLIENTS> serials_{};
    std::array<Serial, MAX_CLIENTS> newest_stops_{};  ///< numbers reported by each client, all checked
    Posted posted_;                                   ///< the command being taken
    bool full_ = false;  ///< in the last cycle each slot for ordinary clients had an owner
    Serial last_command_ = 0;
    messages::Progress last_progress_ = messages::Progress::DONE;
    std::uint64_t cycles_ = 0;
    std::int64_t now_ns_ = 0;
};

}  // namespace mw::mailbox
