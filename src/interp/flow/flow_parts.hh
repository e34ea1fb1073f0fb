// SPDX-License-Identifier: GPL-2.0-or-later
// What a step of the flow works on.
#pragma once

#include "interp/ast/names.hh"
#include "interp/codes/executor.hh"
#include "interp/flow/jumps.hh"
#include "interp/flow/levels.hh"
#include "interp/flow/program_files.hh"
#include "interp/flow/scripts.hh"
#include "interp/flow/sub_search.hh"

namespace mw::interp::detail {

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
        return {levels, files, names, settings.subroutine_path, executor.fault, scripts.limits().isConfined};
    }
    /// Keeps what the block did and hands on its calls.
    void commit() const {
        executor.commit();
        executor.flush(target);
    }
};

}  // namespace mw::interp::detail
