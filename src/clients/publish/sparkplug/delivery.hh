// SPDX-License-Identifier: GPL-2.0-or-later
// Tracks which records were sent in a session, and which of them count as delivered.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "clients/publish/sparkplug/data_log.hh"

namespace mw::publish {

/// Records before the last birth are history; later records are sent immediately. Sparkplug's messages have
/// no receipts. If the host application counts the messages that it has stored, their records count as
/// delivered. Otherwise a barrier is sent after some messages, and the records sent before it count as
/// delivered when the broker has passed it.
class Delivery {
  public:
    struct Settings {
        /// Delivered records are confirmed only after this time, because a broker that is killed may lose
        /// messages that no subscriber has received.
        double hold_back_s = 2;
        int window = 200;        ///< maximum number of messages between two barriers
        double barrier_s = 0.5;  ///< time between two barriers, unless the window is half full
    };
    explicit Delivery(const Settings &settings) : settings_(settings) {}

    /// Called at the birth of the node: all records that are not confirmed must be sent. `hasReceipts`: the
    /// host application counts the messages that it has stored.
    void begin(RecordId confirmed, bool hasReceipts);
    /// Records before `next` that were not sent become history.
    void birth(RecordId next);

    /// The next record that is sent immediately.
    RecordId live() const { return live_; }
    /// The next record of history, which ends at history_end().
    RecordId history() const { return history_; }
    RecordId history_end() const { return history_end_; }
    void set_live(RecordId next) { live_ = next; }
    void set_history(RecordId next) { history_ = next; }

    /// True if the host application counts stored messages and needs the number of each message.
    bool hasReceipts() const { return hasReceipts_; }
    /// Number of messages since begin().
    std::uint64_t sent() const { return sent_; }
    void message_sent() {
        ++unbarred_;
        ++sent_;
    }
    /// False: no more messages may be sent before a barrier is passed or a receipt arrives.
    bool hasRoom() const { return on_the_way() < settings_.window; }
    bool isHalfFull() const { return 2 * on_the_way() > settings_.window; }

    /// Called when all messages of a step are sent; receipts refer to this point.
    void step_sent(double now_s);
    /// The host has stored the first `count` messages since begin().
    void received(std::uint64_t count);

    bool isBarrierDue(double now_s) const;
    void barrier_sent(int number, double now_s);
    void barrier_passed(int number);
    /// Time at which the pending barrier was sent, or the first message without receipt.
    std::optional<double> waiting_since() const;
    /// The end of the records that must be confirmed now.
    std::optional<RecordId> confirmed(double now_s);

  private:
    struct Barrier {
        int number = 0;
        RecordId end = 0;
        double at_s = 0;
    };
    /// The sent records when the number of messages was `sent`.
    struct Mark {
        std::uint64_t sent = 0;
        RecordId end = 0;
        double at_s = 0;
    };
    int on_the_way() const {
        return hasReceipts_ ? static_cast<int>(sent_ - std::min(sent_, received_)) : unbarred_;
    }
    /// All records before it were sent.
    RecordId sent_end() const { return history_ < history_end_ ? history_ : std::max(history_end_, live_); }

    Settings settings_;
    RecordId history_ = 1, history_end_ = 1, live_ = 1;
    int unbarred_ = 0;  ///< messages since the last barrier
    std::optional<Barrier> barrier_;
    double barrier_at_s_ = 0;
    RecordId barred_ = 1;  ///< end of the records before the last barrier
    std::deque<Barrier> passed_;

    bool hasReceipts_ = false;
    std::uint64_t sent_ = 0, received_ = 0;  ///< messages since begin()
    std::deque<Mark> marks_;                 ///< messages without receipt
};

}  // namespace mw::publish
