// SPDX-License-Identifier: GPL-2.0-or-later
// Modes saved by M70 and M73, one set for each call level.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gcode/interpreter/codes/state.hh"

namespace mw::gcode::detail {

struct CodeParts;
struct Fault;

/// Saving or discarding modes takes effect at once and is undone when the block fails. Calls are not undone,
/// because a block that enters or ends a call commits its earlier changes.
class SavedModes {
  public:
    /// Number of nested calls; 0 in the main program.
    std::size_t depth() const { return levels_.size() - 1; }
    void push_call() {
        levels_.emplace_back();
        ++revision_;
    }
    /// Ends the innermost call; returns the modes that M73 saved for its return, if any.
    std::optional<State> pop_call();
    /// Ends calls until `depth` of them remain.
    void drop_calls(std::size_t depth);

    void save(const State &modes) { change({modes, false}); }              ///< M70
    void save_until_return(const State &modes) { change({modes, true}); }  ///< M73
    void forget() { change({std::nullopt, levels_.back().for_return}); }   ///< M71
    /// The modes that M72 restores; null when none are saved at this level.
    const State *saved() const { return levels_.back().modes ? &*levels_.back().modes : nullptr; }
    /// Status of a level (0: the main program). Bit 0: modes are saved; bit 1: they were saved by M73.
    int status(std::size_t level) const;

    /// Changes with each modification.
    std::uint64_t revision() const { return revision_; }

    void commit() { log_.clear(); }
    void rollback();

  private:
    struct Level {
        std::optional<State> modes;
        bool for_return = false;
    };
    /// State of a level before the block changed it.
    struct Undo {
        std::size_t level = 0;
        Level before;
    };
    void change(Level &&level);
    /// Drops the undo data of ended levels.
    void forget_undo();

    std::uint64_t revision_ = 0;
    std::vector<Level> levels_{1};
    std::vector<Undo> log_;  ///< changes of the current block; their levels exist
};

/// Makes saved modes the current ones, except positions, motion mode, tool and offsets of coordinate systems.
/// False after setting the fault.
bool restore_modes(const State &saved, State &state, CodeParts &parts, Fault &fault);

}  // namespace mw::gcode::detail
