// SPDX-License-Identifier: GPL-2.0-or-later
// Records trace, figures, certificate of motion and picture while a program runs on a machine of this
// process.
#pragma once

#include <optional>
#include <string>

#include "machine/assembly/machine.hh"
#include "machine/certificate/motion_certificate.hh"
#include "machine/certificate/path_monitor.hh"
#include "programs/run/trace_writer.hh"

namespace mw::programs {

/// All calls come from one thread. During its lifetime it is the only listener of the machine's moves.
class Recorder {
  public:
    Recorder(machine::Machine &machine, const machine::MachineConfig &config);

    Result<> open_trace(const std::string &path, const machine::MachineConfig &config);
    void start();
    /// Called once in each task cycle.
    void drain();
    /// An error when the trace is incomplete.
    Result<> finish(machine::ProgramEnd end);
    bool hasStarted() const { return started_; }
    const machine::PathMonitor &monitor() const { return monitor_; }
    machine::Certificate certificate() const { return certificate_.result(); }

  private:
    machine::Machine &machine_;
    machine::PathMonitor monitor_;
    machine::MotionCertificate certificate_;
    std::optional<TraceWriter> trace_;
    bool started_ = false;
};

}  // namespace mw::programs
