// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/start_check.hh"

#include <chrono>
#include <set>

#include "base/stop_signals.hh"
#include "machine/config/program_analysis.hh"
#include "programs/run/progress_line.hh"

namespace mw::programs {
namespace {

/// Fraction of the checking time after which the time calculation is abandoned in favour of further reading.
constexpr double SHARE_FOR_TIMES = 0.6;

/// Reports errors as errors while the course of the program is certain, and as warnings later.
class Judge {
  public:
    explicit Judge(diagnostics::Sink &sink) : sink_(sink) {}

    void take(diagnostics::Diagnostic one) {
        if (!unknown_.empty() && one.severity == diagnostics::Severity::ERROR) {
            one.severity = diagnostics::Severity::WARNING;
            one.what.message += " (if the program reaches this line)";
        }
        has_errors_ = has_errors_ || one.severity == diagnostics::Severity::ERROR;
        sink_.report(std::move(one));
    }
    void take_unknown(const SourcePlace &place, std::string_view what) {
        if (unknown_.insert(std::string(what)).second) {
            sink_.note("the rest of the program depends on " + std::string(what) +
                           ": errors after it cannot be found before the start",
                       place);
        }
    }
    bool hasErrors() const { return has_errors_; }

  private:
    diagnostics::Sink &sink_;
    std::set<std::string> unknown_;
    bool has_errors_ = false;
};

}  // namespace

StartCheck check_before_start(const machine::MachineConfig &machine, const std::string &program,
                              gcode::ToolSource &tools, gcode::ParameterSource &values,
                              diagnostics::Sink &sink, const StartCheckOptions &options) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto seconds = [begin] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    Judge judge(sink);
    ProgressLine progress;
    diagnostics::Sink found([&judge](const diagnostics::Diagnostic &one) { judge.take(one); });
    gcode::CheckOptions check;
    check.statements = 0;  // a program may be endless; other limits end the check
    check.block_delete_on = options.block_delete_on;
    check.progress = [&](const gcode::PreviewProgress &now) {
        progress.show(now);
        return stop_signal == 0 && now.blocks < options.most_blocks && seconds() < options.most_seconds;
    };
    check.unknown = [&judge](const SourcePlace &place, std::string_view what) {
        judge.take_unknown(place, what);
    };
    check.wantsTime = [&] {
        return options.wants_time && seconds() < SHARE_FOR_TIMES * options.most_seconds;
    };
    check.points = options.points;
    const gcode::CheckResult result =
        gcode::check_program(machine::checked_machine(machine), program, {tools, values}, found, check);
    progress.clear();
    return {judge.hasErrors(), !result.cancelled, result.blocks, result.time};
}

}  // namespace mw::programs
