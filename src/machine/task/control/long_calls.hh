// SPDX-License-Identifier: GPL-2.0-or-later
// The work of task during a long call of the interpreter: docs/developer/long_calls.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "machine/task/control/machine_port.hh"
#include "machine/task/run/program_reader.hh"

namespace mw::task {

/// State while another thread uses task (LongCall), and the work that the call delays. One thread at a time.
class LongCalls {
  public:
    LongCalls(MachinePort &port, ProgramReader &reader) : port_(port), reader_(reader) {}

    /// Called in each cycle during a long call. Notifies the operator of a very long call; `place` is what
    /// the call reads.
    void step(const std::string &place);
    bool isActive() const { return now_.active; }
    /// True if a stop was executed during the call, so that its purpose no longer exists.
    bool isStopped() const { return now_.stopped; }
    /// Called when the axes were stopped during the call. Blocks that `sequencer` has not reached then do not
    /// count as executed.
    void note_stop(const Sequencer &sequencer);
    /// Does `work` at the end of the call, or at once if there is no call.
    void after_call(std::function<void()> work);

    /// Called after each long call: executes the postponed work. True after a stop.
    bool end();
    /// As end(), after a step of the interpreter. If a stop made the step fail, its position is reported.
    bool end_step(gcode::Step result);
    /// Returns the result of `call`, which may wait for a disk; stops are executed meanwhile.
    template <class Call>
    auto beside(const Call &call) {
        auto result = [&] {
            const LongCall::During during(reader_.call().call);
            return call();
        }();
        static_cast<void>(end());
        return result;
    }

  private:
    struct State {
        bool active = false;
        bool stopped = false;
        bool reported = false;       ///< the long call was reported to the operator
        bool wait_reported = false;  ///< it was reported that the call does not end after a stop
        std::int64_t stopped_ns = 0;
        std::int64_t since_ns = 0;  ///< time of the first cycle of the call
        std::vector<std::function<void()>> later;
    };

    MachinePort &port_;
    ProgramReader &reader_;
    State now_;
};

}  // namespace mw::task
