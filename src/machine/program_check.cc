// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/program_check.hh"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "machine/abilities.hh"
#include "machine/path_monitor.hh"

namespace mw::machine {
namespace {

/// Soft limits are compared with this slack, as rounding of offsets must not refuse a move to the very limit.
constexpr double LIMIT_SLACK = 1e-6;

/// Looks at each move of a preview.
class Checker {
  public:
    Checker(const MachineConfig &machine, diag::Sink &sink)
        : machine_(machine), sink_(sink), estimate_(machine) {
        estimate_.start({});
        result.lowest.fill(1e300);
        result.highest.fill(-1e300);
    }

    CheckResult result;

    /// `preview` names the places of the events.
    void take(std::span<const interp::PreviewEvent> events, const interp::Preview &preview) {
        preview_ = &preview;
        for (const interp::PreviewEvent &event : events) {
            event_ = &event;
            estimate_.set_place(preview.file(event.file), event.line, preview.section(event.section));
            take_event(event);
        }
    }
    void finish_time() { result.time = estimate_.finish(); }

  private:
    void take_event(const interp::PreviewEvent &event) {
        using Kind = interp::PreviewKind;
        if (const MissingAbility *missing = missing_ability(event); missing != nullptr) {
            report_impossible(*missing);
        }
        switch (event.kind) {
        case Kind::RAPID: take_line(event.start, event.end, event.settings); break;
        case Kind::FEED: take_line(event.start, event.end, timed(event)); break;
        case Kind::ARC: take_arc(event); break;
        case Kind::PROBE:
            estimate_.stop();
            take_line(event.start, event.end, timed(event));
            estimate_.stop();
            break;
        case Kind::RIGID_TAP:
            take_line(event.start, event.end, timed(event));
            take_line(event.end, event.start, timed(event));
            break;
        case Kind::DWELL: estimate_.dwell(event.value); break;
        case Kind::TOOL_CHANGE: estimate_.set_tool(event.number); break;
        case Kind::PLANNER: estimate_.set_smooth(event.number != 0); break;
        case Kind::STOP: estimate_.stop(); break;
        }
    }
    void take_line(const geom::Pose &start, const geom::Pose &end, const interp::MoveSettings &settings) {
        ProgrammedPiece piece;
        piece.start = start;
        piece.end = end;
        estimate_.line(end, settings);
        take_piece(piece, settings.kind == interp::FeedKind::RAPID);
    }
    void take_arc(const interp::PreviewEvent &event) {
        ProgrammedPiece piece;
        piece.start = event.start;
        piece.end = event.end;
        piece.centre = event.centre;
        piece.normal = event.normal;
        piece.angle_rad = event.angle_rad;
        check_arc(piece);
        estimate_.arc({event.end, event.centre, event.normal, event.angle_rad, timed(event)});
        take_piece(piece, false);
    }
    /// Moves that follow the spindle are timed at its programmed speed.
    static interp::MoveSettings timed(const interp::PreviewEvent &event) {
        interp::MoveSettings out = event.settings;
        if (out.feed_per_revolution > 0 && event.spindle_rpm > 0) {
            out.feed = out.feed_per_revolution * event.spindle_rpm / 60.0;
        }
        return out;
    }
    void take_piece(const ProgrammedPiece &piece, bool isRapid) {
        ++result.moves;
        result.hasMoves = true;
        (isRapid ? result.rapid_length : result.cutting_length) += feed_length(piece);
        check_point(piece.end);
    }

    void check_point(const geom::Pose &p) {
        for (int axis = 0; axis < MAX_AXES; ++axis) {
            if ((machine_.axis_mask & (1U << axis)) != 0) {
                check_coordinate(axis, p[axis]);
            }
        }
    }

    void check_coordinate(int axis, double value) {
        const auto i = static_cast<std::size_t>(axis);
        result.lowest[i] = std::min(result.lowest[i], value);
        result.highest[i] = std::max(result.highest[i], value);
        const bool isLow = value < machine_.axis_min[i] - LIMIT_SLACK;
        if (!isLow && value <= machine_.axis_max[i] + LIMIT_SLACK) {
            return;
        }
        const double limit = isLow ? machine_.axis_min[i] : machine_.axis_max[i];
        report(fmt::format("the move goes to {} = {:.4f}, beyond the {} limit {:g} of axis {}",
                           geom::AXIS_LETTERS[i], value, isLow ? "lower" : "upper", limit,
                           geom::AXIS_LETTERS[i]),
               fmt::format("[AXIS_{}]{}_LIMIT", geom::AXIS_LETTERS[i], isLow ? "MIN" : "MAX"));
    }

