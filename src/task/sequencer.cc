// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/sequencer.hh"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace mw::task {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
/// Items issued in one task cycle at most, so that the cycle stays short.
constexpr int ITEMS_PER_CYCLE = 500;

template <class... Handlers>
struct Overloaded : Handlers... {
    using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

std::int64_t to_ns(double seconds) {
    return static_cast<std::int64_t>(std::llround(seconds * static_cast<double>(NS_PER_S)));
}

motion::PathMode path_mode(interp::MotionControl control) {
    switch (control) {
    case interp::MotionControl::EXACT_STOP: return motion::PathMode::EXACT_STOP;
    case interp::MotionControl::EXACT_PATH: return motion::PathMode::EXACT_PATH;
    case interp::MotionControl::CONTINUOUS: break;
    }
    return motion::PathMode::BLEND;
}

}  // namespace

Sequencer::Sequencer(ItemQueue &queue, MotionLink &motion, io::Controller &io, ToolStore &tools,
                     SequencerEvents events, SequencerSettings settings)
    : queue_(queue), motion_(motion), io_(io), tools_(tools), events_(std::move(events)),
      settings_(settings) {}

Sequencer::Need Sequencer::need_of(const ItemBody &body) {
    return std::visit(
        Overloaded{
            [](const LineItem &) { return Need::NOTHING; },
            [](const ArcItem &) { return Need::NOTHING; },
            [](const ProbeItem &) { return Need::MOTION; },
            [](const RigidTapItem &) { return Need::MOTION; },
            [](const SpindleModeItem &) { return Need::NOTHING; },
            [](const SelectToolItem &) { return Need::NOTHING; },
            [](const ChangeToolItem &) { return Need::MOTION_AND_IO; },
            [](const ChangeToolNumberItem &) { return Need::MOTION_AND_IO; },
            [](const DigitalOutputItem &item) { return item.isSynched ? Need::NOTHING : Need::MOTION; },
            [](const AnalogOutputItem &item) { return item.isSynched ? Need::NOTHING : Need::MOTION; },
            [](const StopItem &) { return Need::MOTION_AND_IO; },
            [](const EndItem &) { return Need::MOTION_AND_IO; },
            [](const MessageItem &) { return Need::NOTHING; },
            [](const PrintItem &) { return Need::NOTHING; },
            [](const LogItem &) { return Need::NOTHING; },
            [](const auto &) { return Need::MOTION; },
        },
        body);
}

void Sequencer::step(std::int64_t now_ns) {
    isHeld_ = false;
    for (int i = 0; i < ITEMS_PER_CYCLE && !isHeld_; ++i) {
        if (hasFailed_ || !isWaitOver(now_ns) || isStepDone_) {
            return;
        }
        if (queue_.empty()) {
            motion_.flush();
            isStepDone_ = isStepping_ && isIdle();
            return;
        }
        const Item &item = queue_.front();
        if (isStepBoundary(item) || !isReady(item) || !execute(item, now_ns)) {
            return;
        }
        if (!queue_.empty()) {
            queue_.pop_front();
        }
    }
}

void Sequencer::fail_item(const std::string &text) {
    hasFailed_ = true;
    events_.fail(text);
}

bool Sequencer::isStepBoundary(const Item &item) {
    if (!isStepping_) {
        return false;
    }
    if (step_block_ == 0) {
        step_block_ = item.source.block;
    }
    if (item.source.block == step_block_) {
        return false;
    }
    motion_.flush();
    isStepDone_ = motion_.isPathComplete() && io_.action() == io::ToolAction::IDLE;
    return true;
}

void Sequencer::start_step() {
    isStepping_ = true;
    isStepDone_ = false;
    step_block_ = 0;
}

bool Sequencer::isReady(const Item &item) {
    const Need need = need_of(item.body);
    if (need == Need::NOTHING) {
        return true;
    }
    motion_.flush();
    const bool isIoIdle = io_.action() == io::ToolAction::IDLE;
    return motion_.isPathComplete() && (need == Need::MOTION || isIoIdle);
}

