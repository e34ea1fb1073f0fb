// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a machine without commanding it: status, tool table, messages. In the machine's process or in
// another.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "base/patient_read.hh"
#include "messages/client/machine_link.hh"
#include "messages/mailbox/memory.hh"
#include "messages/mailbox/segment.hh"

namespace mw::client {

/// One thread. Occupies no client slot: any number of viewers may read, at no cost for task.
class Viewer {
  public:
    /// Of a machine in another process, by the name of its instance.
    static Result<Viewer> attach(const std::string &instance);
    /// Of a machine in this process, which must outlive it.
    explicit Viewer(mailbox::Segment &segment);
    /// Of a machine on another computer.
    explicit Viewer(std::shared_ptr<MachineLink> link);

    mailbox::Segment &segment() const { return *segment_; }
    /// What the machine is; empty until it is ready for clients.
    mailbox::Identity identity() const;
    /// Its task's process lives. Always true in that process.
    bool isMachineAlive() const { return check_machine().has_value(); }
    /// An error when that process has ended, or when the connection to it is lost.
    Result<> check_machine() const;
    /// Null for a machine on this computer.
    MachineLink *link() const { return link_.get(); }

    /// Its process; this one for a machine in this process.
    int machine_pid() const;

    /// Brings status() up to date; an error before the first cycle and when task died within writing it.
    Result<> read_status();
    /// As it was read last.
    const messages::MachineStatus &status() const { return status_->value; }
    /// Parts of it (messages::status_part) that the last read has copied: the others are as they were.
    PartMask fresh_parts() const { return status_->fresh; }
    /// Sleeps until there is a newer status than the last one that was waited for.
    Result<> wait_status(double timeout_s);
    /// The tool table when it has changed since the last call; nothing otherwise.
    Result<std::optional<messages::ToolTable>> read_tools();

    struct Message {
        std::uint64_t number = 0;
        std::int64_t at_ns = 0;  ///< CLOCK_MONOTONIC when it appeared
        messages::MessageKind kind = messages::MessageKind::OPERATOR_ERROR;
        std::string text;
    };
    /// Whether messages that it reads count as read. A later viewer gets the messages that are not read yet.
    enum class Reading : std::uint8_t { COUNTS, LOOKS_ON };
    /// The next message; nothing when there is none. Messages that were overwritten before they were read
    /// come as one that states their number.
    std::optional<Message> next_message(Reading reading = Reading::COUNTS);
    /// next_message() continues with the oldest of the last `most` messages, whether others have read them
    /// or not; of at most mailbox::MAX_MESSAGES.
    void rewind_messages(std::uint64_t most);
    /// A random number of this start of the machine: with its number a message is unique.
    std::uint64_t run() const { return segment_->run.load(std::memory_order_acquire); }
    /// Whether the message is not yet in [DISPLAY]LOG_FILE; from here on it counts as written there.
    bool claim_log(std::uint64_t number) const;

    /// Sleeps at the bell until `isOver()`, which is evaluated after each cycle of task; an error when the
    /// time is over or the machine has ended.
    template <class IsOver>
    Result<> wait_until(const IsOver &isOver, double timeout_s);
    /// False when task died within writing it.
    template <class Lock, class Value>
    bool read_whole(const Lock &lock, Value &value) const;

  private:
    static std::int64_t end_of(double timeout_s);
    Result<> sleep(std::uint32_t heard, std::int64_t end_ns) const;

    std::optional<mailbox::Memory> memory_;  ///< of another process
    std::shared_ptr<MachineLink> link_;      ///< to another computer
    mailbox::Segment *segment_;
    std::uint64_t next_message_ = 1;
    std::uint64_t tools_version_ = 0;
    std::uint32_t heard_ = 0;
    std::unique_ptr<messages::PublishedStatus::Copy> status_;
};

template <class Lock, class Value>
bool Viewer::read_whole(const Lock &lock, Value &value) const {
    // Longest interruption of task within a write before it counts as dead: the time of its watchdog.
    constexpr std::chrono::milliseconds WRITER_PATIENCE{500};
    return read_patiently(lock, value, WRITER_PATIENCE, [this] { return isMachineAlive(); });
}

template <class IsOver>
Result<> Viewer::wait_until(const IsOver &isOver, double timeout_s) {
    const std::int64_t end_ns = end_of(timeout_s);
    while (true) {
        // Before the question: what changes after it rings the bell.
        const std::uint32_t heard = segment_->bell.load(std::memory_order_acquire);
        if (isOver()) {
            return {};
        }
        auto slept = sleep(heard, end_ns);
        if (!slept.has_value()) {
            return slept;
        }
    }
}

}  // namespace mw::client