    /// The quarter points of the circle about each principal axis reach furthest; sixty-four chords bound
    /// them.
    void check_arc(const ProgrammedPiece &piece) {
        constexpr int STEPS = 64;
        const double radius = std::sqrt(std::max(0.0, radius_squared(piece)));
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double reach =
                radius * std::sqrt(std::max(0.0, 1.0 - piece.normal[axis] * piece.normal[axis]));
            const bool mayReach = piece.centre[axis] - reach < machine_.axis_min[i] ||
                                  piece.centre[axis] + reach > machine_.axis_max[i];
            if (!mayReach) {
                continue;
            }
            for (int step = 1; step < STEPS; ++step) {
                check_point(point_at(piece, static_cast<double>(step) / STEPS));
            }
            return;
        }
    }

    static double radius_squared(const ProgrammedPiece &piece) {
        const geom::Pose d = piece.start - piece.centre;
        double along = 0, all = 0;
        for (int axis = 0; axis < 3; ++axis) {
            along += d[axis] * piece.normal[axis];
            all += d[axis] * d[axis];
        }
        return all - along * along;
    }

    /// A line of a loop is told once.
    void report_impossible(const MissingAbility &missing) {
        const std::string &file = preview_->file(event_->file);
        const bool isKnown = std::ranges::any_of(result.impossible, [&](const Error &error) {
            return error.place.line == event_->line && error.place.file == file;
        });
        if (isKnown || result.impossible.size() >= MAX_CHECK_ERRORS) {
            return;
        }
        const int column = column_of_code(preview_->line_text(event_->file, event_->line), missing.code);
        Error error{fmt::format("a machine of this version cannot {} ({})", missing.what, missing.code),
                    {file, event_->line, column},
                    std::string(missing.remedy)};
        report(error.message, error.hint, column);
        result.impossible.push_back(std::move(error));
    }

    /// One message for each line, not for each axis.
    void report(std::string message, std::string hint, int column = 1) {
        if (event_->line == reported_line_ || sink_.count_errors() >= MAX_CHECK_ERRORS) {
            return;
        }
        reported_line_ = event_->line;
        sink_.report(
            {diag::Severity::ERROR,
             {std::move(message), {preview_->file(event_->file), event_->line, column}, std::move(hint)},
             {},
             preview_->line_text(event_->file, event_->line)});
    }

    const MachineConfig &machine_;
    diag::Sink &sink_;
    TimeEstimate estimate_;
    const interp::Preview *preview_ = nullptr;
    const interp::PreviewEvent *event_ = nullptr;
    int reported_line_ = -1;
};

}  // namespace

CheckResult check_program(const MachineConfig &machine, const std::string &program, interp::ToolSource &tools,
                          interp::ParameterSource &parameters, diag::Sink &sink, const CheckOptions &check) {
    interp::PreviewMachine stand;
    stand.interpreter = machine.task.interpreter;
    stand.units = machine.task.machine_units;
    stand.axis_mask = machine.axis_mask;
    stand.spindles = machine.num_spindles;
    stand.parameter_file = machine.task.parameter_file;
    stand.tool_change_moves = [&machine](const geom::Pose &position) {
        return task::tool_change_moves(machine.task.tool_change_place, position);
    };
    interp::PreviewOptions options;
    options.max_errors = MAX_CHECK_ERRORS;
    if (check.statements) {
        options.statement_budget = options.idle_budget = static_cast<std::uint64_t>(*check.statements);
        options.time_budget_s = 0;
    }
    Checker checker(machine, sink);
    interp::Preview *source = nullptr;
    interp::Preview preview(
        std::move(stand), tools, parameters, options,
        {[&](std::span<const interp::PreviewEvent> events) { checker.take(events, *source); },
         check.progress});
    source = &preview;
    const interp::PreviewEnd end = preview.run(program, sink);
    checker.result.blocks = preview.progress().blocks;
    if (end == interp::PreviewEnd::DONE && !sink.hasErrors()) {
        checker.finish_time();
    }
    return checker.result;
}

}  // namespace mw::machine