bool Sequencer::execute(const Item &item, std::int64_t now_ns) {
    return std::visit(
        Overloaded{
            [&](const LineItem &) { return push_move(item); },
            [&](const ArcItem &) { return push_move(item); },
            [&](const ProbeItem &) { return isProbeMade_ = push_move(item), isProbeMade_; },
            [&](const RigidTapItem &) { return push_move(item); },
            [&](const DwellItem &dwell) { return begin(dwell, now_ns); },
            [&](const WaitInputItem &input) { return begin(input, now_ns); },
            [&](const StopItem &stop) {
                isHeld_ = events_.stop(stop, item.source.line);
                return true;
            },
            [&](const EndItem &end) {
                close_logs();
                events_.end(end);
                return true;
            },
            [&](const MessageItem &message) {
                events_.message(message.kind, message.text);
                return true;
            },
            [&](const PrintItem &print) {
                events_.print(print.text);
                return true;
            },
            [&](const LogItem &log) {
                execute_log(log);
                return true;
            },
            [&](const OffsetsItem &offsets) {
                offsets_ = offsets;
                follow_offsets();
                events_.offsets(offsets);
                return true;
            },
            [&](const ToolOffsetItem &offset) {
                tool_offset_ = offset;
                follow_offsets();
                // Done once motion has it, so that pins show it when G43 is over.
                awaited_setting_ = events_.tool_offset(offset);
                wait_ = Wait::SETTING;
                return true;
            },
            [&](const WaitOrientItem &orient) { return begin(orient, now_ns); },
            [&](const PlannerModeItem &mode) { return begin(mode); },
            [&](const UserCodeItem &code) { return begin(code); },
            [&](const DigitalOutputItem &output) {
                return !output.isSynched ||
                               motion_.push_path(motion::SynchedDigitalOutput{output.index, output.isOn})
                           ? (execute_output(item), true)
                           : false;
            },
            [&](const AnalogOutputItem &output) {
                return !output.isSynched ||
                               motion_.push_path(motion::SynchedAnalogOutput{output.index, output.value})
                           ? (execute_output(item), true)
                           : false;
            },
            [&](const ReloadToolsItem &) {
                if (const auto reloaded = tools_.reload(); !reloaded.has_value()) {
                    fail_item(reloaded.error().str());
                }
                return true;
            },
            [&](const SelectToolItem &) { return execute_tool(item), true; },
            [&](const ChangeToolItem &) { return execute_tool(item), true; },
            [&](const ChangeToolNumberItem &) { return execute_tool(item), true; },
            [&](const ToolEntryItem &) { return execute_tool(item), true; },
            [&](const auto &) { return execute_output(item), true; },
        },
        item.body);
}

bool Sequencer::begin(const DwellItem &dwell, std::int64_t now_ns) {
    wait_ = Wait::DWELL;
    deadline_ns_ = now_ns + to_ns(dwell.seconds);
    return true;
}

bool Sequencer::begin(const WaitInputItem &input, std::int64_t now_ns) {
    awaited_input_ = input;
    wait_ = Wait::INPUT;
    deadline_ns_ = now_ns + to_ns(input.timeout_s);
    last_input_ = std::nan("");
    isInputTimedOut_ = false;
    return true;
}

bool Sequencer::begin(const WaitOrientItem &orient, std::int64_t now_ns) {
    wait_ = Wait::ORIENT;
    awaited_spindle_ = orient.spindle;
    orient_timeout_s_ = orient.timeout_s;
    deadline_ns_ = now_ns + to_ns(orient.timeout_s);
    isOrientTold_ = false;
    return true;
}

bool Sequencer::begin(const PlannerModeItem &mode) {
    const auto setting = events_.planner_mode(mode);
    awaited_setting_ = setting.value_or(0);
    wait_ = awaited_setting_ != 0 ? Wait::SETTING : Wait::NONE;
    return setting.has_value();
}

bool Sequencer::begin(const UserCodeItem &code) {
    const auto started = events_.start_user_code(code);
    if (!started.has_value()) {
        fail_item(started.error().str());
        return true;
    }
    wait_ = Wait::USER_CODE;
    return true;
}

motion::MoveTerms Sequencer::terms_of(const interp::MoveSettings &settings, motion::MotionType type,
                                      const Item &item) {
    motion::MoveTerms terms;
    terms.type = settings.kind == interp::FeedKind::RAPID ? motion::MotionType::TRAVERSE : type;
    terms.mode = path_mode(settings.control);
    terms.feed = settings.feed;
    terms.tolerance = settings.tolerance;
    terms.naivecam_tolerance = settings.naivecam_tolerance;
    terms.corner_scale = settings.corner_scale;
    terms.feed_per_revolution = settings.feed_per_revolution;
    terms.synch_spindle = static_cast<std::int8_t>(settings.synch_spindle);
    terms.isVelocitySynched = settings.isVelocitySynched;
    terms.isWaitingForSpindleSpeed = isNextMoveWaitingForSpeed_ && settings.kind != interp::FeedKind::RAPID;
    terms.source = item.source;
    return terms;
}

