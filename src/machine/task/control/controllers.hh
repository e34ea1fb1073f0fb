// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of task that execute commands.
#pragma once

#include "machine/task/control/manual_control.hh"
#include "machine/task/control/motion_settings.hh"
#include "machine/task/control/program_resume.hh"
#include "machine/task/control/tool_table_control.hh"

namespace mw::task {

/// All parts outlive their users.
struct Controllers {
    IoPins &io_pins;
    RunController &runs;
    WorkEnd &end;
    ProgramResume &resume;
    ModeController &modes;
    ManualControl &manual;
    MotionSettings &settings;
    ToolTableControl &tools;
};

}  // namespace mw::task
