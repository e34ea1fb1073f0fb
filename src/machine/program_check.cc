// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/program_check.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "interp/interpreter.hh"
#include "interp/machine_frame.hh"
#include "machine/path_monitor.hh"

namespace mw::machine {
namespace {

/// Statements after which a program counts as endless.
constexpr std::uint64_t STATEMENT_BUDGET = 200000000;

/// Soft limits are compared with this slack, as rounding of offsets must not refuse a move to the very limit.
constexpr double LIMIT_SLACK = 1e-6;

class CheckCanon final : public interp::MachineCanon {
  public:
    CheckCanon(const MachineConfig &machine, diag::Sink &sink)
        : machine_(machine), sink_(sink), estimate_(machine) {
        estimate_.start(position);
        result.lowest.fill(1e300);
        result.highest.fill(-1e300);
    }

    CheckResult result;
    geom::Pose position;
    int tool = 0, selected = -1;

    void begin_block(const interp::BlockRef &block) override {
        ++result.blocks;
        file_ = block.file;
        text_ = block.text;
        line_ = block.line;
        estimate_.set_place(file_, line_);
    }
    void line(const interp::LineMove &move) override {
        ProgrammedPiece piece;
        piece.start = position;
        piece.end = move.end;
        estimate_.line(move.end, timed(move.settings));
        take(piece, move.settings.kind == interp::FeedKind::RAPID);
    }
    void arc(const interp::ArcMove &move) override {
        ProgrammedPiece piece;
        piece.start = position;
        piece.end = move.end;
        piece.centre = move.centre;
        piece.normal = move.normal;
        piece.angle_rad = move.angle_rad;
        check_arc(piece);
        interp::ArcMove timed_move = move;
        timed_move.settings = timed(move.settings);
        estimate_.arc(timed_move);
        take(piece, false);
    }
    void probe(const interp::LineMove &move, interp::ProbeKind) override {
        estimate_.stop();
        line(move);
        estimate_.stop();
    }
    void rigid_tap(const interp::LineMove &move, double) override {
        const geom::Pose back = position;
        line(move);
        interp::LineMove out = move;
        out.end = back;
        line(out);
    }
    void select_tool(int toolno) override { selected = toolno; }
    void change_tool() override {
        tool = selected >= 0 ? std::exchange(selected, -1) : tool;
        estimate_.set_tool(tool);
        for (const geom::Pose &end : task::tool_change_moves(machine_.task.tool_change_place, position)) {
            ProgrammedPiece piece;
            piece.start = position;
            piece.end = end;
            estimate_.line(end, rapid());
            take(piece, true);
        }
    }
    void change_tool_number(int toolno) override {
        tool = toolno;
        estimate_.set_tool(toolno);
    }
    void canon_error(std::string_view text) override { report(std::string(text), {}); }

    void dwell(double seconds) override { estimate_.dwell(seconds); }
    void tool_offset(const geom::Pose &) override {}
    void offsets(int, const geom::Pose &, const geom::Pose &, double) override {}
    void set_spindle_mode(int, double) override {}
    void set_spindle_speed(int, double speed) override { spindle_rpm_ = std::abs(speed); }
    void spindle_on(int, int, bool) override {}
    void spindle_off(int) override {}
    void orient_spindle(int, double, int) override {}
    void wait_orient_complete(int, double) override {}
    void set_tool_table_entry(int, const interp::ToolEntry &) override {}
    void coolant(bool, bool) override {}
    void feed_override(bool) override {}
    void speed_override(int, bool) override {}
    void feed_hold(bool) override {}
    void adaptive_feed(bool) override {}
    void set_digital_output(int, bool, bool) override {}
    void set_analog_output(int, double, bool) override {}
    void wait_input(int, bool, interp::WaitKind, double) override {}
    void program_stop() override { estimate_.stop(); }
    void optional_program_stop() override { estimate_.stop(); }
    void program_end() override {}
    void pallet_shuttle() override {}
    void finish() override {}
    void comment(std::string_view) override {}
    void message(std::string_view) override {}
    void print(std::string_view) override {}
    void log_open(std::string_view, bool) override {}
    void log(std::string_view) override {}
    void log_close() override {}
    void user_m_code(int, double, double) override {}