bool Sequencer::push_move(const Item &item) {
    if (!motion_.hasPathRoom()) {
        return false;
    }
    motion::PathBody body;
    if (const auto *line = std::get_if<LineItem>(&item.body)) {
        body = motion::Line{line->move.end, terms_of(line->move.settings, motion::MotionType::FEED, item)};
    } else if (const auto *arc = std::get_if<ArcItem>(&item.body)) {
        body = motion::Arc{arc->move.end,
                           arc->move.centre,
                           arc->move.normal,
                           arc->move.angle_rad,
                           geom::norm_uvw(arc->move.normal) > 0,
                           terms_of(arc->move.settings, motion::MotionType::ARC, item)};
    } else if (const auto *probe = std::get_if<ProbeItem>(&item.body)) {
        using interp::ProbeKind;
        const bool isAway = probe->kind == ProbeKind::AWAY || probe->kind == ProbeKind::AWAY_ERROR;
        const bool mustTrip = probe->kind == ProbeKind::TOWARD_ERROR || probe->kind == ProbeKind::AWAY_ERROR;
        body = motion::Probe{probe->move.end, isAway, mustTrip,
                             terms_of(probe->move.settings, motion::MotionType::PROBING, item)};
    } else if (const auto *tap = std::get_if<RigidTapItem>(&item.body)) {
        body = motion::RigidTap{tap->move.end, tap->scale,
                                terms_of(tap->move.settings, motion::MotionType::FEED, item)};
    }
    const bool isFeed = !std::holds_alternative<LineItem>(item.body) ||
                        std::get<LineItem>(item.body).move.settings.kind != interp::FeedKind::RAPID;
    if (!motion_.push_path(body, item.source)) {
        return false;
    }
    if (move_listener_) {
        move_listener_(motion_.last_path_id(), body);
    }
    isNextMoveWaitingForSpeed_ = isNextMoveWaitingForSpeed_ && !isFeed;
    return true;
}

void Sequencer::execute_output(const Item &item) {
    std::visit(Overloaded{
                   [&](const SpindleModeItem &mode) {
                       spindles_[static_cast<std::size_t>(mode.spindle)].css_max_rpm = mode.css_max_rpm;
                   },
                   [&](const SpindleSpeedItem &speed) {
                       SpindleState &state = spindles_[static_cast<std::size_t>(speed.spindle)];
                       const bool isNew =
                           state.speed != speed.speed || state.surface_unit != speed.surface_unit;
                       state.speed = speed.speed;
                       state.surface_unit = speed.surface_unit;
                       if (isNew && state.direction != 0) {
                           send_spindle(speed.spindle);
                       }
                   },
                   [&](const SpindleOnItem &on) {
                       SpindleState &state = spindles_[static_cast<std::size_t>(on.spindle)];
                       state.direction = on.direction;
                       state.isWaiting = on.isWaiting;
                       send_spindle(on.spindle);
                   },
                   [&](const SpindleOffItem &off) {
                       spindles_[static_cast<std::size_t>(off.spindle)].direction = 0;
                       motion_.send(motion::SpindleOff{off.spindle});
                   },
                   [&](const SpindleOrientItem &orient) {
                       orient_command_ =
                           motion_.send(motion::SpindleOrient{orient.spindle, orient.angle_deg, orient.mode});
                   },
                   [&](const CoolantItem &coolant) {
                       coolant.isMist ? io_.set_mist(coolant.isOn) : io_.set_flood(coolant.isOn);
                   },
                   [&](const OverrideSwitchItem &s) {
                       motion_.send(motion::SetSwitch{s.what, s.spindle, s.isEnabled});
                   },
                   [&](const DigitalOutputItem &output) {
                       if (!output.isSynched) {
                           motion_.send(motion::SetDigitalOutput{output.index, output.isOn});
                       }
                   },
                   [&](const AnalogOutputItem &output) {
                       if (!output.isSynched) {
                           motion_.send(motion::SetAnalogOutput{output.index, output.value});
                       }
                   },
                   [](const auto &) {},
               },
               item.body);
}

