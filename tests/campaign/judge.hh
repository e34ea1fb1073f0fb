// SPDX-License-Identifier: GPL-2.0-or-later
// What must hold at every servo sample of a machine, whatever happens. Fed with what can be measured at its
// pins and plants and with what its operator does; knows the limits from the machine's files only.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/geometry/pose.hh"
#include "campaign/design.hh"
#include "campaign/stop_bound.hh"
#include "tests/support/limit_checker.hh"

namespace mw::campaign {

struct JointSample {
    double pos_cmd = 0, pos_fb = 0, motor_cmd = 0;
    double motor_fb = 0;       ///< as the servo cycle has read it
    double turned = 0;         ///< by how much index marks have moved the encoder's zero so far
    int resets = 0;            ///< how often they have set it
    double position = 0;       ///< of the joint in truth, by the plant
    bool isTruthKnown = true;  ///< false once the encoder has lied
    double offset = 0;         ///< external, of its axis; part of the commands
    bool isAmpOn = false, isHomed = false, isHoming = false;
    bool isAmpFaulted = false;
    /// Of the motor, without the external offset: that has been asked for by HAL pins and goes on as long as
    /// it is.
    double motor_place() const { return motor_cmd + turned - offset; }
};

struct Sample {
    std::uint64_t cycle = 0;
    bool isChainClosed = true, isEnableOn = true;  ///< as the servo cycle has read them
    bool isPlannerAway = false;                    ///< it has no chance to answer
    bool isSpindleOn = false;
    double spindle_rpm = 0;     ///< commanded
    double spindle_turns = 0;   ///< in truth
    std::uint32_t outputs = 0;  ///< bit per output that can do work: digital outputs, flood, mist
    bool areAxesKnown = false;  ///< all homed, teleop or coord
    geometry::Pose axes;        ///< commanded, without external offsets
    geometry::Pose offsets;     ///< external ones, which come on top
    std::vector<JointSample> joints;
};

/// How a machine is stopped.
enum class Stop {
    ALONG_THE_PATH,  ///< within the limits; it stays on
    ALONG_THEN_OFF,  ///< within the limits, then the amplifiers go off
    AT_ONCE,         ///< the amplifiers go off in the next sample
};

struct AwaitedStop {
    bool isAwaited = false;
    Stop how = Stop::ALONG_THE_PATH;
    int delay = 0, since = 0;     ///< cycles
    bool wasPlannerAway = false;  ///< at some time since
    /// Commanded since, with the samples that tell the speed as it began.
    struct Path {
        std::vector<std::vector<double>> motors;  ///< by joint, sample
        std::vector<geometry::Pose> axes;
        bool areAxesKnown = false;
    };
    Path path;
};

/// What an operator's fresh command allows until the next stop.
enum class Leave { SWITCH_ON, MOVE, WORK };

/// Since the last stop.
struct Allowed {
    bool isSwitchingOn = false, isMotion = false, isWork = false;
};

class Judge {
  public:
    Judge(const Design &design, double period_s);

    void allow(Leave leave);
    /// A stop has been asked for, or something that must stop the machine has happened, after the last
    /// sample; it may take `delay` cycles until motion hears of it.
    void stop(Stop how, int delay);
    void sample(const Sample &s);
    /// Stops may take so much longer: what is in step with a spindle stands when that does, and wheels may
    /// have a part of the acceleration only.
    double stops_later_s = 0;
    /// Where a path began that may be gone back along: who came from beyond a soft limit may get there again.
    std::optional<Sample> back_to;

    bool isSound() const { return report_.empty(); }
    /// What was broken first: rule, cycle, figures.
    const std::string &report() const { return report_; }
    /// Rules that are known to be broken: they are counted, and end nothing.
    std::set<std::string> known;
    const std::map<std::string, int> &broken_known() const { return broken_known_; }
    /// What the slowest joint needs from its highest speed [s].
    double time_to_brake() const;
    /// The mean that keeps the jerk, 2 A / J of a joint or that of the path, may stand before it is sure of
    /// it, and offsets brake on their own: for so long motion may say that it moves, though it stands [s].
    double time_to_be_sure() const;
    /// Nothing moves and no stop is awaited.
    bool isAtRest() const { return standing_ >= 3 && !stop_.isAwaited; }
    /// It stands, or does in the next cycle.
    bool mayBeAtRest() const;
    bool areOffsetsAtRest() const { return offsets_standing_ >= 3; }
    /// The time that stops took over what the limits need, the largest.
    double slowest_stop() const { return slowest_stop_; }
    std::uint64_t samples() const { return count_; }
    /// What has been judged that not every session has, and how often.
    const std::map<std::string, int> &judged() const { return judged_; }

  private:
    struct JointJudge {
        testing::LimitChecker speed, jerk;
        double reference = 0;  ///< of homing without a switch
        double held = 0;       ///< where the motor was at rest
        double travel = 0;     ///< since it was switched on
        double place = 0;      ///< of the slide, off its command, when it stood before
        bool wasHomed = false, isUnjerked = false, isPlaceKnown = false;
    };
    void check_numbers(const Sample &s);
    void check_amplifiers(const Sample &s);
    void check_limits(const Sample &s);
    void check_room(const Sample &s);
    void check_homes(const Sample &s);
    void check_places(const Sample &s);
    void check_outputs(const Sample &s);
    void check_rest(const Sample &s);
    void check_stale(const Sample &s, bool wasAtRest);
    void take_for_stop(const Sample &s);
    void begin_stop();
    void watch_stop(bool isMoving, bool isOn);
    void check_stop(bool isMoving, double took_s);
    LeastStop time_to_stop() const;
    double time_of_jerk() const;
    double time_to_correct() const;
    double build_up_s() const;
    double built_up(bool isAngular, double acceleration, double jerk) const;
    void fail(const std::string &rule, const std::string &text);

    const Design &design_;
    double period_;
    std::vector<JointJudge> joints_;
    Sample last_;
    std::vector<double> velocity_, before_;
    std::uint64_t count_ = 0;
    Allowed allowed_;
    AwaitedStop stop_;
    double build_up_s_ = 0;
    int standing_ = 0, offsets_standing_ = 0;  ///< for so many cycles
    int held_cycles_ = 0;                      ///< since nothing may move; 0: it may
    int restless_ = 0;  ///< cycles left in which commands of before a stop may still arrive
    double slowest_stop_ = 0;
    std::string report_;
    std::map<std::string, int> broken_known_;
    std::map<std::string, int> judged_;
};

}  // namespace mw::campaign
