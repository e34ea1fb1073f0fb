// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/on_abort.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/overloaded.hh"

namespace mw::task {
namespace {

/// Blocks that the command may have: it is read at once, so that it cannot get lost.
constexpr int MAX_BLOCKS = 10000;

}  // namespace

bool isForbiddenAfterAbort(const interp::MachineCall &call) {
    return std::visit(
        Overloaded{
            [](const OneOf<interp::LineMove, interp::ArcMove, interp::ProbeMove, interp::TapMove,
                           interp::StartSpindle, interp::OrientSpindle, interp::SelectTool,
                           interp::ChangeTool, interp::WaitInput, interp::ProgramStop, interp::ProgramEnd,
                           interp::Finish> auto &) { return true; },
            [](const OneOf<interp::SwitchMist, interp::SwitchFlood> auto &coolant) { return coolant.isOn; },
            [](const OneOf<interp::Dwell, interp::UseToolOffset, interp::UseOffsets, interp::UsePlanner,
                           interp::SetSpindleMode, interp::UseSpindleSpeed, interp::StopSpindle,
                           interp::WaitOrientComplete, interp::ChangeToolNumber, interp::SetToolTableEntry,
                           interp::ReloadTools, interp::SwitchFeedOverride, interp::SwitchSpeedOverride,
                           interp::SwitchFeedHold, interp::SwitchAdaptiveFeed, interp::SetDigitalOutput,
                           interp::SetAnalogOutput, interp::PalletShuttle, interp::UserCode,
                           interp::ProgramComment, interp::OperatorMessage, interp::PrintLine,
                           interp::OpenLog, interp::LogLine, interp::CloseLog, interp::LogProbes,
                           interp::CanonError> auto &) { return false; },
        },
        call);
}

Result<> OnAbort::read(ProgramReader &reader, AbortReason reason) const {
    interp::ProgramInterpreter &interp = reader.interpreter();
    interp::Step step = reader.execute(fmt::format("{} [{}]", command_, static_cast<int>(reason)));
    for (int blocks = 1; step == interp::Step::OK && blocks < MAX_BLOCKS; ++blocks) {
        step = reader.step();
    }
    if (step != interp::Step::FILE_END) {
        interp.abort();
    }
    ItemQueue &queue = reader.queue();
    const auto bad = std::find_if(queue.begin(), queue.end(),
                                  [](const Item &item) { return isForbiddenAfterAbort(item.call); });
    if (bad != queue.end()) {
        const motion::SourceTag source = bad->source;
        queue.erase(bad, queue.end());
        return fail(SourcePlace{reader.canon().file_name(source.file_index), source.line, 0}.str() +
                    ": after an abort nothing may move, start, stop the program or wait");
    }
    switch (step) {
    case interp::Step::FILE_END: return {};
    case interp::Step::FAILED: return fail(interp.error().str());
    case interp::Step::SYNC: return fail("it must not wait");
    case interp::Step::OK:
    case interp::Step::PROGRAM_END: break;
    }
    return fail("it is too long");
}

std::string OnAbort::told(const std::string &trouble) const {
    return fmt::format("[RS274NGC]ON_ABORT_COMMAND = {}: {}", command_, trouble);
}

}  // namespace mw::task
