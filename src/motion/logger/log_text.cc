// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/logger/log_text.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/overloaded.hh"

namespace mw::motion {
namespace {

using Lines = LogText::Lines;

/// LinuxCNC's number for an absent limit.
double finite(double value) {
    constexpr double NO_LIMIT = 1e99;
    return std::isinf(value) ? std::copysign(NO_LIMIT, value) : value;
}

/// 0 for a joint or axis without a limit.
double jerk_word(double jerk) {
    return jerk >= NO_JERK_LIMIT ? 0 : jerk;
}

/// 999 for a joint without a homing sequence.
int sequence_word(double sequence) {
    constexpr int NONE = 1000, TOLD = 999;
    return sequence >= NONE ? TOLD : static_cast<int>(sequence);
}

std::string words_of(const geometry::Pose &p, const char *before_u = ", ") {
    return fmt::format(
        "x={:.6g}, y={:.6g}, z={:.6g}, a={:.6g}, b={:.6g}, c={:.6g}{}u={:.6g}, v={:.6g}, w={:.6g}", p[0],
        p[1], p[2], p[3], p[4], p[5], before_u, p[6], p[7], p[8]);
}

std::string of_target(const char *name, const JogTarget &target) {
    return fmt::format("{} {}={}", name, target.isJoint ? "joint" : "axis", target.index);
}

std::string jog_to(const char *name, const JogTarget &target, double velocity, double offset) {
    return of_target(name, target) + fmt::format(", vel={:.6g}, offset={:.6g}", velocity, offset);
}

Lines abort_lines() {
    Lines lines;
    for (int joint = 0; joint < MAX_JOINTS; ++joint) {
        lines.push_back(fmt::format("JOG_ABORT joint={}", joint));
    }
    lines.emplace_back("ABORT");
    return lines;
}

const char *mode_name(Mode mode) {
    switch (mode) {
    case Mode::FREE: return "FREE";
    case Mode::TELEOP: return "TELEOP";
    case Mode::COORD: break;
    }
    return "COORD";
}

std::string scale_line(const SetScale &scale) {
    switch (scale.what) {
    case Scale::FEED: return fmt::format("FEED_SCALE scale={:f}", scale.factor);
    case Scale::RAPID: return fmt::format("RAPID_SCALE scale={:f}", scale.factor);
    case Scale::SPINDLE: break;
    }
    return fmt::format("SPINDLE_SCALE spindle={}, scale={:f}", scale.spindle, scale.factor);
}

std::string switch_line(const SetSwitch &set) {
    const int mode = set.isEnabled ? 1 : 0;
    switch (set.what) {
    case Switch::FEED_OVERRIDE: return fmt::format("FS_ENABLE mode={}", mode);
    case Switch::SPINDLE_OVERRIDE: return fmt::format("SS_ENABLE spindle={}, mode={}", set.spindle, mode);
    case Switch::ADAPTIVE_FEED: return fmt::format("AF_ENABLE flags={}", mode);
    case Switch::FEED_HOLD: break;
    }
    return fmt::format("FH_ENABLE mode={}", mode);
}

/// Time of a move at the limits of its axes.
double time_over(const geometry::Pose &way, const std::array<double, geometry::AXIS_COUNT> &limits) {
    double longest = 0;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        longest = std::max(longest, std::fabs(way[axis]) / limits[static_cast<std::size_t>(axis)]);
    }
    return longest;
}

/// Length over X Y Z if they move, otherwise over U V W, otherwise over A B C.
double feed_length(const geometry::Pose &way) {
    for (const int first : {geometry::AXIS_X, geometry::AXIS_U, geometry::AXIS_A}) {
        const double length = std::hypot(way[first], way[first + 1], way[first + 2]);
        if (length > 0) {
            return length;
        }
    }
    return 0;
}

}  // namespace

LogText::LogText() {
    for (std::size_t i = 0; i < PARAMETERS.size(); ++i) {
        values_[i].fill(PARAMETERS[i].preset);
    }
}

double LogText::get(Parameter parameter, int index) const {
    return values_[static_cast<std::size_t>(parameter)][static_cast<std::size_t>(index)];
}

void LogText::note(const SetParameter &setting) {
    const auto parameter = static_cast<std::size_t>(setting.parameter);
    const auto index = static_cast<std::size_t>(std::max<int>(setting.index, 0));
    if (parameter >= PARAMETERS.size() || index >= INDEXES) {
        return;
    }
    values_[parameter][index] = setting.value;
    if (PARAMETERS[parameter].scope == ParameterScope::SPINDLE) {
        num_spindles_ = std::max(num_spindles_, static_cast<int>(index) + 1);
    }
    if (PARAMETERS[parameter].scope == ParameterScope::AXIS) {
        axes_ |= 1U << index;
    }
}

