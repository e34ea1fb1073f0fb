// SPDX-License-Identifier: GPL-2.0-or-later
// The two logs of a run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gcode/canon/canon_calls.hh"
#include "machine/task/sequencer/program_log.hh"

namespace mw::task {

/// Files of (log,...) and of (probeopen ...). One thread, which does not wait for a disk.
class ProgramLogs {
  public:
    ProgramLogs(LogWorks works, const std::shared_ptr<LogDisk> &disk)
        : lines_(works, disk), probes_(works, disk) {}

    /// Opens the log file. The result is in opened().
    void open(const gcode::OpenLog &call, const Confinement *confinement) {
        last_opened_ = &lines_;
        lines_.open(call.path, call.appending, confinement);
    }
    void open(const gcode::LogProbes &call, const Confinement *confinement) {
        last_opened_ = &probes_;
        probes_.open(call.path, false, confinement);
    }
    /// Result of the last open().
    std::optional<Result<>> opened() const { return last_opened_->opened(); }
    Result<> write(const gcode::LogLine &call) { return lines_.write(call.text); }
    /// Has no effect without a file for probes. take_failure() reports failures.
    void write_probe(const std::string &line) {
        if (const auto written = probes_.write(line); !written.has_value()) {
            probe_failure_ = written.error();
        }
    }
    void close_lines() { lines_.close(); }
    void close_probes() { probes_.close(); }
    void close() {
        lines_.close();
        probes_.close();
    }

    /// As in ProgramLog.
    std::optional<Error> take_failure() {
        for (ProgramLog *const log : {&lines_, &probes_}) {
            if (auto failure = log->take_failure()) {
                return failure;
            }
        }
        return std::exchange(probe_failure_, std::nullopt);
    }
    std::optional<std::string> take_delay() {
        auto delay = lines_.take_delay();
        return delay.has_value() ? delay : probes_.take_delay();
    }
    bool isSettled() const {
        return lines_.isSettled() && probes_.isSettled() && !probe_failure_.has_value();
    }

  private:
    ProgramLog lines_, probes_;
    ProgramLog *last_opened_ = &lines_;
    std::optional<Error> probe_failure_;
};

}  // namespace mw::task
