// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/preview.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/limits.hh"
#include "base/text.hh"
#include "gcode/canon/frame.hh"
#include "gcode/canon/machine_frame.hh"
#include "gcode/canon/surface_speed.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

/// Numbers names in the order of their first use.
class NameList {
  public:
    std::uint32_t number_of(std::string_view name) {
        if (last_ < names_.size() && names_[last_] == name) {
            return last_;
        }
        const auto found = std::find(names_.begin(), names_.end(), name);
        last_ = static_cast<std::uint32_t>(found - names_.begin());
        if (found == names_.end()) {
            names_.emplace_back(name);
        }
        return last_;
    }
    const std::string &name(std::uint32_t number) const {
        static const std::string NONE;
        return number < names_.size() ? names_[number] : NONE;
    }

  private:
    std::vector<std::string> names_;
    std::uint32_t last_ = 0;
};

/// The programmed state of the spindles, and whether the next cut waits for a spindle, by the rules of task.
class ProgrammedSpindles {
  public:
    struct Spindle {
        double speed = 0, surface_unit = 0, css_max_rpm = 0;
        bool isTurning = false, waiting = false;
    };
    const Spindle &at(int number) const { return spindles_[static_cast<std::size_t>(number)]; }

    void take(const SetSpindleMode &one) { at(one.spindle).css_max_rpm = one.css_max_rpm; }
    void take(const UseSpindleSpeed &one) {
        Spindle &spindle = at(one.spindle);
        const double speed = std::abs(one.speed);
        const bool is_new = spindle.speed != speed || spindle.surface_unit != one.surface_unit;
        spindle.speed = speed;
        spindle.surface_unit = one.surface_unit;
        cut_waiting_ = is_new && spindle.isTurning ? spindle.waiting : cut_waiting_;
    }
    void take(const StartSpindle &one) {
        at(one.spindle).isTurning = true;
        at(one.spindle).waiting = cut_waiting_ = one.waiting;
    }
    void take(const StopSpindle &one) {
        at(one.spindle).isTurning = false;
        cut_waiting_ = cut_waiting_ && std::ranges::any_of(spindles_, &Spindle::isTurning);
    }
    /// True if this move waits for the spindle. Later cuts then do not wait.
    bool take_wait(const MoveSettings &move) {
        const bool awaited = cut_waiting_ && !move.isRapid;
        cut_waiting_ = cut_waiting_ && move.isRapid;
        return awaited;
    }

  private:
    Spindle &at(int number) { return spindles_[static_cast<std::size_t>(number)]; }

    std::array<Spindle, MAX_SPINDLES> spindles_{};
    bool cut_waiting_ = false;
};

/// The text after "section," in a comment; empty for another comment.
std::string_view section_name(std::string_view comment) {
    constexpr std::string_view KEY = "section,";
    comment = trim(comment);
    if (comment.size() < KEY.size() || !equals_ignoring_case(comment.substr(0, KEY.size()), KEY)) {
        return {};
    }
    return trim(comment.substr(KEY.size()));
}

/// Radius of an arc in XYZ or UVW that begins at `start`, normal to its axis. [machine units]
double arc_radius(const ArcMove &arc, const Pose &start) {
    double longest = 0;
    for (const int first : {geometry::AXIS_X, geometry::AXIS_U}) {
        double across = 0, along = 0, normal = 0;
        for (int axis = first; axis < first + 3; ++axis) {
            const double d = start[axis] - arc.centre[axis];
            across += d * d;
            along += d * arc.normal[axis];
            normal += arc.normal[axis] * arc.normal[axis];
        }
        longest = normal > 0 ? std::max(longest, std::sqrt(std::max(0.0, across - along * along))) : longest;
    }
    return longest;
}

}  // namespace

class Preview::Impl final : public MachineCanon, public World {
  public:
    Impl(PreviewMachine machine, ToolSource &tools, ParameterSource &parameters, PreviewOptions options,
         Listener listener)
        : machine_(std::move(machine)), options_(options), listener_(std::move(listener)),
          frame_(*this, machine_.units),
          interpreter_(frame_, *this, tools, parameters, with_budget(machine_.interpreter, options)),
          tool_(machine_.tool_in_spindle), position_(machine_.position) {
        batch_.reserve(options_.batch);
        frame_.set_position(position_);
    }

