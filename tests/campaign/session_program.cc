// SPDX-License-Identifier: GPL-2.0-or-later
// Programs of a session, and the faults that occur while they run.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "campaign/session.hh"
#include "gcode/analysis/time_estimate.hh"
#include "machine/config/program_analysis.hh"
#include "tests/support/deviation.hh"

namespace mw::campaign {
namespace {

constexpr double PERIOD_S = 1e-3;
constexpr int WATCHDOG_MS = 500;

geometry::Pose on_arc(const geometry::Pose &from, const Block &b, double share) {
    const double x = from[0] - b.centre[0];
    const double y = from[1] - b.centre[1];
    const double last = std::hypot(b.end[0] - b.centre[0], b.end[1] - b.centre[1]);
    const double r = std::hypot(x, y) + share * (last - std::hypot(x, y));
    const double angle = std::atan2(y, x) + share * b.angle_rad;
    geometry::Pose p = from + (b.end - from) * share;
    p[0] = b.centre[0] + r * std::cos(angle);
    p[1] = b.centre[1] + r * std::sin(angle);
    return p;
}

/// The programmed path, cut into steps of at most `step`.
std::vector<geometry::Pose> programmed_path(const Act &act, const geometry::Pose &from, double step) {
    std::vector<geometry::Pose> path{from};
    for (const Block &b : act.blocks) {
        if (!b.isMove) {
            continue;
        }
        const geometry::Pose start = path.back();
        double length = testing::pose_distance(b.end, start);
        if (b.isArc) {
            length += std::abs(b.angle_rad) * std::hypot(start[0] - b.centre[0], start[1] - b.centre[1]);
        }
        const int n = 1 + static_cast<int>(length / step);
        for (int i = 1; i < n; ++i) {
            const double share = static_cast<double>(i) / n;
            path.push_back(b.isArc ? on_arc(start, b, share) : start + (b.end - start) * share);
        }
        path.push_back(b.end);
    }
    return path;
}

const AxisDesign &offset_axis(const Design &design, const Trouble &t) {
    return design.axes[static_cast<std::size_t>(t.joint) % design.axes.size()];
}

/// The requested value of the offset.
double offset_of(const Trouble &t) {
    constexpr double MOST = 8;
    return MOST * (2 * t.value - 1);
}

/// A move that is read while the offset is active may be rejected, because their sum is outside a soft limit.
bool isRoomShort(const Design &design, const Act &act, const geometry::Pose &from) {
    constexpr double STEP = 0.5, SLACK = 0.1;
    const std::vector<geometry::Pose> path = programmed_path(act, from, STEP);
    return std::ranges::any_of(act.troubles, [&](const Trouble &t) {
        const AxisDesign &axis = offset_axis(design, t);
        return t.what == Upset::OFFSET && axis.offset_ratio > 0 &&
               std::ranges::any_of(path, [&](const geometry::Pose &p) {
                   const double place = p[axis.axis] + offset_of(t);
                   return place > axis.high - SLACK || place < axis.low + SLACK;
               });
    });
}

}  // namespace

void Session::run_program(const Act &act) {
    const std::string file = (folder_ / fmt::format("p{}.ngc", verdict_.programs)).string();
    std::ofstream out(file);
    for (const Block &b : act.blocks) {
        out << b.text << '\n';
    }
    out.close();
    if (!set_mode(messages::Mode::AUTO) || ask(messages::OpenProgram{file}) != End::DONE) {
        fail("work", "the program is not opened with the machine at rest");
        return;
    }
    settle(LONGEST_CALM_S);
    const geometry::Pose from = rig_->sample().axes;
    path_.clear();
    path_.push_back(from);
    led_.clear();
    led_s_ = 0;
    turns_.assign(1, rig_->sample().spindle_turns);
    rpm_.assign(1, rig_->sample().spindle_rpm);
    told_.clear();
    beyond_walls_.clear();
    rig_->set_contacts(act.contacts);
    if (act.sync.kind == Sync::TAP) {
        constexpr double LAGS = 7, SLACK_S = 0.05;
        const plants::SpindleTraits &spindle = plan_.design.spindle;
        judge_.stops_later_s = 2 * std::abs(act.sync.rpm) / 60 / spindle.ramp + LAGS * spindle.lag_s +
                               spindle.reaction_s + SLACK_S;
    }
    if (hasTrouble(act, Upset::ADAPTIVE)) {
        judge_.back_to = rig_->sample();
    }
    if (plan_.design.isJerkLimited && hasTrouble(act, Upset::ADAPTIVE)) {
        // If the path may be reversed, changes of the rate use a third of the jerk.
        judge_.stops_later_s += judge_.time_to_brake();
    }
    isRecording_ = true;
    begin_troubles(act);
    judge_.allow(Leave::WORK);
    ++verdict_.programs;
    const std::uint64_t begin = rig_->sample().cycle;
    const End end = wait(post(messages::RunProgram{}), 300);
    const double took_s = static_cast<double>(rig_->sample().cycle - begin) * PERIOD_S;
    isRecording_ = false;
    if (isOver()) {
        return;
    }
    const bool mayMiss = isProbeMoved(act);
    const bool mayFail = act.isToFail || act.mayFail || mayMiss || isRoomShort(plan_.design, act, from);
    if (end == End::LATE) {
        fail("work", "the program does not end");
    } else if (end != End::DONE && !isStopped_ && !mayFail) {
        fail("work", "the program ends badly with nothing wrong");
    } else if (end == End::DONE && !isStopped_ && act.isToFail && !mayMiss) {
        fail("work", "the program must fail, and ends");
    } else if (act.work == Work::PROBE) {
        check_probing(act, end);
    } else if (act.work == Work::SPINDLE) {
        check_sync(act, end);
    } else if (end == End::DONE) {
        ++verdict_.ended;
        check_program(act, from, took_s - led_s_);
    }
}

/// The path has reached its end, has passed all points in order within the tolerance, and was not slow.
void Session::check_program(const Act &act, const geometry::Pose &from, double took_s) {
    double tolerance = 1e-3;
    geometry::Pose last = from;
    for (const Block &b : act.blocks) {
        tolerance = std::max(tolerance, b.isMove ? b.settings.tolerance : 0.0);
        last = b.isMove ? b.end : last;
    }
    const geometry::Pose &at = rig_->sample().axes;
    if (testing::pose_distance(at, last) > (plan_.design.isTrivial ? 1e-9 : 1e-6)) {
        fail("work", fmt::format("the program ends {:.3g} from its end", testing::pose_distance(at, last)));
        return;
    }
    if (isReversed_) {
        return;  // it has moved back and forth, so it is not checked
    }
    double longest = 0;
    double length = 0;
    for (std::size_t i = 1; i < path_.size(); ++i) {
        const double step = testing::pose_distance(path_[i], path_[i - 1]);
        longest = std::max(longest, step);
        length += step;
    }
    constexpr double SHARE = 0.2, MOST_POINTS = 100000;
    const double cut = std::max(SHARE * tolerance, length / MOST_POINTS);
    // Between two samples a curve deviates from their chord by less than a quarter of the chord.
    const double allowed = tolerance + 0.5 * cut + 0.02 * longest + 1e-4;
    if (!testing::isWithinInOrder(testing::refined(path_, cut), programmed_path(act, from, cut), allowed)) {
        fail("path", fmt::format("more than {:.4g} beside the program, or out of order", allowed));
        return;
    }
    const bool isTimed = !isDisturbed_ && !isStopped_ && plan_.design.isTrivial && act.isTimed;
    if (isTimed) {
        ++verdict_.timed;
        const double expected = estimate(act, from);
        const double off = took_s / expected - 1;
        // Commands, ends of outputs and the start of the planner need cycles that the estimate does not
        // include.
        constexpr double PART = 0.01;
        constexpr double SLACK_S = 0.1;
        verdict_.worst_time = std::max(verdict_.worst_time, std::abs(took_s - expected) - PART * expected);
        if (std::abs(took_s - expected) > PART * expected + SLACK_S) {
            fail("time", fmt::format("{:.3f} s where {:.3f} s are estimated, {:+.1f} %", took_s, expected,
                                     100 * off));
        }
    }
}

double Session::estimate(const Act &act, const geometry::Pose &from) const {
    gcode::TimeEstimate time(machine::timed_machine(rig_->config()));
    time.start(from);
    bool isCutWaiting = false;
    for (const Block &b : act.blocks) {
        const bool isStart = b.text.starts_with("M3");
        const bool isCut = b.isMove && !b.settings.isRapid;
        if (isCut && isCutWaiting) {
            // The first move waits for the spindle, so it starts at rest.
            time.stop();
        }
        isCutWaiting = (isCutWaiting || isStart) && !isCut;
        if (b.isArc) {
            gcode::ArcMove arc;
            arc.end = b.end;
            arc.centre = b.centre;
            arc.normal[geometry::AXIS_Z] = 1;
            arc.angle_rad = b.angle_rad;
            arc.settings = b.settings;
            time.arc(arc);
        } else if (b.isMove) {
            time.line(b.end, b.settings);
        } else if (b.dwell_s > 0) {
            time.dwell(b.dwell_s);
        } else if (!b.isTimed || isStart) {
            time.stop();
        }
    }
    return time.finish().total_s;
}

void Session::begin_troubles(const Act &act) {
    act_ = &act;
    began_ = rig_->sample().cycle;
    next_trouble_ = 0;
}

void Session::step_troubles() {
    if (act_ == nullptr || isOver()) {
        return;
    }
    const std::uint64_t now = rig_->sample().cycle;
    while (next_trouble_ < act_->troubles.size() &&
           now >= began_ + static_cast<std::uint64_t>(act_->troubles[next_trouble_].at_ms)) {
        const Trouble &t = act_->troubles[next_trouble_++];
        if (tell_ != nullptr) {
            std::fprintf(tell_, "  [%.3f] %s, joint %d, %.3g, %d ms\n", static_cast<double>(now) * PERIOD_S,
                         name_of(t.what), t.joint, t.value, t.length_ms);
        }
        isDisturbed_ = true;
        going_.push_back({t, now + static_cast<std::uint64_t>(t.length_ms)});
        isPassing(t.what) ? begin(t) : begin_stop(t);
    }
    for (std::size_t i = 0; i < going_.size();) {
        if (now >= going_[i].until) {
            end(going_[i].trouble);
            going_.erase(going_.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
            ++i;
        }
    }
}

void Session::begin_stop(const Trouble &t) {
    constexpr int TO_TASK = 4;  // time to task, and from task to motion [cycles]
    const JointDesign &joint = plan_.design.joints[static_cast<std::size_t>(t.joint)];
    JointFaults &pins = rig_->joint_faults[static_cast<std::size_t>(t.joint)];
    Extension &count = verdict_.extensions[fmt::format("stop by {}", name_of(t.what))];
    ++count.ran;
    count.judged += judge_.isAtRest() ? 0 : 1;
    switch (t.what) {
    case Upset::ABORT:
        post(messages::AbortAll{});
        judge_.stop(Stop::ALONG_THE_PATH, TO_TASK);
        break;
    case Upset::OFF:
        post(messages::SetState{messages::State::OFF});
        judge_.stop(Stop::AT_ONCE, TO_TASK);
        break;
    case Upset::ESTOP_COMMAND:
        post(messages::SetState{messages::State::ESTOP});
        judge_.stop(Stop::AT_ONCE, TO_TASK);
        break;
    case Upset::ESTOP:
        rig_->faults.isChainOpen = true;
        judge_.stop(Stop::AT_ONCE, 0);
        break;
    case Upset::ENABLE:
        rig_->faults.isDisabled = true;
        judge_.stop(Stop::AT_ONCE, 0);
        break;
    case Upset::AMP_FAULT:
        rig_->trip_amplifier(t.joint);
        judge_.stop(Stop::AT_ONCE, 0);
        break;
    case Upset::LIMIT_SWITCH:
        pins.isOnLimit = true;
        judge_.stop(Stop::ALONG_THEN_OFF, 0);
        break;
    case Upset::ENCODER_LOST:
        rig_->lose_encoder(t.joint, true);
        areEncodersTrue_ = false;
        break;
    case Upset::ENCODER_JUMP:
        rig_->jump_encoder(t.joint, (2 * t.value - 1) * 3 * joint.ferror);
        areEncodersTrue_ = false;
        break;
    case Upset::ENCODER_NAN:
        pins.isEncoderNan = true;
        judge_.stop(Stop::AT_ONCE, 0);
        break;
    case Upset::SPINDLE_FAULT:
        rig_->faults.isSpindleFaulted = true;
        judge_.stop(Stop::ALONG_THEN_OFF, 0);
        break;
    case Upset::PROBE_STUCK:
        if (!judge_.mayBeAtRest() && act_->work == Work::PROGRAM) {
            rig_->faults.isProbeClosed = true;
            judge_.stop(Stop::ALONG_THE_PATH, 0);
            if (rig_->sample().cycle < commanded_ + TO_TASK) {  // task may process these after the stop
                judge_.allow(Leave::WORK);
            }
        }
        break;
    case Upset::TASK_HUNG:
        rig_->faults.isTaskHeld = true;
        judge_.stop(Stop::ALONG_THEN_OFF, WATCHDOG_MS + 2);
        break;
    default:
        rig_->faults.isTaskDead = true;
        judge_.stop(Stop::ALONG_THEN_OFF, 0);
        break;
    }
    isStopped_ = true;
    ++verdict_.stops;
    if (rig_->faults.isTaskDead) {
        settle(20);
        isTaskGone_ = true;
    }
}

void Session::begin_offset(const Trouble &t) {
    const AxisDesign &axis = offset_axis(plan_.design, t);
    if (axis.offset_ratio > 0 && !isStopped_) {
        judge_.allow(Leave::MOVE);
        rig_->add_offset(axis.axis, offset_of(t));
    }
}

void Session::begin(const Trouble &t) {
    switch (t.what) {
    case Upset::PAUSE: post(messages::PauseProgram{}); break;
    case Upset::SPINDLE_NAN: rig_->faults.isSpindleNan = true; break;
    case Upset::FEED_OVERRIDE: post(messages::SetFeedOverride{t.value < 0.1 ? 0 : 1.5 * t.value}); break;
    case Upset::RAPID_OVERRIDE: post(messages::SetRapidOverride{t.value}); break;
    case Upset::FEED_INHIBIT: rig_->faults.isFeedInhibited = true; break;
    case Upset::ADAPTIVE_NAN: rig_->faults.isAdaptiveNan = true; break;
    case Upset::OFFSET: begin_offset(t); break;
    case Upset::ADAPTIVE:
        rig_->faults.adaptive_feed = 2 * t.value - 1;
        isReversed_ = isReversed_ || t.value < 0.5;
        break;
    case Upset::SPINDLE_OVERRIDE: post(messages::SetSpindleOverride{0.5 + t.value, 0}); break;
    case Upset::PLANNER_LATE:
    case Upset::PLANNER_LOST: rig_->hold_planner(true); break;
    default:
        if (act_->work == Work::PROGRAM && !isStopped_) {
            // Commands that arrive when the program has just ended are treated as other commands.
            judge_.allow(Leave::WORK);
            commanded_ = rig_->sample().cycle;
            post(messages::SetMode{messages::Mode::MANUAL});
            post(messages::JogIncrement{false, 0, 5, 5});
            post(messages::JogContinuous{true, t.joint, 5, 0, false});
            post(messages::HomeJoint{-1});
            post(messages::RunProgram{});
            post(messages::Mdi{"G0 X1"});
        }
        break;
    }
}

void Session::end(const Trouble &t) {
    JointFaults &pins = rig_->joint_faults[static_cast<std::size_t>(t.joint)];
    switch (t.what) {
    case Upset::PAUSE: post(messages::ResumeProgram{}); break;
    case Upset::SPINDLE_NAN: rig_->faults.isSpindleNan = false; break;
    case Upset::FEED_OVERRIDE: post(messages::SetFeedOverride{1}); break;
    case Upset::RAPID_OVERRIDE: post(messages::SetRapidOverride{1}); break;
    case Upset::FEED_INHIBIT: rig_->faults.isFeedInhibited = false; break;
    case Upset::ADAPTIVE_NAN: rig_->faults.isAdaptiveNan = false; break;
    case Upset::ADAPTIVE: rig_->faults.adaptive_feed = 1; break;
    case Upset::SPINDLE_OVERRIDE: post(messages::SetSpindleOverride{1, 0}); break;
    case Upset::OFFSET: rig_->clear_offsets(t.value < 0.2); break;
    case Upset::PLANNER_LATE:
    case Upset::PLANNER_LOST: rig_->hold_planner(false); break;
    case Upset::ESTOP: rig_->faults.isChainOpen = false; break;
    case Upset::ENABLE: rig_->faults.isDisabled = false; break;
    case Upset::LIMIT_SWITCH: pins.isOnLimit = false; break;
    case Upset::ENCODER_LOST: rig_->lose_encoder(t.joint, false); break;
    case Upset::ENCODER_NAN: pins.isEncoderNan = false; break;
    case Upset::SPINDLE_FAULT: rig_->faults.isSpindleFaulted = false; break;
    case Upset::PROBE_STUCK: rig_->faults.isProbeClosed = false; break;
    case Upset::TASK_HUNG: rig_->faults.isTaskHeld = false; break;
    default: break;
    }
}

}  // namespace mw::campaign