Lines LogText::joint_settings(int j) const {
    using enum Parameter;
    const bool areLimitsIgnored = get(JOINT_HOME_IGNORE_LIMITS, j) != 0,
               isIndex = get(JOINT_HOME_USE_INDEX, j) != 0, isShared = get(JOINT_HOME_IS_SHARED, j) != 0;
    const unsigned flags = (areLimitsIgnored ? 1U : 0U) | (isIndex ? 2U : 0U) | (isShared ? 4U : 0U);
    return {
        fmt::format("SET_JOINT_BACKLASH joint={}, backlash={:.6g}", j, get(JOINT_BACKLASH, j)),
        fmt::format("SET_JOINT_POSITION_LIMITS joint={}, min={:.6g}, max={:.6g}", j, get(JOINT_MIN_LIMIT, j),
                    get(JOINT_MAX_LIMIT, j)),
        fmt::format("SET_JOINT_MAX_FERROR joint={}, maxFerror={:.6g}", j, get(JOINT_FERROR, j)),
        fmt::format("SET_JOINT_MIN_FERROR joint={}, minFerror={:.6g}", j, get(JOINT_MIN_FERROR, j)),
        fmt::format("SET_JOINT_HOMING_PARAMS joint={}, offset={:.6g} home={:.6g}, final_vel={:.6g}, "
                    "search_vel={:.6g}, latch_vel={:.6g}, flags=0x{:08x}, sequence={}, volatile={}",
                    j, get(JOINT_HOME_OFFSET, j), get(JOINT_HOME, j), get(JOINT_HOME_FINAL_VEL, j),
                    get(JOINT_HOME_SEARCH_VEL, j), get(JOINT_HOME_LATCH_VEL, j), flags,
                    sequence_word(get(JOINT_HOME_SEQUENCE, j)),
                    static_cast<int>(get(JOINT_VOLATILE_HOME, j))),
        fmt::format("SET_JOINT_VEL_LIMIT joint={}, vel={:.6g}", j, get(JOINT_MAX_VELOCITY, j)),
        fmt::format("SET_JOINT_ACC_LIMIT joint={}, acc={:.6g}", j, get(JOINT_MAX_ACCELERATION, j)),
        fmt::format("SET_JOINT_JERK_LIMIT joint={}, jerk={:.6g}", j, jerk_word(get(JOINT_MAX_JERK, j))),
        fmt::format("JOINT_ACTIVATE joint={}", j),
    };
}

Lines LogText::axis_settings(int a) const {
    using enum Parameter;
    return {
        fmt::format("SET_AXIS_POSITION_LIMITS axis={}, min={:.6g}, max={:.6g}", a, get(AXIS_MIN_LIMIT, a),
                    get(AXIS_MAX_LIMIT, a)),
        fmt::format("SET_AXIS_VEL_LIMIT axis={} vel={:.6g}", a, finite(get(AXIS_MAX_VELOCITY, a))),
        fmt::format("SET_AXIS_ACC_LIMIT axis={}, acc={:.6g}", a, finite(get(AXIS_MAX_ACCELERATION, a))),
        fmt::format("SET_AXIS_LOCKING_JOINT axis={}, locking_joint={}", a,
                    static_cast<int>(get(AXIS_LOCKING_INDEXER_JOINT, a))),
        fmt::format("SET_AXIS_JERK_LIMIT axis={}, jerk={:.6g}", a, jerk_word(get(AXIS_MAX_JERK, a))),
    };
}