    void send() {
        if (!batch_.empty() && listener_.events) {
            listener_.events(batch_);
        }
        batch_.clear();
    }
    PreviewEnd run(const Result<> &opened, diagnostics::Sink &sink) {
        if (!opened) {
            sink.error(opened.error());
            return PreviewEnd::FAILED;
        }
        progress_ = {};
        const PreviewEnd end = go(sink);
        send();
        report_progress();
        return end;
    }
    Result<> begin() {
        Result<> status;
        if (!machine_.parameter_file.empty()) {
            status = interpreter_.load_parameters(machine_.parameter_file);
        }
        return status ? interpreter_.begin() : status;
    }
    Interpreter &interpreter() { return interpreter_; }
    const PreviewProgress &progress() const { return progress_; }
    SourcePlace place() const { return {interpreter_.file(), interpreter_.line(), 0}; }
    const NameList &files() const { return files_; }
    const NameList &sections() const { return sections_; }

    // ---- MachineCanon
    void begin_block(const BlockRef &block) override {
        ++progress_.blocks;
        place_.file = files_.number_of(block.file);
        place_.line = block.line;
        place_.sequence = block.sequence;
        place_.call_level = block.call_level;
        place_.section = block.call_level > 0 ? sections_.number_of(interpreter_.subroutine()) : section_;
    }
    void take(const MachineCall &call) override {
        std::visit(
            Overloaded{
                [this](const OneOf<ArcMove, TapMove, ChangeTool, ChangeToolNumber, ProgramComment,
                                   CanonError> auto &one) { show(one); },
                [this](const LineMove &move) {
                    add_move(move.settings.isRapid ? PreviewKind::RAPID : PreviewKind::FEED, move.end,
                             move.settings);
                },
                [this](const ProbeMove &move) {
                    add_move(PreviewKind::PROBE, move.end, move.settings);
                    tell_unknown("the result of a probe");
                },
                [this](const WaitInput &) { tell_unknown("an input (M66)"); },
                [this](const Dwell &dwell) { add_standing(PreviewKind::DWELL, 0, dwell.seconds); },
                [this](const UsePlanner &one) {
                    add_standing(PreviewKind::PLANNER, one.isSmooth ? 1 : 0, 0);
                },
                [this](const UseToolOffset &one) { tool_offset_ = one.offset; },
                [this](const UseOffsets &one) { offsets_ = one; },
                [this](const OneOf<SetSpindleMode, UseSpindleSpeed, StartSpindle, StopSpindle> auto &one) {
                    spindles_.take(one);
                },
                [this](const SelectTool &one) { selected_ = one.toolno; },
                [this](const OneOf<ProgramStop, PalletShuttle> auto &) {
                    add_standing(PreviewKind::STOP, 0, 0);
                },
                [](const OneOf<OrientSpindle, WaitOrientComplete, SetToolTableEntry, ReloadTools, SwitchMist,
                               SwitchFlood, SwitchFeedOverride, SwitchSpeedOverride, SwitchFeedHold,
                               SwitchAdaptiveFeed, SetDigitalOutput, SetAnalogOutput, ProgramEnd, Finish,
                               UserCode, OperatorMessage, PrintLine, OpenLog, LogLine, CloseLog,
                               LogProbes> auto &) {},
            },
            call);
    }

    // ---- World: every action ends as programmed; probes trip at the end of their move.
    MachineSnapshot snapshot() const override {
        MachineSnapshot s;
        s.position = s.probed_position = position_;
        s.isProbeTripped = true;
        s.tool_in_spindle = tool_;
        return s;
    }
    LengthUnits machine_units() const override { return machine_.units; }
    unsigned axis_mask() const override { return machine_.axis_mask; }
    int count_spindles() const override { return machine_.spindles; }
    bool isBlockDeleteOn() const override { return machine_.block_delete_on; }
    bool isOptionalStopOn() const override { return true; }

