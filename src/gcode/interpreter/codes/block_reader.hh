// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the values of a parsed block: computes words, finds codes, sorts them in the order of execution, and
// checks all against the table of codes. All functions return false after setting the fault.
#pragma once

#include <cstdint>
#include <vector>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/remaps.hh"
#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/syntax/fault.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// Meaning of words and codes.
struct BlockSources {
    const Evaluator &evaluator;
    const Remaps &remaps;
};

/// Reads the words into `values`, which must be clear.
bool read_words(const BlockView &view, const BlockSources &sources, BlockValues &values);
/// Assigns the axis words to the code of the block that uses them, else to the current motion mode.
bool choose_motion(BlockValues &values, GCode motion, const Remaps &remaps);
/// Checks that each code has its required words, and each word a code that uses it.
bool check_words(const BlockValues &values);
/// G53 needs a straight move: G0 or G1 in the block, or current with axis words.
bool check_machine_coordinates(const BlockValues &values);

/// Checks that the machine has the axes that a block names.
class AxisCheck {
  public:
    /// `mask`: bit per axis of the machine.
    bool check(const BlockValues &values, unsigned mask);

  private:
    unsigned mask_ = ~0U;       ///< mask for which absent_ was calculated
    std::uint32_t absent_ = 0;  ///< letters of axes that the machine does not have
};

/// Parameter settings of a block.
class BlockSettings {
  public:
    /// All values are computed before the first one is set.
    bool apply(const BlockView &view, const Evaluator &evaluator, const Names &names, Parameters &parameters,
               Fault &fault);

  private:
    /// A parameter and its new value.
    struct MadeSetting {
        int number = 0;
        NameId name = NO_ID;
        double value = 0;
    };
    static bool compute_setting(const Arena &arena, const Setting &setting, const Evaluator &evaluator,
                                const Names &names, MadeSetting &out, Fault &fault);

    std::vector<MadeSetting> made_;  ///< settings of the current block
};

}  // namespace mw::gcode::detail