Lines LogText::settings(int num_joints) {
    using enum Parameter;
    Lines lines{
        fmt::format("SET_NUM_JOINTS {}", num_joints),
        fmt::format("SET_NUM_SPINDLES {}", num_spindles_),
        fmt::format("SET_VEL_LIMIT vel={:.6g}", finite(get(TRAJ_MAX_VELOCITY))),
        fmt::format("SET_ACC acc={:.6g}", finite(get(TRAJ_MAX_ACCELERATION))),
        fmt::format("SET_JERK jerk={:.6g}", get(TRAJ_MAX_JERK)),
        fmt::format("SET_PLANNER_TYPE planner_type={}", static_cast<int>(get(TRAJ_PLANNER_TYPE))),
        fmt::format("SET_SCURVE_PEAK_SCALE scale={:.6g}", get(TRAJ_CORNER_SCALE)),
        fmt::format("SET_MAX_FEED_OVERRIDE {:.6g}", get(MAX_FEED_SCALE)),
        fmt::format("SETUP_SET_PROBE_ERR_INHIBIT {} {}", static_cast<int>(get(TRAJ_NO_PROBE_JOG_ERROR)),
                    static_cast<int>(get(TRAJ_NO_PROBE_HOME_ERROR))),
    };
    const auto add = [&lines](const Lines &more) { lines.insert(lines.end(), more.begin(), more.end()); };
    for (int j = 0; j < num_joints; ++j) {
        add(joint_settings(j));
    }
    for (int a = 0; a < MAX_AXES; ++a) {
        if ((axes_ >> a & 1U) != 0) {
            add(axis_settings(a));
        }
    }
    for (int n = 0; n < num_spindles_; ++n) {
        add({fmt::format("SET_SPINDLE_PARAMS, {:.2e}, {:.2e}, {:.2e}, {:.2e}",
                         finite(get(SPINDLE_MAX_FORWARD, n)), get(SPINDLE_MIN_FORWARD, n),
                         -finite(get(SPINDLE_MAX_REVERSE, n)), get(SPINDLE_MIN_REVERSE, n))});
    }
    isConfigured_ = true;
    return lines;
}

Lines LogText::of(const Command &command) {
    return std::visit(
        Overloaded{
            [](const Abort &) { return abort_lines(); },
            [](const Enable &) { return Lines{"ENABLE"}; },
            [](const Disable &) { return Lines{"DISABLE"}; },
            [](const SetMode &c) { return Lines{mode_name(c.mode)}; },
            [](const SetAmplifier &c) {
                return Lines{
                    fmt::format("JOINT_{}_AMPLIFIER joint={}", c.isOn ? "ENABLE" : "DISABLE", c.joint)};
            },
            [](const SetJointActive &c) {
                return Lines{
                    fmt::format("JOINT_{} joint={}", c.isActive ? "ACTIVATE" : "DEACTIVATE", c.joint)};
            },
            [this](const SetNumJoints &c) { return settings(c.count); },
            [](const OverrideLimits &c) {
                return Lines{fmt::format("OVERRIDE_LIMITS on={}", c.isOn ? 1 : 0)};
            },
            // Commands that LinuxCNC does not have.
            [](const SetWatchdog &) { return Lines{}; },
            [](const Heartbeat &) { return Lines{}; },
            [](const Pause &) { return Lines{"PAUSE"}; },
            [](const Resume &) { return Lines{"RESUME"}; },
            [](const StepOnce &) { return Lines{"STEP"}; },
            [](const SetReverse &c) { return Lines{c.isReverse ? "REVERSE" : "FORWARD"}; },
            [](const SetScale &c) { return Lines{scale_line(c)}; },
            [](const SetSwitch &c) { return Lines{switch_line(c)}; },
            [](const SetMaxVelocity &c) {
                return Lines{fmt::format("SET_VEL_LIMIT vel={:.6g}", c.velocity)};
            },
            [](const JogContinuous &c) {
                return c.isRenewal
                           ? Lines{}
                           : Lines{of_target("JOG_CONT", c.target) + fmt::format(", vel={:.6g}", c.velocity)};
            },
            [](const JogIncremental &c) {
                return Lines{jog_to("JOG_INCR", c.target, c.velocity, c.distance)};
            },
            [](const JogAbsolute &c) { return Lines{jog_to("JOG_ABS", c.target, c.velocity, c.position)}; },
            [](const JogStop &c) { return Lines{of_target("JOG_ABORT", c.target)}; },
            [](const Home &c) { return Lines{fmt::format("JOINT_HOME joint={}", c.joint)}; },
            [](const Unhome &c) { return Lines{fmt::format("JOINT_UNHOME joint={}", c.joint)}; },
            [](const SetTeleopVector &c) { return Lines{"SET_TELEOP_VECTOR " + words_of(c.velocity)}; },
            [](const SpindleOn &c) {
                return Lines{fmt::format("SPINDLE_ON speed={:f}, css_factor={:f}, xoffset={:f}", c.speed_rpm,
                                         c.css_factor, c.css_x_offset)};
            },
            [](const SpindleOff &) { return Lines{"SPINDLE_OFF"}; },
            [](const SpindleOrient &c) {
                return Lines{fmt::format("SPINDLE_ORIENT orientation={:f}, mode={}", c.angle_deg, c.mode)};
            },
            [](const SpindleBrake &c) {
                return Lines{c.isOn ? "SPINDLE_BRAKE_ENGAGE" : "SPINDLE_BRAKE_RELEASE"};
            },
            [](const SetDigitalOutput &c) {
                return Lines{fmt::format("SET_DOUT index={}, value={}, now=1", c.index, c.isOn ? 1 : 0)};
            },
            [](const SetAnalogOutput &c) {
                return Lines{fmt::format("SET_AOUT index={}, value={:f}, now=1", c.index, c.value)};
            },
            [](const ClearProbeFlag &) { return Lines{"CLEAR_PROBE_FLAGS"}; },
            [this](const SetParameter &c) {
                note(c);
                const bool isKnown = isConfigured_ && c.parameter < PARAMETERS.size();
                return isKnown ? Lines{fmt::format("SET_{} index={}, value={:.6g}",
                                                   PARAMETERS[c.parameter].name, c.index, c.value)}
                               : Lines{};
            },
            [](const SetToolOffset &c) { return Lines{"SET_OFFSET " + words_of(c.offset, " ")}; },
            [](const LoadCompensation &c) {
                return Lines{
                    fmt::format("SET_JOINT_COMP joint={}, nominal={:.6g}, forward={:.6g}, reverse={:.6g}",
                                c.joint, c.nominal, c.forward, c.reverse)};
            },
        },
        command.body);
}