  private:
    void show(const ArcMove &move) {
        PreviewEvent event = place_;
        event.kind = PreviewKind::ARC;
        event.centre = convert(move.centre);
        event.normal = convert_direction(move.normal);
        event.angle_rad = move.angle_rad;
        event.settings = move.settings;
        go_to(event, move.end, std::abs(move.angle_rad) * arc_radius(move, position_));
    }
    void show(const TapMove &move) {
        const Pose back = position_;
        add_move(PreviewKind::RIGID_TAP, move.end, move.settings);
        position_ = back;
    }
    void show(const ChangeTool &) {
        show(ChangeToolNumber{selected_ >= 0 ? std::exchange(selected_, -1) : tool_});
        if (machine_.tool_change_moves) {
            MoveSettings rapid;
            rapid.isRapid = true;
            for (const Pose &end : machine_.tool_change_moves(position_)) {
                place_.by_machine = true;
                add_move(PreviewKind::RAPID, end, rapid);
                place_.by_machine = false;
            }
            frame_.set_position(position_);
        }
    }
    void show(const ChangeToolNumber &call) {
        tool_ = call.toolno;
        add_standing(PreviewKind::TOOL_CHANGE, call.toolno, 0);
    }
    void show(const ProgramComment &comment) {
        if (const std::string_view name = section_name(comment.text); !name.empty()) {
            section_ = sections_.number_of(name);
        }
    }
    void show(const CanonError &error) {
        if (sink_ != nullptr) {
            sink_->error(error.text, {files_.name(place_.file), place_.line, 0});
        }
    }

    static Settings with_budget(Settings settings, const PreviewOptions &options) {
        settings.statement_budget = options.statement_budget;
        settings.idle_budget = options.idle_budget;
        settings.time_budget_s = options.time_budget_s;
        return settings;
    }

    PreviewEnd go(diagnostics::Sink &sink) {
        sink_ = &sink;
        int errors = 0;
        for (std::uint64_t steps = 1;; ++steps) {
            const Step step = interpreter_.step();
            if (step == Step::FAILED) {
                sink.report(interpreter_.error());
                if (!interpreter_.isContinuable()) {
                    report_rest(sink, options_.max_errors - errors - 1);
                }
                if (++errors >= options_.max_errors || !interpreter_.isContinuable() ||
                    interpreter_.isAtFileEnd()) {
                    break;
                }
            } else if (step == Step::SYNC) {
                interpreter_.synch();
            } else if (step != Step::OK) {
                break;
            }
            if (steps % options_.blocks_per_report == 0 && !report_progress()) {
                return PreviewEnd::CANCELLED;
            }
        }
        return errors > 0 ? PreviewEnd::FAILED : PreviewEnd::DONE;
    }

    /// After an error that ends the interpretation, reports the remaining syntax errors.
    void report_rest(diagnostics::Sink &sink, int most) {
        const diagnostics::Diagnostic failed = interpreter_.error();
        const SourcePlace &place = failed.called_from.empty() ? failed.what.place : failed.called_from.back();
        for (diagnostics::Diagnostic &one : interpreter_.syntax_errors(place.line, most)) {
            sink.report(std::move(one));
        }
    }

    bool report_progress() {
        const FilePlace place = interpreter_.place_in_file();
        progress_.bytes = place.bytes;
        progress_.bytes_in_all = place.bytes_in_all;
        return !listener_.progress || listener_.progress(progress_);
    }

    Pose convert(const Pose &machine) const {
        switch (options_.coordinates) {
        case PreviewCoordinates::MACHINE: return machine;
        case PreviewCoordinates::TIP: return machine - tool_offset_;
        case PreviewCoordinates::PROGRAM: return frame_.to_program(machine);
        }
        return machine;
    }
    Pose convert_direction(Pose direction) const {
        if (options_.coordinates == PreviewCoordinates::PROGRAM) {
            detail::rotate_xy(direction, -offsets_.rotation_xy_deg);
        }
        return direction;
    }

