// SPDX-License-Identifier: GPL-2.0-or-later
// The work of task during a long call into the interpreter, and while motion does not run.
#pragma once

#include <string>

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has no state.
struct Task::Meanwhile {
    Task &task;

    /// In each cycle during a long call; notifies the operator of a very long one.
    void begin();
    /// After each long call: executes the work that was postponed. True for a stop: the purpose of the call
    /// no longer exists.
    bool end();
    /// The same after a step of the interpreter; if a stop made it fail, its position is reported.
    bool end_step(gcode::Step result);
    /// Result of `call`, which may wait for a disk; stops are executed meanwhile.
    template <class Call>
    auto beside(const Call &call) {
        auto result = [&] {
            const LongCall::During during(task.long_call());
            return call();
        }();
        static_cast<void>(end());
        return result;
    }
    /// Ends the run, and stops axes and spindles. During a call the latter happens at once; the run ends, and
    /// modes return to those of the executed block, after it.
    void stop_work(const std::string &why, AbortReason reason, bool interrupted = true);
    /// Ends jogs of clients that have ended or are suspended.
    void end_left_jogs();
    /// A stop has been sent to motion, and is done; if motion does not run now, it is reported when motion
    /// has executed it.
    Result<Progress> settle(mailbox::Serial command);
};

}  // namespace mw::task
