// SPDX-License-Identifier: GPL-2.0-or-later
// Which records were sent in a session, and which of them count as delivered.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "clients/publish/sparkplug/data_log.hh"

namespace mw::publish {

/// Records from before the last birth are history; later ones are sent as they come. Sparkplug's messages
/// have no receipts. Where the host application counts the messages that it has stored, records of these are
/// delivered. Elsewhere a barrier is sent after some messages, and what was sent before it is delivered when
/// the broker has passed it.
class Delivery {
  public:
    struct Settings {
        /// Delivered records are confirmed only then: a broker that is killed takes messages with it that no
        /// subscriber has received.
        double hold_back_s = 2;
        int window = 200;        ///< messages between two barriers, at most
        double barrier_s = 0.5;  ///< between two barriers, unless the window is half full
    };
    explicit Delivery(const Settings &settings) : settings_(settings) {}

    /// The node is born: everything that is not confirmed is to be sent. `hasReceipts`: the host application
    /// counts what it has stored.
    void begin(RecordId confirmed, bool hasReceipts);
    /// What is not sent before `next` becomes history.
    void birth(RecordId next);

    /// The next record that is sent as it comes.
    RecordId live() const { return live_; }
    /// The next record of history; it ends at history_end().
    RecordId history() const { return history_; }
    RecordId history_end() const { return history_end_; }
    void set_live(RecordId next) { live_ = next; }
    void set_history(RecordId next) { history_ = next; }

    /// The host application counts what it has stored: it needs the number of each message.
    bool hasReceipts() const { return hasReceipts_; }
    /// Messages since begin().
    std::uint64_t sent() const { return sent_; }
    void message_sent() {
        ++unbarred_;
        ++sent_;
    }
    /// False: nothing more is sent before a barrier is passed, or a receipt comes.
    bool hasRoom() const { return on_the_way() < settings_.window; }
    bool isHalfFull() const { return 2 * on_the_way() > settings_.window; }

    /// Everything is sent that a step sends; receipts count by this.
    void step_sent(double now_s);
    /// The first `count` messages since begin() are stored.
    void received(std::uint64_t count);

    bool isBarrierDue(double now_s) const;
    void barrier_sent(int number, double now_s);
    void barrier_passed(int number);
    /// When the barrier was sent that is not passed yet, or the first message without receipt.
    std::optional<double> waiting_since() const;
    /// The end of the records that are to be confirmed now.
    std::optional<RecordId> confirmed(double now_s);

  private:
    struct Barrier {
        int number = 0;
        RecordId end = 0;
        double at_s = 0;
    };
    /// What was sent when the count of messages was `sent`.
    struct Mark {
        std::uint64_t sent = 0;
        RecordId end = 0;
        double at_s = 0;
    };
    int on_the_way() const {
        return hasReceipts_ ? static_cast<int>(sent_ - std::min(sent_, received_)) : unbarred_;
    }
    /// Everything before it was sent.
    RecordId sent_end() const { return history_ < history_end_ ? history_ : std::max(history_end_, live_); }

    Settings settings_;
    RecordId history_ = 1, history_end_ = 1, live_ = 1;
    int unbarred_ = 0;  ///< messages since the last barrier
    std::optional<Barrier> barrier_;
    double barrier_at_s_ = 0;
    RecordId barred_ = 1;  ///< end of the last barrier
    std::deque<Barrier> passed_;

    bool hasReceipts_ = false;
    std::uint64_t sent_ = 0, received_ = 0;  ///< messages since begin()
    std::deque<Mark> marks_;                 ///< that have no receipt
};

}  // namespace mw::publish
