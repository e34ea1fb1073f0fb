// SPDX-License-Identifier: GPL-2.0-or-later
// Modes that M70 and M73 have saved, one set for each level of call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gcode/interpreter/codes/state.hh"

namespace mw::gcode::detail {

/// What a block saves or forgets counts at once, and is taken back when the block fails. Calls are not: a
/// block that enters or ends one keeps what it did before.
class SavedModes {
  public:
    /// Calls that run, one inside the other; 0 in the main program.
    std::size_t depth() const { return levels_.size() - 1; }
    void push_call() {
        levels_.emplace_back();
        ++revision_;
    }
    /// Ends the innermost call; gives the modes that M73 has saved for its return.
    std::optional<State> pop_call();
    /// Ends calls down to `depth` of them.
    void drop_calls(std::size_t depth);

    void save(const State &modes) { change({modes, false}); }              ///< M70
    void save_until_return(const State &modes) { change({modes, true}); }  ///< M73
    void forget() { change({std::nullopt, levels_.back().isForReturn}); }  ///< M71
    /// What M72 restores; null when nothing is saved at this level.
    const State *saved() const { return levels_.back().modes ? &*levels_.back().modes : nullptr; }
    /// Of a level (0: the main program). Bit 0: modes are saved; bit 1: the last to save was M73.
    int status(std::size_t level) const;

    /// Another number whenever something has changed.
    std::uint64_t revision() const { return revision_; }

    void commit() { log_.clear(); }
    void rollback();

  private:
    struct Level {
        std::optional<State> modes;
        bool isForReturn = false;
    };
    /// What a level held before the block changed it.
    struct Undo {
        std::size_t level = 0;
        Level before;
    };
    void change(Level &&level);
    /// Levels that are gone have nothing to take back.
    void forget_undo();

    std::uint64_t revision_ = 0;
    std::vector<Level> levels_{1};
    std::vector<Undo> log_;  ///< of the block that runs; its levels are there
};

}  // namespace mw::gcode::detail
