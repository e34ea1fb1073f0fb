// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes while programs run: the REMAP lines, the running procedures, and the block that one has
// interrupted.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/codes/remap.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {

class Remaps {
  public:
    Remaps() = default;
    Remaps(Remaps &&) = default;  // rows point to their remaps
    Remaps(const Remaps &) = delete;
    Remaps &operator=(Remaps &&) = delete;
    Remaps &operator=(const Remaps &) = delete;

    /// Reads the lines, once, before the first program. Errors name file, line and column.
    Result<> load(std::span<const RemapLine> lines);
    const std::vector<Remap> &all() const { return all_; }
    /// Why lines have no effect.
    const std::vector<std::string> &refused() const { return refused_; }
    /// The row of a remapped code; null for any other code, and while the code's own procedure runs.
    const Code *find(GCode code) const;

    /// The procedure of `remap` begins at a call level (from 1).
    void begin(const Remap &remap, std::size_t level) { running_.push_back({&remap, level, 0}); }
    /// Ends the procedures above a call level.
    void end_above(std::size_t level);
    bool isAnyRunning() const { return !running_.empty(); }
    int count_running() const { return static_cast<int>(running_.size()); }
    /// Counts a code that is executed with its built-in meaning, for the procedures that remap it.
    void count_builtin(GCode code);
    /// How often the procedure of the `nth` running remap (from 1) has used the built-in meaning of its code.
    int builtin_uses(int nth) const { return running_[static_cast<std::size_t>(nth) - 1].builtins; }
    /// Why a remapped code has no meaning here; empty when that is not the reason.
    std::string recursion_text(GCode code) const;

    /// A block has reached a remapped code.
    void interrupt(PendingBlock block) { interrupted_ = std::move(block); }
    /// That block, to continue after the procedure.
    PendingBlock take_interrupted();
    void drop_interrupted() { interrupted_.reset(); }

  private:
    struct Running {
        const Remap *remap = nullptr;
        std::size_t level = 0;
        int builtins = 0;
    };
    bool isRunning(const Remap &remap) const;

    std::vector<Remap> all_;
    std::vector<std::string> refused_;
    std::vector<Running> running_;
    std::optional<PendingBlock> interrupted_;
};

/// Words that the argspec requires and the block lacks, separated by commas; empty when none is missing.
std::string missing_words(const PendingBlock &block, const State &state);
/// Passes words of the block as local names of the procedure, or as #1, #2, ... in the order of the argspec.
void pass_words(const PendingBlock &block, bool count_named, Parameters &parameters, Names &names);

}  // namespace mw::gcode::detail
