// SPDX-License-Identifier: GPL-2.0-or-later
// A client of a machine: commands with their outcome, status, messages. In the machine's process or in
// another.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mailbox/memory.hh"
#include "mailbox/segment.hh"

namespace mw::client {

using mailbox::Role;
using mailbox::Serial;

/// How a command stands or has ended.
struct Outcome {
    msgs::Progress progress = msgs::Progress::STARTED;
    std::string reason;  ///< of a refusal or failure
};

/// One thread. Leaves its place when it is destroyed; what it has started goes on.
class Client {
  public:
    /// Of a machine in another process, by the name of its instance.
    static Result<Client> connect(const std::string &instance, Role role = Role::OPERATOR);
    /// Of a machine in this process, which must outlive it.
    static Result<Client> join(mailbox::Segment &segment, Role role = Role::OPERATOR);
    ~Client();
    Client(Client &&other) noexcept;
    Client &operator=(Client &&other) noexcept;

    /// Number of this client, as the right to operate names it.
    mailbox::ClientId id() const { return id_; }

    /// Hands a command over; its number among those of all clients. An error when a value is out of range or
    /// MAX_POSTED commands wait. A stop is taken however many wait.
    Result<Serial> post(const msgs::Command &command);
    /// STARTED also while it waits to be taken. One that task no longer remembers is REFUSED, and its reason
    /// says so.
    Outcome outcome(Serial serial);
    /// Sleeps until the command ends; an error when the time is over or the machine is gone.
    Result<Outcome> wait(Serial serial, double timeout_s);

    /// What the machine is; empty until it is ready for clients.
    mailbox::Identity identity() const;
    /// Its task's process lives. Always true in that process.
    bool isMachineAlive() const { return !memory_.has_value() || memory_->isOwnerAlive(); }

    /// Brings status() up to date; an error before the first cycle and when task died within writing it.
    Result<> read_status();
    /// As it was read last.
    const msgs::MachineStatus &status() const { return status_->value; }
    /// Parts of it (msgs::status_part) that the last read has copied: the others are as they were.
    PartMask fresh_parts() const { return status_->fresh; }
    /// Sleeps until there is a newer status than the last one that was waited for.
    Result<> wait_status(double timeout_s);
    /// The tool table when it has changed since the last call; nothing otherwise.
    Result<std::optional<msgs::ToolTable>> read_tools();

    struct Message {
        std::uint64_t number = 0;
        msgs::MessageKind kind = msgs::MessageKind::OPERATOR_ERROR;
        std::string text;
    };
    /// The next message; nothing when there is none. Messages that were overwritten before they were read
    /// come as one that says how many.
    std::optional<Message> next_message();

  private:
    Client(mailbox::Segment &segment, int slot, mailbox::ClientId id);
    mailbox::Slot &slot() const { return segment_->slots[static_cast<std::size_t>(slot_)]; }
    void leave() noexcept;
    Serial post_stop(int place);
    bool isStopWaiting(Serial serial);
    /// False when task died within writing it.
    template <class Lock, class Value>
    bool read_whole(const Lock &lock, Value &value) const;
    Result<> sleep(std::uint32_t heard, std::int64_t end_ns);

    std::optional<mailbox::Memory> memory_;  ///< of another process
    mailbox::Segment *segment_ = nullptr;    ///< null after a move
    int slot_ = 0;
    mailbox::ClientId id_ = 0;
    std::uint64_t next_message_ = 1;
    std::uint64_t tools_version_ = 0;
    std::uint32_t heard_ = 0;
    std::unique_ptr<msgs::PublishedStatus::Copy> status_;
    /// The outcome that was asked for last, where it was found, and how many had been told by then.
    struct Found {
        Serial serial = 0;
        std::uint64_t told = 0;
        std::size_t place = 0;
        Outcome outcome;
    } found_;
    struct PostedStop {
        Serial serial = 0;
        int place = 0;
    };
    std::vector<PostedStop> posted_stops_;  ///< beside the queue, not seen as taken yet
    /// Stops that a later one of the same kind has taken the place of: number, and that of the later one.
    std::deque<std::pair<Serial, Serial>> replaced_stops_;
};

}  // namespace mw::client
