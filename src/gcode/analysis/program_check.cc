// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/program_check.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "gcode/analysis/programmed_piece.hh"
#include "gcode/analysis/unscripted.hh"

namespace mw::gcode {
namespace {

/// Tolerance for soft limits: rounding of offsets must not reject a move to the exact limit.
constexpr double LIMIT_SLACK = 1e-6;

/// True if the move exceeds the limit from any start position of the machine.
using IsCertain = std::function<bool(const diagnostics::Diagnostic &)>;

/// Checks each move of a preview.
class Checker {
  public:
    Checker(const CheckedMachine &machine, diagnostics::Sink &sink, const CheckOptions &options,
            IsCertain is_certain)
        : machine_(machine), sink_(sink), options_(options), isCertain_(std::move(is_certain)),
          limits_(machine.limits), estimate_(machine.limits) {
        estimate_.start(machine.start.position);
        result.lowest.fill(1e300);
        result.highest.fill(-1e300);
    }

    CheckResult result;

    /// `preview` converts the positions of the events.
    void take(std::span<const PreviewEvent> events, const Preview &preview) {
        preview_ = &preview;
        timed_ = timed_ && (!options_.wantsTime || options_.wantsTime());
        for (const PreviewEvent &event : events) {
            event_ = &event;
            if (timed_) {
                estimate_.set_place(preview.file(event.file), event.line, preview.section(event.section));
                estimate_.take(event);
            }
            take_event(event);
        }
    }
    void finish_time() {
        if (timed_) {
            result.time = estimate_.finish();
        }
    }

  private:
    void take_event(const PreviewEvent &event) {
        using Kind = PreviewKind;
        ProgrammedPiece piece;
        piece.start = event.start;
        piece.end = event.end;
        switch (event.kind) {
        case Kind::RAPID:
            piece.isRapid = event.settings.isRapid;
            take_piece(piece);
            break;
        case Kind::FEED:
        case Kind::PROBE: take_piece(piece); break;
        case Kind::ARC:
            piece.centre = event.centre;
            piece.normal = event.normal;
            piece.angle_rad = event.angle_rad;
            check_arc(piece);
            take_piece(piece);
            break;
        case Kind::RIGID_TAP:
            take_piece(piece);
            std::swap(piece.start, piece.end);
            take_piece(piece);
            break;
        case Kind::DWELL:
        case Kind::TOOL_CHANGE:
        case Kind::PLANNER:
        case Kind::STOP: break;
        }
    }
    void take_piece(const ProgrammedPiece &piece) {
        ++result.moves;
        result.has_moves = true;
        (piece.isRapid ? result.rapid_length : result.cutting_length) += feed_length(piece);
        check_point(piece.end);
        add_points(piece);
    }
    void add_points(const ProgrammedPiece &piece) {
        if (options_.points == nullptr) {
            return;
        }
        constexpr double CHORDS = 48,
                         MOST_CHORDS = 100000;  ///< chords for a full circle; maximum for a piece
        const double turns = std::abs(piece.angle_rad) / (2 * std::numbers::pi);
        const int chords = static_cast<int>(std::clamp(std::ceil(CHORDS * turns), 1.0, MOST_CHORDS));
        const PieceShape shape(piece);
        for (int i = options_.points->all().empty() ? 0 : 1; i <= chords; ++i) {
            options_.points->add(shape.point_at(static_cast<double>(i) / chords), piece.isRapid);
        }
    }

    void check_point(const geometry::Pose &p) {
        for (int axis = 0; axis < MAX_AXES; ++axis) {
            if ((machine_.start.axis_mask & (1U << axis)) != 0) {
                check_coordinate(axis, p[axis]);
            }
        }
    }

    void check_coordinate(int axis, double value) {
        const auto i = static_cast<std::size_t>(axis);
        result.lowest[i] = std::min(result.lowest[i], value);
        result.highest[i] = std::max(result.highest[i], value);
        const bool is_low = value < limits_.low[axis] - LIMIT_SLACK;
        if (!is_low && value <= limits_.high[axis] + LIMIT_SLACK) {
            return;
        }
        const double limit = is_low ? limits_.low[axis] : limits_.high[axis];
        report(fmt::format("the move goes to {} = {:.4f}, outside the {} limit {:g} of axis {}",
                           geometry::AXIS_LETTERS[i], value, is_low ? "lower" : "upper", limit,
                           geometry::AXIS_LETTERS[i]),
               machine_.limit_key(axis, is_low));
    }

    /// Sixty-four chords per circle approximate the extreme positions along each axis.
    void check_arc(const ProgrammedPiece &piece) {
        constexpr int STEPS = 64;
        const double radius = std::sqrt(std::max(0.0, radius_squared(piece)));
        for (int axis = 0; axis < 3; ++axis) {
            const double reach =
                radius * std::sqrt(std::max(0.0, 1.0 - piece.normal[axis] * piece.normal[axis]));
            const bool may_reach = piece.centre[axis] - reach < limits_.low[axis] ||
                                   piece.centre[axis] + reach > limits_.high[axis];
            if (!may_reach) {
                continue;
            }
            const PieceShape shape(piece);
            for (int step = 1; step < STEPS; ++step) {
                check_point(shape.point_at(static_cast<double>(step) / STEPS));
            }
            return;
        }
    }

    static double radius_squared(const ProgrammedPiece &piece) {
        const geometry::Pose d = piece.start - piece.centre;
        double along = 0, all = 0;
        for (int axis = 0; axis < 3; ++axis) {
            along += d[axis] * piece.normal[axis];
            all += d[axis] * d[axis];
        }
        return all - along * along;
    }

