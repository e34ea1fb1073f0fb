// SPDX-License-Identifier: GPL-2.0-or-later
// Path commands that have been accepted and not yet answered, in order.
#pragma once

#include <array>
#include <cstdint>

#include "motion/interface/path_command.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

struct PendingCommand {
    CommandId id = 0;
    trajectory::Sequence after_move = 0;  ///< complete when this move is complete
    SourceTag source;
    Epoch epoch = 0;
    bool isFlush = false, isProbe = false, isTripRequired = false, isAwayProbe = false;
    int indexer = -1;        ///< joint that is unlocked for it
    bool isIndexed = false;  ///< its move has completed, and the joint must lock
};

/// Planner thread only. The caller checks size() before it adds.
class PendingCommands {
  public:
    static constexpr std::uint32_t CAPACITY = 8192;

    std::uint32_t size() const noexcept { return tail_ - head_; }
    bool isEmpty() const noexcept { return size() == 0; }
    void add(const PendingCommand &command) noexcept { commands_[tail_++ % CAPACITY] = command; }
    void drop() noexcept { ++head_; }
    /// The list must not be empty.
    const PendingCommand &oldest() const noexcept { return commands_[head_ % CAPACITY]; }
    PendingCommand &newest() noexcept { return commands_[(tail_ - 1) % CAPACITY]; }

  private:
    std::array<PendingCommand, CAPACITY> commands_{};
    std::uint32_t head_ = 0, tail_ = 0;
};

}  // namespace mw::motion
