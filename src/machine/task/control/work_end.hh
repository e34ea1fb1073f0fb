// SPDX-License-Identifier: GPL-2.0-or-later
// The end of a run: completed, failed, stopped or aborted, and the clean-up after it.
#pragma once

#include <functional>
#include <string>

#include "base/diagnostics/sink.hh"
#include "machine/task/control/run_parts.hh"
#include "machine/task/run/on_abort.hh"
#include "machine/task/states/operating_mode.hh"

namespace mw::task {

/// Result of a run that is not executed to its end.
enum class Stopped : std::uint8_t {
    INTERRUPTED,  ///< not requested by an operator: the program may be resumed
    ON_REQUEST,
};

/// Functions of other parts that are called when a run ends.
struct WorkEndHooks {
    std::function<void()> braking;  ///< called when motion begins to stop
    std::function<void()> aborted;  ///< called to abandon their requests
};

/// After an abort no earlier request moves the machine, and modes and offsets are those of the executed
/// block. One thread; does not block.
class WorkEnd {
  public:
    WorkEnd(const RunParts &parts, WorkEndHooks hooks);

    /// Called when the run is executed or has failed.
    void finish(Progress progress, const std::string &reason);
    /// Reports the error, ends the run and aborts all work.
    void fail_run(diagnostics::Diagnostic what, AbortReason reason);
    /// Posts an error of motion. If the error belongs to the run, the run ends.
    void report(const std::string &text, const motion::SourceTag &source, bool of_run, AbortReason reason);
    /// Ends the run, and stops axes and spindles. During a long call axes and spindles stop at once; the end
    /// of the run and the return to the modes of the executed block follow after the call.
    void stop_work(const std::string &why, AbortReason reason, Stopped how = Stopped::INTERRUPTED);
    /// Starts [RS274NGC]ON_ABORT_COMMAND. If it has an error, the calls before the error are still executed.
    void clean_up(AbortReason reason);
    /// Called when work was requested after the last abort.
    void note_work() { on_abort_.note_work(); }

    /// Called once in each cycle: ends a run with a failed action or one that motion does not accept;
    /// continues the clean-up.
    void step();

    std::uint64_t programs_ended() const { return programs_ended_; }

  private:
    void check_mode();
    void step_clean_up();
    void stop_run(const std::string &reason, Stopped how);
    void abort_work(AbortReason reason);
    void discard_read_ahead(AbortReason reason);
    void switch_off_outputs();

    const RunParts &parts_;
    WorkEndHooks hooks_;
    OnAbort on_abort_;
    OutOfModeWatch mode_watch_;
    std::uint64_t programs_ended_ = 0;
};

}  // namespace mw::task