std::string LogText::move_words(const geometry::Pose &end, const MoveTerms &terms, MotionType type) const {
    std::array<double, geometry::AXIS_COUNT> speeds{}, accelerations{};
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        speeds[i] = get(Parameter::AXIS_MAX_VELOCITY, axis);
        accelerations[i] = get(Parameter::AXIS_MAX_ACCELERATION, axis);
    }
    const geometry::Pose way = end - position_;
    const double length = feed_length(way);
    const double time = time_over(way, speeds), steep = time_over(way, accelerations);
    const double fastest = time > 0 ? length / time : finite(get(Parameter::TRAJ_MAX_VELOCITY));
    const double acceleration = steep > 0 ? length / steep : finite(get(Parameter::TRAJ_MAX_ACCELERATION));
    const double speed = terms.isRapid || terms.feed <= 0 ? fastest : terms.feed;
    return fmt::format("{}, id={}, motion_type={}, vel={:.6g}, ini_maxvel={:.6g}, acc={:.6g}", words_of(end),
                       terms.source.line, static_cast<int>(type), speed, fastest, acceleration);
}

/// Synchronization with a spindle is a part of each move in Millwright, and a separate command in the log.
Lines LogText::with_synch(const MoveTerms &terms, std::string line) {
    Lines lines;
    if (terms.feed_per_revolution != synch_feed_) {
        synch_feed_ = terms.feed_per_revolution;
        lines.push_back(fmt::format("SET_SPINDLESYNC sync={:f}, flags=0x{:08x}", synch_feed_,
                                    terms.velocity_synched ? 1U : 0U));
    }
    lines.push_back(std::move(line));
    return lines;
}

Lines LogText::of(const PathCommand &command) {
    const auto move = [this](const char *name, const auto &body, MotionType type, const std::string &more) {
        Lines lines = with_synch(body.terms,
                                 fmt::format("{} {}{}", name, move_words(body.end, body.terms, type), more));
        position_ = body.end;
        return lines;
    };
    return std::visit(
        Overloaded{
            [&](const Line &c) {
                const MotionType type = c.terms.isRapid ? MotionType::TRAVERSE : MotionType::FEED;
                return move("SET_LINE", c, type, ", turn=-1");
            },
            [&](const Arc &c) {
                const std::string circle = fmt::format(
                    ", cx={:.6g}, cy={:.6g}, cz={:.6g}, nx={:.6g}, ny={:.6g}, nz={:.6g}, angle={:.6g}",
                    c.centre[0], c.centre[1], c.centre[2], c.normal[0], c.normal[1], c.normal[2],
                    c.angle_rad);
                return move("SET_CIRCLE", c, MotionType::ARC, circle);
            },
            [&](const Probe &c) { return move("PROBE", c, MotionType::PROBING, ""); },
            [](const RigidTap &c) {
                return Lines{fmt::format("RIGID_TAP {}, id={}, scale={:.6g}", words_of(c.end),
                                         c.terms.source.line, c.pitch_scale)};
            },
            [](const SynchedDigitalOutput &c) {
                return Lines{fmt::format("SET_DOUT index={}, value={}, now=0", c.index, c.isOn ? 1 : 0)};
            },
            [](const SynchedAnalogOutput &c) {
                return Lines{fmt::format("SET_AOUT index={}, value={:f}, now=0", c.index, c.value)};
            },
            [](const Flush &) { return Lines{}; },
        },
        command.body);
}

}  // namespace mw::motion
