// SPDX-License-Identifier: GPL-2.0-or-later
// Objects that a step of the flow uses.
#pragma once

#include "gcode/interpreter/codes/executor.hh"
#include "gcode/interpreter/flow/jumps.hh"
#include "gcode/interpreter/flow/levels.hh"
#include "gcode/interpreter/flow/program_files.hh"
#include "gcode/interpreter/flow/scripts.hh"
#include "gcode/interpreter/flow/sub_search.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

struct FlowParts {
    Levels &levels;
    ProgramFiles &files;
    Scripts &scripts;
    Executor &executor;
    Names &names;
    Canon &target;
    const Settings &settings;

    JumpValues jump_values() const { return {executor.evaluator(), names, executor.fault}; }
    SubSearch search() const {
        return {levels, files, names, settings.subroutine_path, executor.fault, scripts.limits().confined};
    }
    /// Commits the block and passes on its calls.
    void commit() const {
        executor.commit();
        executor.flush(target);
    }
};

}  // namespace mw::gcode::detail
