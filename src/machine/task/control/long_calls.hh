// SPDX-License-Identifier: GPL-2.0-or-later
// The work of task during a long call into the interpreter: docs/developer/long_calls.md.
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

    /// In each cycle during a long call. Notifies the operator of a very long one; `place`: what it reads.
    void step(const std::string &place);
    bool isActive() const { return now_.active; }
    /// A stop was executed during the call: the purpose of the call no longer exists.
    bool isStopped() const { return now_.stopped; }
    /// The axes were stopped during the call: blocks that `sequencer` has not reached do not count as
    /// executed.
    void note_stop(const Sequencer &sequencer);
    /// Does `work` at the end of the call; at once without one.
    void after_call(std::function<void()> work);

    /// After each long call: executes the work that was postponed. True for a stop.
    bool end();
    /// The same after a step of the interpreter; if a stop made it fail, its position is reported.
    bool end_step(gcode::Step result);
    /// Result of `call`, which may wait for a disk; stops are executed meanwhile.
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
        bool reported = false;       ///< to the operator
        bool wait_reported = false;  ///< reported that it does not end after a stop
        std::int64_t stopped_ns = 0;
        std::int64_t since_ns = 0;  ///< time of its first cycle
        std::vector<std::function<void()>> later;
    };

    MachinePort &port_;
    ProgramReader &reader_;
    State now_;
};

}  // namespace mw::task