    void finish_time() { result.time = estimate_.finish(); }

  private:
    static interp::MoveSettings rapid() {
        interp::MoveSettings settings;
        settings.kind = interp::FeedKind::RAPID;
        return settings;
    }
    /// Moves that follow the spindle are timed at its programmed speed.
    interp::MoveSettings timed(const interp::MoveSettings &settings) const {
        interp::MoveSettings out = settings;
        if (settings.feed_per_revolution > 0 && spindle_rpm_ > 0) {
            out.feed = settings.feed_per_revolution * spindle_rpm_ / 60.0;
        }
        return out;
    }
    void take(const ProgrammedPiece &piece, bool isRapid) {
        ++result.moves;
        result.hasMoves = true;
        (isRapid ? result.rapid_length : result.cutting_length) += feed_length(piece);
        check_point(piece.end);
        position = piece.end;
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

    void report(std::string message, std::string hint) {
        if (line_ == reported_line_ || sink_.count_errors() >= MAX_CHECK_ERRORS) {
            return;
        }
        reported_line_ = line_;
        sink_.report(
            {diag::Severity::ERROR, {std::move(message), {file_, line_, 1}, std::move(hint)}, {}, text_});
    }

    const MachineConfig &machine_;
    diag::Sink &sink_;
    TimeEstimate estimate_;
    double spindle_rpm_ = 0;
    std::string file_, text_;
    int line_ = 0, reported_line_ = -1;
};

/// The world of a check: everything is where the program put it, probes trip at their end.
class CheckWorld final : public interp::World {
  public:
    CheckWorld(const MachineConfig &machine, const CheckCanon &canon) : machine_(machine), canon_(canon) {}
    interp::MachineSnapshot snapshot() const override {
        interp::MachineSnapshot s;
        s.position = canon_.position;
        s.probed_position = canon_.position;
        s.isProbeTripped = true;
        s.tool_in_spindle = canon_.tool;
        return s;
    }
    interp::LengthUnits machine_units() const override { return machine_.task.machine_units; }
    unsigned axis_mask() const override { return machine_.axis_mask; }
    int count_spindles() const override { return machine_.num_spindles; }
    bool isBlockDeleteOn() const override { return true; }
    bool isOptionalStopOn() const override { return true; }

  private:
    const MachineConfig &machine_;
    const CheckCanon &canon_;
};

}  // namespace

CheckResult check_program(const MachineConfig &machine, const std::string &program, interp::ToolSource &tools,
                          interp::ParameterSource &parameters, diag::Sink &sink) {
    CheckCanon canon(machine, sink);
    CheckWorld world(machine, canon);
    interp::MachineFrame frame(canon, machine.task.machine_units);
    interp::Settings settings = machine.task.interpreter;
    settings.statement_budget = STATEMENT_BUDGET;
    interp::Interpreter interpreter(frame, world, tools, parameters, settings);
    Result<> status;
    if (!machine.task.parameter_file.empty()) {
        status = interpreter.load_parameters(machine.task.parameter_file);
    }
    status = status.has_value() ? interpreter.begin() : status;
    status = status.has_value() ? interpreter.open(program) : status;
    if (!status.has_value()) {
        sink.error(status.error());
        return canon.result;
    }
    canon.result.blocks = 0;
    while (true) {
        const interp::Step step = interpreter.step();
        if (step == interp::Step::FAILED) {
            sink.report(interpreter.error());
            break;
        }
        if (step == interp::Step::SYNC) {
            interpreter.synch();
        } else if (step != interp::Step::OK) {
            break;
        }
    }
    if (!sink.hasErrors()) {
        canon.finish_time();
    }
    return canon.result;
}

}  // namespace mw::machine
