// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes while programs run: the REMAP lines, the procedures that run, and the block that one has
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
    /// The row of a remapped code; null for any other, and while the code's own procedure runs.
    const Code *find(char letter, int number) const;

    /// The procedure of `remap` begins at a level of call (from 1).
    void begin(const Remap &remap, std::size_t level) { running_.push_back({&remap, level, 0}); }
    /// Ends those that began above a level of call.
    void end_above(std::size_t level);
    bool isAnyRunning() const { return !running_.empty(); }
    int count_running() const { return static_cast<int>(running_.size()); }
    /// A code is executed with its own meaning: counted for the procedures that give it another.
    void count_builtin(const Code &code);
    /// How often the procedure of the `nth` running remap (from 1) has used its code's own meaning.
    int builtin_uses(int nth) const { return running_[static_cast<std::size_t>(nth) - 1].builtins; }
    /// Why a code means nothing although it is remapped; empty when that is not the reason.
    std::string recursion_text(char letter, int number) const;

    /// A block has come to a remapped code.
    void interrupt(PendingBlock block) { interrupted_ = std::move(block); }
    /// That block, to be run on after the procedure.
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

/// What the argspec of the remapped code requires and the block lacks, with commas; empty when nothing is
/// missing.
std::string missing_words(const PendingBlock &block, const State &state);
/// Words of the block become local names of the procedure, or #1, #2, ... in the order of the argspec.
void pass_words(const PendingBlock &block, bool isCountNamed, Parameters &parameters, Names &names);

}  // namespace mw::gcode::detail
