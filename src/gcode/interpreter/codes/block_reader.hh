// SPDX-License-Identifier: GPL-2.0-or-later
// From a parsed block to its values: words computed, codes looked up and put in the order of execution, all
// checked against the table of codes. All functions: false after setting the fault.
#pragma once

#include <cstdint>
#include <vector>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/remaps.hh"
#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/syntax/fault.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// What words and codes mean.
struct BlockSources {
    const Evaluator &evaluator;
    const Remaps &remaps;
};

/// Into `values`, which are clear.
bool read_words(const BlockView &view, const BlockSources &sources, BlockValues &values, Fault &fault);
/// Axis words belong to a code of the block that uses them, else to the motion in force.
bool choose_motion(BlockValues &values, int motion, const Remaps &remaps, Fault &fault);
/// Each code has the words that it needs, each word a code that uses it.
bool check_words(const BlockValues &values, Fault &fault);
/// G53 is for straight moves: G0 or G1 is in the block, or current with axis words.
bool check_machine_coordinates(const BlockValues &values, Fault &fault);

/// The machine must have the axes that a block names.
class AxisCheck {
  public:
    /// `mask`: bit per axis of the machine.
    bool check(const BlockValues &values, unsigned mask, Fault &fault);

  private:
    unsigned mask_ = ~0U;       ///< when absent_ was made
    std::uint32_t absent_ = 0;  ///< letters of the axes that the machine lacks
};

/// Parameters that a block sets.
class BlockSettings {
  public:
    /// All values are computed before any is set.
    bool apply(const BlockView &view, const Evaluator &evaluator, const Names &names, Parameters &parameters,
               Fault &fault);

  private:
    /// A parameter and the value that it is to have.
    struct MadeSetting {
        int number = 0;
        NameId name = NO_ID;
        double value = 0;
    };
    static bool compute_setting(const Arena &arena, const Setting &setting, const Evaluator &evaluator,
                                const Names &names, MadeSetting &out, Fault &fault);

    std::vector<MadeSetting> made_;  ///< of the block that runs
};

}  // namespace mw::gcode::detail
