// SPDX-License-Identifier: GPL-2.0-or-later
// What task does beside a long call into the interpreter, and where motion does not run.
#pragma once

#include <string>

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has nothing of its own.
struct Task::Meanwhile {
    Task &task;

    /// In each cycle apart; tells the operator when the call takes very long.
    void begin();
    /// After each long call: does what another thread has left for its end. True when that was a stop: what
    /// the call was made for is over.
    bool end();
    /// The same after a step of the interpreter; where a stop has made it fail, the operator reads where it
    /// was.
    bool end_step(gcode::Step result);
    /// What `call` returns, which may wait for a disk: stops are carried out beside it.
    template <class Call>
    auto beside(const Call &call) {
        auto result = [&] {
            const LongCall::During during(task.long_call());
            return call();
        }();
        static_cast<void>(end());
        return result;
    }
    /// The run ends, and what moves or turns stops. Beside a call the latter at once; the run ends, and modes
    /// return to those of the executed block, after it.
    void stop_work(const std::string &why, AbortReason reason, bool isCutShort = true);
    /// Those of clients that have ended or are suspended.
    void end_left_jogs();
    /// A stop has been handed to motion, and is done: told once motion has taken it, where it does not run
    /// now.
    Result<Progress> settle(mailbox::Serial command);
};

}  // namespace mw::task