    /// One message per line, not per axis.
    void report(std::string message, std::string hint, int column = 1) {
        if (event_->line == reported_line_ || sink_.count_errors() >= MAX_CHECK_ERRORS) {
            return;
        }
        diagnostics::Diagnostic error{
            diagnostics::Severity::ERROR,
            {std::move(message), {preview_->file(event_->file), event_->line, column}, std::move(hint)},
            {},
            preview_->line_text(event_->file, event_->line)};
        if (isCertain_ && !isCertain_(error)) {
            return;
        }
        reported_line_ = event_->line;
        sink_.report(error);
    }

    const CheckedMachine &machine_;
    diagnostics::Sink &sink_;
    const CheckOptions &options_;
    IsCertain isCertain_;  ///< empty: all findings are certain
    const TimedMachine &limits_;
    TimeEstimate estimate_;
    bool timed_ = true;
    const Preview *preview_ = nullptr;
    const PreviewEvent *event_ = nullptr;
    int reported_line_ = -1;
};

PreviewOptions preview_options(const CheckOptions &check) {
    PreviewOptions options;
    options.max_errors = MAX_CHECK_ERRORS;
    if (check.statements) {
        options.statement_budget = options.idle_budget = static_cast<std::uint64_t>(*check.statements);
        options.time_budget_s = 0;
    }
    return options;
}

/// Receiver of findings.
struct Findings {
    diagnostics::Sink &sink;
    IsCertain is_certain;
};

CheckResult check_from(const CheckedMachine &machine, const std::string &program,
                       const ProgramSources &sources, Findings findings, const CheckOptions &check) {
    Preview *source = nullptr;
    PreviewMachine stand = machine.start;
    stand.block_delete_on = check.block_delete_on;
    const auto tell_unknown = [&](std::string_view what) {
        if (source != nullptr) {
            source->flush();  // errors before this position are certain
        }
        check.unknown(source != nullptr ? source->place() : SourcePlace{}, what);
    };
    const bool has_scripts = !stand.interpreter.scripts.top_level.empty();
    UnknownHalValues unknown_values(sources.parameters, [&] { tell_unknown("a value of HAL"); });
    if (check.unknown) {
        stand.interpreter.make_script_host = [&]() -> Result<std::unique_ptr<ScriptHost>> {
            return std::make_unique<UnscriptedHost>([&] { tell_unknown("Python"); });
        };
    }
    // Definitions by scripts are unknown, so an error of the interpreter may have a cause that does not exist
    // on the machine.
    diagnostics::Sink errors([&](const diagnostics::Diagnostic &one) {
        if (check.unknown && has_scripts) {
            tell_unknown("Python");
        } else if (source != nullptr) {
            source->flush();  // flushes first, so that findings are in the order of the program
        }
        findings.sink.report(one);
    });
    Checker checker(machine, findings.sink, check, std::move(findings.is_certain));
    Preview preview(std::move(stand), sources.tools, check.unknown ? unknown_values : sources.parameters,
                    preview_options(check),
                    {[&](std::span<const PreviewEvent> events) { checker.take(events, *source); },
                     check.progress, check.unknown});
    source = &preview;
    const PreviewEnd end = preview.run(program, errors);
    checker.result.blocks = preview.progress().blocks;
    checker.result.cancelled = end == PreviewEnd::CANCELLED;
    if (end == PreviewEnd::DONE && !findings.sink.hasErrors()) {
        checker.finish_time();
    }
    return checker.result;
}

std::string words_of(const diagnostics::Diagnostic &one) {
    return fmt::format("{}:{}: {}", one.what.place.file, one.what.place.line, one.what.message);
}

/// Without trivial kinematics the pose before the start is unknown. A move that exceeds a limit from two
/// unrelated poses exceeds it from all poses. The second pose is only checked after a finding. The arguments
/// must outlive the result.
IsCertain beyond_from_elsewhere(const CheckedMachine &machine, const std::string &program,
                                const ProgramSources &sources, const CheckOptions &check) {
    return [&machine, &program, sources, &check,
            found = std::optional<std::set<std::string>>()](const diagnostics::Diagnostic &error) mutable {
        if (!found) {
            found.emplace();
            diagnostics::Sink collected(
                [&found](const diagnostics::Diagnostic &one) { found->insert(words_of(one)); });
            CheckOptions quiet;
            quiet.statements = check.statements;
            quiet.block_delete_on = check.block_delete_on;
            quiet.progress = check.progress;
            if (check.unknown) {
                quiet.unknown = [](const SourcePlace &, std::string_view) {};
            }
            quiet.wantsTime = [] { return false; };
            CheckedMachine elsewhere = machine;
            for (int axis = 0; axis < MAX_AXES; ++axis) {
                elsewhere.start.position[axis] += 17.37 + 0.913 * axis;
            }
            check_from(elsewhere, program, sources, {collected, {}}, quiet);
        }
        return found->contains(words_of(error));
    };
}

}  // namespace

CheckResult check_program(const CheckedMachine &machine, const std::string &program,
                          const ProgramSources &sources, diagnostics::Sink &sink, const CheckOptions &check) {
    return check_from(machine, program, sources,
                      {sink, machine.is_start_known
                                 ? IsCertain{}
                                 : beyond_from_elsewhere(machine, program, sources, check)},
                      check);
}

}  // namespace mw::gcode
