// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/on_abort.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/overloaded.hh"

namespace mw::task {
namespace {

/// Maximum number of blocks of the command. It is read at once, so that it cannot be lost.
constexpr int MAX_BLOCKS = 10000;

}  // namespace

bool isForbiddenAfterAbort(const gcode::MachineCall &call) {
    return std::visit(
        Overloaded{
            [](const OneOf<gcode::LineMove, gcode::ArcMove, gcode::ProbeMove, gcode::TapMove,
                           gcode::StartSpindle, gcode::OrientSpindle, gcode::SelectTool, gcode::ChangeTool,
                           gcode::WaitInput, gcode::ProgramStop, gcode::ProgramEnd, gcode::Finish> auto &) {
                return true;
            },
            [](const OneOf<gcode::SwitchMist, gcode::SwitchFlood> auto &coolant) { return coolant.isOn; },
            [](const OneOf<gcode::Dwell, gcode::UseToolOffset, gcode::UseOffsets, gcode::UsePlanner,
                           gcode::SetSpindleMode, gcode::UseSpindleSpeed, gcode::StopSpindle,
                           gcode::WaitOrientComplete, gcode::ChangeToolNumber, gcode::SetToolTableEntry,
                           gcode::ReloadTools, gcode::SwitchFeedOverride, gcode::SwitchSpeedOverride,
                           gcode::SwitchFeedHold, gcode::SwitchAdaptiveFeed, gcode::SetDigitalOutput,
                           gcode::SetAnalogOutput, gcode::PalletShuttle, gcode::UserCode,
                           gcode::ProgramComment, gcode::OperatorMessage, gcode::PrintLine, gcode::OpenLog,
                           gcode::LogLine, gcode::CloseLog, gcode::LogProbes, gcode::CanonError> auto &) {
                return false;
            },
        },
        call);
}

Result<> OnAbort::read(ProgramReader &reader, AbortReason reason) const {
    gcode::ProgramInterpreter &interp = reader.interpreter();
    gcode::Step step = reader.execute(fmt::format("{} [{}]", command_, static_cast<int>(reason)));
    for (int blocks = 1; step == gcode::Step::OK && blocks < MAX_BLOCKS; ++blocks) {
        step = reader.step();
    }
    if (step != gcode::Step::FILE_END) {
        interp.abort();
    }
    ItemQueue &queue = reader.queue();
    const auto bad = std::find_if(queue.begin(), queue.end(),
                                  [](const Item &item) { return isForbiddenAfterAbort(item.call); });
    if (bad != queue.end()) {
        const motion::SourceTag source = bad->source;
        queue.erase(bad, queue.end());
        return fail(SourcePlace{reader.canon().file_name(source.file_index), source.line, 0}.str() +
                    ": the command after an abort must not move, start, stop the program or wait");
    }
    switch (step) {
    case gcode::Step::FILE_END: return {};
    case gcode::Step::FAILED: return fail(interp.error().str());
    case gcode::Step::SYNC: return fail("the command must not wait");
    case gcode::Step::OK:
    case gcode::Step::PROGRAM_END: break;
    }
    return fail("the command is too long");
}

std::string OnAbort::told(const std::string &trouble) const {
    return fmt::format("[RS274NGC]ON_ABORT_COMMAND = {}: {}", command_, trouble);
}

}  // namespace mw::task