    void add_move(PreviewKind kind, const Pose &end, const MoveSettings &settings) {
        PreviewEvent event = place_;
        event.kind = kind;
        event.settings = settings;
        go_to(event, end);
    }
    void go_to(PreviewEvent &event, const Pose &end, double arc_length = 0) {
        mark_progress(event.settings, std::max(geometry::norm(end - position_), arc_length));
        event.start = convert(position_);
        event.end = convert(end);
        event.tool_offset = tool_offset_;
        event.spindle_awaited = spindles_.take_wait(event.settings);
        if (event.settings.feed_per_revolution > 0) {
            event.spindle_rpm = spindle_rpm(event.settings.synch_spindle, 0.5 * (position_[0] + end[0]));
        }
        position_ = end;
        add(event);
    }
    /// Spindle speed with the tool at machine X `x`.
    double spindle_rpm(int spindle, double x) const {
        const ProgrammedSpindles::Spindle &state = spindles_.at(spindle);
        if (!(state.css_max_rpm > 0)) {
            return state.speed;
        }
        const double radius =
            std::abs(x - centre_line_x(offsets_.g5x, offsets_.g92, offsets_.rotation_xy_deg, tool_offset_));
        const double factor = surface_speed_factor(state.speed, state.surface_unit);
        return factor < state.css_max_rpm * radius ? factor / radius : state.css_max_rpm;
    }
    /// Adds the minimum time of a move. Used to find endless loops that contain moves.
    void mark_progress(const MoveSettings &settings, double length) {
        constexpr double FASTEST_MM_S = 1000.0;
        const double fastest = FASTEST_MM_S / mm_per_machine_unit();
        const double speed = settings.feed > 0 ? std::min(settings.feed, fastest) : fastest;
        if (length > 0) {
            interpreter_.mark_progress(length / speed);
        }
    }
    void add_standing(PreviewKind kind, int number, double value) {
        PreviewEvent event = place_;
        event.kind = kind;
        event.number = number;
        event.value = value;
        event.start = event.end = convert(position_);
        const bool waiting = kind == PreviewKind::STOP || kind == PreviewKind::TOOL_CHANGE;
        if (const double seconds = kind == PreviewKind::DWELL ? value : (waiting ? 1.0 : 0.0); seconds > 0) {
            interpreter_.mark_progress(seconds);
        }
        add(event);
    }
    void add(const PreviewEvent &event) {
        ++progress_.events;
        batch_.push_back(event);
        if (batch_.size() >= options_.batch) {
            send();
        }
    }
    void tell_unknown(std::string_view what) {
        send();
        if (listener_.unknown) {
            listener_.unknown(place_of_block(), what);
        }
    }
    SourcePlace place_of_block() const { return {files_.name(place_.file), place_.line, 0}; }

    PreviewMachine machine_;
    PreviewOptions options_;
    Listener listener_;
    MachineFrame frame_;
    Interpreter interpreter_;
    PreviewProgress progress_;
    std::vector<PreviewEvent> batch_;
    PreviewEvent place_;  ///< position of the current block, copied into each event
    NameList files_, sections_;
    std::uint32_t section_ = sections_.number_of("");
    int tool_, selected_ = -1;
    ProgrammedSpindles spindles_;
    Pose position_, tool_offset_;
    UseOffsets offsets_;
    diagnostics::Sink *sink_ = nullptr;
};

Preview::Preview(PreviewMachine machine, ToolSource &tools, ParameterSource &parameters,
                 PreviewOptions options, Listener listener)
    : impl_(std::make_unique<Impl>(std::move(machine), tools, parameters, options, std::move(listener))) {}

Preview::~Preview() = default;

PreviewEnd Preview::run(const std::string &path, diagnostics::Sink &sink) {
    Result<> status = impl_->begin();
    status = status ? impl_->interpreter().open(path) : status;
    return impl_->run(status, sink);
}

PreviewEnd Preview::run_text(const std::string &name, std::string text, diagnostics::Sink &sink) {
    const Result<> status = impl_->begin();
    if (status) {
        impl_->interpreter().open_text(name, std::move(text));
    }
    return impl_->run(status, sink);
}

const PreviewProgress &Preview::progress() const {
    return impl_->progress();
}

const std::string &Preview::file(std::uint32_t index) const {
    return impl_->files().name(index);
}

const std::string &Preview::section(std::uint32_t index) const {
    return impl_->sections().name(index);
}

SourcePlace Preview::place() const {
    return impl_->place();
}

void Preview::flush() {
    impl_->send();
}

std::string Preview::line_text(std::uint32_t file, int line) const {
    return impl_->interpreter().line_text(impl_->files().name(file), line);
}

}  // namespace mw::gcode
