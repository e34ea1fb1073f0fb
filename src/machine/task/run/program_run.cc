// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/program_run.hh"

#include <utility>

namespace mw::task {

Result<Progress> ProgramRun::start(RunKind kind, mailbox::Serial command, const std::string &line) {
    const auto taken = state_.take(RunEvent::START);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    kind_ = kind;
    line_ = line;
    from_line_ = 0;
    request_.begin(command);
    error_.reset();
    return Progress::STARTED;
}

void ProgramRun::recalculate() {
    change(RunEvent::END);
    change(RunEvent::START);
    kind_ = RunKind::RECALCULATION;
    from_line_ = 0;
}

std::optional<Ending> ProgramRun::end(Progress progress, const std::string &reason) {
    change(RunEvent::END);
    isDone_ = progress == Progress::DONE;
    return request_.end(progress, reason);
}

InterpState ProgramRun::shown() const {
    if (!isRunning()) {
        return InterpState::IDLE;
    }
    if (isHeld()) {
        return InterpState::PAUSED;
    }
    return phase() == RunPhase::FINISHING ? InterpState::WAITING : InterpState::READING;
}

void ProgramRun::note_failure(const std::string &text) {
    failure_ = failure_.value_or(text);
}

std::optional<std::string> ProgramRun::take_failure() {
    return std::exchange(failure_, std::nullopt);
}

}  // namespace mw::task