interp::ToolEntry Sequencer::tool_at(int index) const {
    interp::ToolEntry none;
    none.toolno = 0;
    return index > 0 ? tools_.entry(index) : none;
}

void Sequencer::execute_tool(const Item &item) {
    if (const auto *select = std::get_if<SelectToolItem>(&item.body)) {
        const int index = select->toolno == 0 ? 0 : tools_.index_of_tool(select->toolno);
        if (index < 0) {
            fail_item("tool " + std::to_string(select->toolno) + " is not in the tool table");
            return;
        }
        const interp::ToolEntry entry = tool_at(index);
        selected_index_ = index;
        io_.start_prepare(select->toolno, entry.pocketno, index);
    } else if (std::holds_alternative<ChangeToolItem>(item.body)) {
        if (selected_index_ < 0) {
            return;  // M6 without T since the last change: the tool in the spindle stays
        }
        if (!settings_.isToolChangeWithSpindleOn) {
            stop_spindles();
        }
        changing_index_ = selected_index_;
        io_.start_change();
        wait_ = Wait::TOOL;
    } else if (const auto *number = std::get_if<ChangeToolNumberItem>(&item.body)) {
        const int index = number->toolno == 0 ? 0 : tools_.index_of_tool(number->toolno);
        const auto loaded = tools_.load_spindle(index);
        if (!loaded.has_value()) {
            fail_item(loaded.error().str());
        }
        io_.set_tool_in_spindle(number->toolno, tool_at(index).pocketno);
    } else if (const auto *entry = std::get_if<ToolEntryItem>(&item.body)) {
        const auto saved = tools_.set_entry(entry->index, entry->entry);
        if (!saved.has_value()) {
            fail_item(saved.error().str());
        }
    }
}

void Sequencer::on_tool_event(io::ToolEvent event) {
    if (event == io::ToolEvent::FAULT) {
        fail_item("the tool changer reports a fault (iocontrol.0.toolchanger-reason " +
                  std::to_string(io_.fault_reason()) + ")");
    } else if (event == io::ToolEvent::CHANGED && changing_index_ >= 0) {
        const interp::ToolEntry entry = tool_at(changing_index_);
        const auto loaded = tools_.load_spindle(changing_index_);
        if (!loaded.has_value()) {
            fail_item(loaded.error().str());
        }
        io_.set_tool_in_spindle(entry.toolno, entry.pocketno);
        changing_index_ = -1;
        selected_index_ = -1;
    }
}

void Sequencer::open_log(LogFile &log, const LogItem &item) {
    log.path = item.text;
    log.file.reset();  // the same file may be opened again
    log.file.reset(std::fopen(item.text.c_str(), item.what == LogItem::What::APPEND ? "ae" : "we"));
    if (log.file == nullptr) {
        fail_item("cannot write " + item.text + ": " + std::strerror(errno));
        return;
    }
    std::setvbuf(log.file.get(), nullptr, _IOLBF, BUFSIZ);
}

void Sequencer::execute_log(const LogItem &item) {
    LogFile &log = logs_[item.isProbe ? 1 : 0];
    switch (item.what) {
    case LogItem::What::OPEN:
    case LogItem::What::APPEND: open_log(log, item); break;
    case LogItem::What::WRITE:
        if (log.file != nullptr && std::fputs((item.text + '\n').c_str(), log.file.get()) < 0) {
            log.file.reset();
            fail_item("cannot write " + log.path + ": " + std::strerror(errno));
        }
        break;
    case LogItem::What::CLOSE: log.file.reset(); break;
    }
}

void Sequencer::log_probe(const std::string &line) {
    execute_log({LogItem::What::WRITE, line, true});
}

void Sequencer::close_logs() {
    for (LogFile &log : logs_) {
        log.file.reset();
    }
}

void Sequencer::abort() {
    close_logs();
    queue_.clear();
    wait_ = Wait::NONE;
    changing_index_ = -1;
    selected_index_ = -1;
    isNextMoveWaitingForSpeed_ = false;
    isStepping_ = false;
    isStepDone_ = false;
    hasFailed_ = false;
    io_.abort();
}

bool Sequencer::isIdle() const {
    return queue_.empty() && wait_ == Wait::NONE && motion_.isPathComplete() &&
           io_.action() == io::ToolAction::IDLE;
}

}  // namespace mw::task
