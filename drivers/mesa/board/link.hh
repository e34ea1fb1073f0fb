// SPDX-License-Identifier: GPL-2.0-or-later
// A board behind a link with faults: packets and replies in transit, and the events of the plan.
#pragma once

#include <optional>
#include <vector>

#include "drivers/mesa/board/board.hh"
#include "drivers/mesa/board/faults.hh"

namespace mw::mesa::board {

/// Number of packets at both ends.
struct LinkCounts {
    std::uint64_t sent = 0, executed = 0, replies = 0, received = 0;
};

/// Times do not decrease. [one thread]
class Link {
  public:
    /// `board` must outlive the link.
    Link(Board &board, FaultPlan plan);

    /// A host sends a packet at `now_ns`.
    void send(std::vector<std::byte> bytes, std::int64_t now_ns, int host = 0);
    /// Executes all events up to `now_ns`, in order of time.
    void run_until(std::int64_t now_ns);
    /// The next reply that has arrived at its host by `now_ns`.
    std::optional<Delivery> receive(std::int64_t now_ns);
    /// Time of the next event; empty if there is none without a new packet.
    std::optional<std::int64_t> next_ns() const;
    /// Executes an event now; events of the plan need no call.
    void perform(const FaultEvent &event);
    /// Sets the faults of both directions from now on.
    void disturb(const DirectionFaults &to_board, const DirectionFaults &to_host, std::uint64_t seed);
    const LinkCounts &counts() const { return counts_; }

  private:
    void execute(const Delivery &packet);
    void read_as_second_host(std::int64_t now_ns);
    bool isDown(std::int64_t time_ns) const;

    Board &board_;
    FaultPlan plan_;
    FaultyDirection to_board_, to_host_;
    std::vector<Delivery> arriving_, replies_;  ///< sorted by time
    std::size_t next_event_ = 0;
    std::int64_t down_until_ns_ = -1;
    std::int64_t second_next_ns_ = 0, second_until_ns_ = -1, second_period_ns_ = 0;
    LinkCounts counts_;
};

}  // namespace mw::mesa::board
