// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a machine without commanding it: status, tool table, messages. The machine runs in this process or in
// another process.
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

/// For one thread. Uses no client slot: any number of viewers may read, without cost for task.
class Viewer {
  public:
    /// Attaches to a machine in another process, by the name of its instance.
    static Result<Viewer> attach(const std::string &instance);
    /// A viewer of a machine in this process, which must outlive the viewer.
    explicit Viewer(mailbox::Segment &segment);
    /// A viewer of a machine on a remote computer.
    explicit Viewer(std::shared_ptr<MachineLink> link);

    mailbox::Segment &segment() const { return *segment_; }
    /// Identity of the machine; empty until it is ready for clients.
    mailbox::Identity identity() const;
    /// True while task's process is alive; always true in that process.
    bool isMachineAlive() const { return check_machine().has_value(); }
    /// An error when task's process has ended, or the connection to it is lost.
    Result<> check_machine() const;
    /// Null for a machine on this computer.
    MachineLink *link() const { return link_.get(); }

    /// Id of task's process; of this process for a machine in this process.
    int machine_pid() const;

    /// Updates status(). An error before the first cycle of task, and when task died while it wrote the
    /// status.
    Result<> read_status();
    /// The status as last read.
    const messages::MachineStatus &status() const { return status_->value; }
    /// Parts (messages::status_part) that the last read has copied; other parts did not change.
    PartMask fresh_parts() const { return status_->fresh; }
    /// Sleeps until there is a newer status than at the last wait.
    Result<> wait_status(double timeout_s);
    /// The tool table if it has changed since the last call; otherwise nothing.
    Result<std::optional<messages::ToolTable>> read_tools();

    struct Message {
        std::uint64_t number = 0;
        std::int64_t at_ns = 0;  ///< time of the message (CLOCK_MONOTONIC)
        messages::MessageKind kind = messages::MessageKind::OPERATOR_ERROR;
        std::string text;
    };
    /// Whether messages count as read after this viewer has read them. A later viewer receives only unread
    /// messages.
    enum class Reading : std::uint8_t { COUNTS, LOOKS_ON };
    /// The next message; nothing when there is none. Messages that were overwritten before they were read are
    /// replaced by one message with their number.
    std::optional<Message> next_message(Reading reading = Reading::COUNTS);
    /// Continues next_message() with the oldest of the last `most` messages, also if they have been read; at
    /// most mailbox::MAX_MESSAGES.
    void rewind_messages(std::uint64_t most);
    /// A random number of this start of the machine. Together with this number a message number is unique.
    std::uint64_t run() const { return segment_->run.load(std::memory_order_acquire); }
    /// True if the message is not yet in [DISPLAY]LOG_FILE; the caller then writes it, and it counts as
    /// written.
    bool claim_log(std::uint64_t number) const;

    /// Sleeps until `isOver()`, which is evaluated after each cycle of task. An error after the timeout or
    /// when the machine has ended.
    template <class IsOver>
    Result<> wait_until(const IsOver &isOver, double timeout_s);
    /// False when task died while it wrote the value.
    template <class Lock, class Value>
    bool read_whole(const Lock &lock, Value &value) const;

  private:
    static std::int64_t end_of(double timeout_s);
    Result<> sleep(std::uint32_t heard, std::int64_t end_ns) const;

    std::optional<mailbox::Memory> memory_;  ///< mailbox of another process
    std::shared_ptr<MachineLink> link_;      ///< connection to a remote computer
    mailbox::Segment *segment_;
    std::uint64_t next_message_ = 1;
    std::uint64_t tools_version_ = 0;
    std::uint32_t heard_ = 0;
    std::unique_ptr<messages::PublishedStatus::Copy> status_;
};

template <class Lock, class Value>
bool Viewer::read_whole(const Lock &lock, Value &value) const {
    // Maximum interruption of a write by task before task counts as dead: the time of its watchdog.
    constexpr std::chrono::milliseconds WRITER_PATIENCE{500};
    return read_patiently(lock, value, WRITER_PATIENCE, [this] { return isMachineAlive(); });
}

template <class IsOver>
Result<> Viewer::wait_until(const IsOver &isOver, double timeout_s) {
    const std::int64_t end_ns = end_of(timeout_s);
    while (true) {
        // Read before the condition, so that a later change rings the bell.
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
