// SPDX-License-Identifier: GPL-2.0-or-later
// Modes that M70 and M73 have saved, one set for each level of call.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "interp/codes/state.hh"

namespace mw::interp::detail {

class SavedModes {
  public:
    /// Calls that run, one inside the other; 0 in the main program.
    std::size_t depth() const { return levels_.size() - 1; }
    void push_call() { levels_.emplace_back(); }
    /// Ends the innermost call; gives the modes that M73 has saved for its return.
    std::optional<State> pop_call();
    /// Ends calls down to `depth` of them.
    void drop_calls(std::size_t depth);

    void save(const State &modes) { levels_.back() = {modes, false}; }              ///< M70
    void save_until_return(const State &modes) { levels_.back() = {modes, true}; }  ///< M73
    void forget() { levels_.back().modes.reset(); }                                 ///< M71
    /// What M72 restores; null when nothing is saved at this level.
    const State *saved() const { return levels_.back().modes ? &*levels_.back().modes : nullptr; }
    /// Of a level (0: the main program). Bit 0: modes are saved; bit 1: the last to save was M73.
    int status(std::size_t level) const;

  private:
    struct Level {
        std::optional<State> modes;
        bool isForReturn = false;
    };
    std::vector<Level> levels_{1};
};

}  // namespace mw::interp::detail
