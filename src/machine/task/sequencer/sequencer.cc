// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/sequencer.hh"

#include <type_traits>

#include "base/duration.hh"

namespace mw::task {
namespace {

/// Maximum number of items started in one task cycle, to keep the cycle short.
constexpr int ITEMS_PER_CYCLE = 500;

struct MoveSource {
    const motion::SourceTag &tag;
    bool isHolding;  ///< a cut waits until the spindle is at speed
};

motion::MoveTerms terms_of(const geometry::MoveSettings &settings, const MoveSource &source) {
    const bool waiting = source.isHolding && !settings.isRapid;
    return {settings, true, waiting, source.tag};
}

motion::PathBody path_body(const gcode::LineMove &line, const MoveSource &source) {
    return motion::Line{line.end, terms_of(line.settings, source)};
}

motion::PathBody path_body(const gcode::ArcMove &arc, const MoveSource &source) {
    return motion::Arc{arc.end,
                       arc.centre,
                       arc.normal,
                       arc.angle_rad,
                       geometry::norm_uvw(arc.normal) > 0,
                       terms_of(arc.settings, source)};
}

motion::PathBody path_body(const gcode::ProbeMove &probe, const MoveSource &source) {
    using gcode::ProbeKind;
    const bool away = probe.kind == ProbeKind::AWAY || probe.kind == ProbeKind::AWAY_ERROR;
    const bool trip_due = probe.kind == ProbeKind::TOWARD_ERROR || probe.kind == ProbeKind::AWAY_ERROR;
    return motion::Probe{probe.end, away, trip_due, terms_of(probe.settings, source)};
}

motion::PathBody path_body(const gcode::TapMove &tap, const MoveSource &source) {
    return motion::RigidTap{tap.end, tap.scale, terms_of(tap.settings, source)};
}

/// True if the visitor has completed the call; a visitor without a result always completes it.
template <class Visitor>
bool carry_out(const Visitor &visitor, const gcode::MachineCall &item) {
    return std::visit(
        [&](const AlternativeOf<gcode::MachineCall> auto &call) {
            if constexpr (std::is_same_v<decltype(visitor(call)), bool>) {
                return visitor(call);
            } else {
                visitor(call);
                return true;
            }
        },
        item);
}

/// Condition for starting a call.
enum class Need : std::uint8_t { NOTHING, IO, MOTION, OUTPUTS, MOTION_AND_IO };

Need need_of(const gcode::MachineCall &call) {
    return std::visit(
        Overloaded{
            [](const OneOf<gcode::LineMove, gcode::ArcMove, gcode::SetSpindleMode, gcode::OperatorMessage,
                           gcode::PrintLine, gcode::OpenLog, gcode::LogLine, gcode::CloseLog,
                           gcode::LogProbes, gcode::CanonError, gcode::ProgramComment,
                           gcode::PalletShuttle> auto &) { return Need::NOTHING; },
            [](const OneOf<gcode::SetDigitalOutput, gcode::SetAnalogOutput> auto &output) {
                return output.synched ? Need::NOTHING : Need::MOTION;
            },
            [](const OneOf<gcode::ProbeMove, gcode::TapMove, gcode::Dwell, gcode::UseToolOffset,
                           gcode::UseOffsets, gcode::UsePlanner, gcode::UseSpindleSpeed, gcode::StartSpindle,
                           gcode::StopSpindle, gcode::OrientSpindle, gcode::WaitOrientComplete,
                           gcode::SetToolTableEntry, gcode::ReloadTools, gcode::SwitchMist,
                           gcode::SwitchFlood, gcode::SwitchFeedOverride, gcode::SwitchSpeedOverride,
                           gcode::SwitchFeedHold, gcode::SwitchAdaptiveFeed, gcode::UserCode> auto &) {
                return Need::MOTION;
            },
            [](const gcode::SelectTool &) { return Need::IO; },  // the changer executes one request at a time
            [](const gcode::WaitInput &) { return Need::OUTPUTS; },
            [](const OneOf<gcode::ChangeTool, gcode::ChangeToolNumber, gcode::ProgramStop, gcode::ProgramEnd,
                           gcode::Finish> auto &) { return Need::MOTION_AND_IO; },
        },
        call);
}

/// True if the call reads or changes tool data.
bool isOfTools(const gcode::MachineCall &call) {
    return std::visit(
        []<class C>(const C &) {
            return OneOf<C, gcode::SelectTool, gcode::ChangeTool, gcode::ChangeToolNumber,
                         gcode::SetToolTableEntry, gcode::ReloadTools>;
        },
        call);
}

const Confinement *confinement_of(const SequencerEvents &events) {
    return events.confinement ? events.confinement() : nullptr;
}

}  // namespace

Sequencer::Sequencer(ItemQueue &queue, MotionLink &motion, io::DiscreteIo &io, ToolStore &tools,
                     SequencerEvents events, SequencerSettings settings)
    : queue_(queue), motion_(motion), io_(io), tools_(tools), events_(std::move(events)),
      settings_(std::move(settings)), tool_change_(settings_.changer_error_text),
      logs_(settings_.log_works, settings_.log_disk), wait_(motion, io, tools, logs_) {}

void Sequencer::step(std::int64_t now_ns, TravelRange reach) {
    held_ = false;
    blocked_ = ExecState::DONE;
    for (int i = 0; i < ITEMS_PER_CYCLE && !held_; ++i) {
        if (failed_ || !isWaitOver(now_ns) || step_done_) {
            return;
        }
        if (queue_.empty()) {
            motion_.flush();
            step_done_ = stepping_ && step_read_ != 0 && isIdle();
            return;
        }
        const Item &item = queue_.front();
        if (reach == TravelRange::NO_TOOLS && isOfTools(item.call)) {
            return;
        }
        if (isStepBoundary(item)) {
            blocked_ = ExecState::WAITING_FOR_MOTION;
            return;
        }
        if (!isReady(item)) {
            blocked_ = need_of(item.call) == Need::MOTION_AND_IO ? ExecState::WAITING_FOR_MOTION_AND_IO
                                                                 : ExecState::WAITING_FOR_MOTION;
            return;
        }
        const ItemPlace place{item.source, item.read};
        if (!execute(item, now_ns)) {
            blocked_ = ExecState::WAITING_FOR_MOTION_QUEUE;
            return;
        }
        last_begun_ = place;
        if (!queue_.empty()) {
            queue_.pop_front();
        }
    }
}

void Sequencer::check(const Result<> &result) {
    if (!result.has_value()) {
        failed_ = true;
        events_.fail(result.error().str());
    }
}

bool Sequencer::isWaitOver(std::int64_t now_ns) {
    Result<> failure;
    const bool ended = wait_.isOver(now_ns, events_.user_code_result, failure);
    check(failure);
    if (ended) {
        wait_.end();
    }
    return ended && !failed_;
}

bool Sequencer::isStepBoundary(const Item &item) {
    if (!stepping_) {
        return false;
    }
    if (step_read_ == 0) {
        step_read_ = item.read;
    }
    if (item.read == step_read_) {
        return false;
    }
    motion_.flush();
    step_done_ = motion_.isPathComplete() && io_.action() == io::ToolAction::IDLE;
    return true;
}

ItemPlace Sequencer::place() const {
    const Item *const sent = sent_.oldest_after(motion_.status().last_path_id);
    if (sent != nullptr) {
        return {sent->source, sent->read};
    }
    // Items that were taken back are at the front again.
    const bool returned = !queue_.empty() && queue_.front().source.block < last_begun_.source.block;
    return returned ? ItemPlace{queue_.front().source, queue_.front().read} : last_begun_;
}

void Sequencer::set_stepping(bool single) {
    stepping_ = single;
    step_done_ = false;
    step_read_ = 0;
}

bool Sequencer::isReady(const Item &item) {
    const Need need = need_of(item.call);
    const bool io_idle = io_.action() == io::ToolAction::IDLE;
    if (need == Need::NOTHING || need == Need::IO) {
        return need == Need::NOTHING || io_idle;
    }
    motion_.flush();
    const bool tool_table_due =
        std::holds_alternative<gcode::UserCode>(item.call);  // its program may read the outputs
    if (tool_table_due && !tools_.isSettled()) {
        return false;
    }
    const bool motion_done =
        motion_.isPathComplete() && (need != Need::OUTPUTS || motion_.areOutputsSettled());
    return motion_done && (need != Need::MOTION_AND_IO || io_idle);
}

bool Sequencer::execute(const Item &item, std::int64_t now_ns) {
    const auto turn = [this](motion::Switch what, int spindle, bool on) {
        motion_.send(motion::SetSwitch{what, spindle, on});
    };
    const MoveSource source{item.source, spindles_.isNextCutWaiting()};
    // If a handler returns false, it is called again in the next cycle.
    const auto visitor = Overloaded{
        [&](const OneOf<gcode::LineMove, gcode::ArcMove, gcode::TapMove> auto &move) {
            return push_move(path_body(move, source), move.settings, item);
        },
        [&](const gcode::ProbeMove &move) {
            probe_made_ = push_move(path_body(move, source), move.settings, item);
            return probe_made_;
        },
        [&](const OneOf<gcode::SetDigitalOutput, gcode::SetAnalogOutput> auto &output) {
            const bool taken = push_output(output);
            if (taken && output.synched) {
                sent_.note(motion_.last_path_id(), item, motion::programmed_position(motion_.status()));
            }
            return taken;
        },
        [&](const gcode::UsePlanner &planner) { return begin(planner); },
        [&](const OneOf<gcode::Dwell, gcode::WaitInput, gcode::WaitOrientComplete> auto &wait) {
            perform(wait, now_ns);
        },
        [&](const OneOf<gcode::UserCode, gcode::ChangeTool> auto &call) { perform(call); },
        [&](const gcode::ProgramStop &stop) { held_ = events_.stop(stop, item.source.line); },
        [&](const OneOf<gcode::ProgramEnd, gcode::Finish> auto &) {
            logs_.close();
            events_.end();
        },
        [&](const gcode::OperatorMessage &call) {
            events_.message(MessageKind::OPERATOR_DISPLAY, call.text);
        },
        [&](const gcode::CanonError &call) { events_.message(MessageKind::OPERATOR_ERROR, call.text); },
        [&](const gcode::PrintLine &call) { events_.print(call.text); },
        [&](const gcode::LogLine &call) { check(logs_.write(call)); },
        [&](const gcode::CloseLog &) { logs_.close_lines(); },
        [&](const OneOf<gcode::OpenLog, gcode::LogProbes> auto &call) {
            if (call.path.empty()) {  // for (probeclose)
                logs_.close_probes();
                return;
            }
            logs_.open(call, confinement_of(events_));
            wait_.begin(ProgramWait::For::LOG);
        },
        [&](const gcode::UseOffsets &offsets) {
            spindles_.use(offsets, motion_);
            events_.offsets(offsets);
        },
        [&](const gcode::UseToolOffset &offset) {
            spindles_.use(offset, motion_);
            wait_.begin_setting(events_.tool_offset(offset));
        },
        [&](const gcode::ReloadTools &) {
            check(tools_.reload());
            wait_.begin(ProgramWait::For::TOOL_DATA);
        },
        [&](const gcode::SelectTool &call) { check(tool_change_.select(call, tools_, io_)); },
        [&](const gcode::ChangeToolNumber &call) { check(tool_change_.set_number(call, tools_, io_)); },
        [&](const gcode::SetToolTableEntry &call) { check(tools_.set_entry(call.index, call.entry)); },
        [&](const gcode::SetSpindleMode &call) { spindles_.set_mode(call); },
        [&](const gcode::UseSpindleSpeed &call) { spindles_.set_speed(call, motion_); },
        [&](const gcode::StartSpindle &call) { spindles_.start(call, motion_); },
        [&](const gcode::StopSpindle &call) { spindles_.stop(call, motion_); },
        [&](const gcode::OrientSpindle &call) {
            wait_.note_orient(motion_.send(motion::SpindleOrient{call.spindle, call.angle_deg, call.mode}));
        },
        [&](const gcode::SwitchMist &call) { io_.set_mist(call.isOn); },
        [&](const gcode::SwitchFlood &call) { io_.set_flood(call.isOn); },
        [&](const gcode::SwitchFeedOverride &call) { turn(motion::Switch::FEED_OVERRIDE, 0, call.isOn); },
        [&](const gcode::SwitchSpeedOverride &call) {
            turn(motion::Switch::SPINDLE_OVERRIDE, call.spindle, call.isOn);
        },
        [&](const gcode::SwitchFeedHold &call) { turn(motion::Switch::FEED_HOLD, 0, call.isOn); },
        [&](const gcode::SwitchAdaptiveFeed &call) { turn(motion::Switch::ADAPTIVE_FEED, 0, call.isOn); },
        [](const OneOf<gcode::ProgramComment, gcode::PalletShuttle> auto &) {},
    };
    return carry_out(visitor, item.call);
}

bool Sequencer::push_move(const motion::PathBody &move, const geometry::MoveSettings &settings,
                          const Item &item) {
    if (!motion_.hasPathRoom() || !motion_.push_path(move, item.source)) {
        return false;
    }
    const geometry::Pose start =
        sent_.note(motion_.last_path_id(), item, motion::programmed_position(motion_.status()));
    if (move_listener_) {
        move_listener_({motion_.last_path_id(), start, move});
    }
    if (!settings.isRapid) {
        spindles_.end_wait();
    }
    return true;
}

bool Sequencer::push_output(const gcode::SetDigitalOutput &output) {
    if (output.synched) {
        return motion_.push_path(motion::SynchedDigitalOutput{output.index, output.isOn});
    }
    wait_.begin_setting(motion_.send(motion::SetDigitalOutput{output.index, output.isOn}));
    return true;
}

bool Sequencer::push_output(const gcode::SetAnalogOutput &output) {
    if (output.synched) {
        return motion_.push_path(motion::SynchedAnalogOutput{output.index, output.value});
    }
    wait_.begin_setting(motion_.send(motion::SetAnalogOutput{output.index, output.value}));
    return true;
}

void Sequencer::perform(const gcode::Dwell &dwell, std::int64_t now_ns) {
    wait_.begin_dwell(dwell.seconds, now_ns);
}

void Sequencer::perform(const gcode::WaitInput &input, std::int64_t now_ns) {
    wait_.begin_input(input, now_ns);
}

void Sequencer::perform(const gcode::WaitOrientComplete &orient, std::int64_t now_ns) {
    wait_.begin_orient(orient, now_ns);
}

bool Sequencer::begin(const gcode::UsePlanner &planner) {
    const auto setting = events_.planner_mode(planner);
    if (setting.value_or(0) != 0) {
        wait_.begin_setting(*setting);
    }
    return setting.has_value();
}

void Sequencer::perform(const gcode::UserCode &code) {
    events_.start_user_code(code);
    wait_.begin(ProgramWait::For::USER_CODE);
}

void Sequencer::perform(const gcode::ChangeTool &) {
    if (!tool_change_.isSelected()) {
        return;  // M6 without T since the last change keeps the tool in the spindle
    }
    if (!settings_.tool_change_with_spindle_on) {
        stop_spindles();
    }
    if (tool_change_.start(tools_, io_)) {
        wait_.begin(ProgramWait::For::TOOL);
    }
}

Result<> Sequencer::take_back(const geometry::Pose &place) {
    if (wait_.awaited() != ProgramWait::For::NONE && wait_.awaited() != ProgramWait::For::DWELL) {
        return fail("a tool change or another wait is active");
    }
    const std::string why = sent_.why_not(motion_.status(), place);
    if (!why.empty()) {
        return fail(why, {}, "it is being resumed or aborted");
    }
    const std::vector<Item> rest = sent_.rest(motion_.status(), place);
    queue_.insert(queue_.begin(), rest.begin(), rest.end());
    sent_.clear();
    stepping_ = step_done_ = false;
    return {};
}

void Sequencer::on_tool_event(io::ToolEvent event) {
    if (event == io::ToolEvent::CHANGED_LATE) {
        events_.message(MessageKind::OPERATOR_ERROR,
                        "the changer reports iocontrol.0.tool-changed after the change was aborted: check "
                        "which tool is in the spindle, and set it with M61 Q<number>");
        return;
    }
    if (event == io::ToolEvent::FAULT_TOLD) {
        events_.message(MessageKind::OPERATOR_ERROR, tool_change_.fault_text(io_));
    }
    check(tool_change_.on_event(event, tools_, io_));
}

void Sequencer::abort(int reason) {
    sent_.clear();
    last_begun_ = {};
    blocked_ = ExecState::DONE;
    logs_.close();
    queue_.clear();
    if (wait_.awaited() == ProgramWait::For::TOOL_DATA) {
        tools_.drop_reload();
    }
    wait_.end();
    tool_change_.abort(io_);
    spindles_.end_wait();
    stepping_ = false;
    step_done_ = false;
    failed_ = false;
    io_.abort(reason);
}

bool Sequencer::isIdle() const {
    return queue_.empty() && wait_.awaited() == ProgramWait::For::NONE && motion_.isPathComplete() &&
           io_.action() == io::ToolAction::IDLE;
}

}  // namespace mw::task
