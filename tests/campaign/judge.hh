// SPDX-License-Identifier: GPL-2.0-or-later
// Rules that hold at every servo sample of a machine. The judge reads measurements at pins and plants and the
// actions of the operator. It reads the limits from the files of the machine only.
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
    double motor_fb = 0;       ///< value that the servo cycle read
    double turned = 0;         ///< sum of the changes of the encoder zero by index marks
    int resets = 0;            ///< number of these changes
    double position = 0;       ///< true position of the joint, from the plant
    bool isTruthKnown = true;  ///< false after a fault of the encoder
    double offset = 0;         ///< external offset of its axis, part of the commands
    bool isAmpOn = false, isHomed = false, isHoming = false;
    bool isAmpFaulted = false;
    /// Motor position without the external offset, which HAL pins command and which also moves after a stop.
    double motor_place() const { return motor_cmd + turned - offset; }
};

struct Sample {
    std::uint64_t cycle = 0;
    bool isChainClosed = true, isEnableOn = true;  ///< as the servo cycle has read them
    bool isSpindleOn = false;
    double spindle_rpm = 0;     ///< commanded
    double spindle_turns = 0;   ///< true revolutions
    std::uint32_t outputs = 0;  ///< one bit for each digital output, flood and mist
    bool areAxesKnown = false;  ///< all homed, teleop or coord
    geometry::Pose axes;        ///< commanded, without external offsets
    geometry::Pose offsets;     ///< external offsets, which are added
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
    int delay = 0, since = 0;  ///< cycles
    /// Commanded positions since the stop, with the samples before it that define the initial speed.
    struct Path {
        std::vector<std::vector<double>> motors;  ///< by joint, sample
        std::vector<geometry::Pose> axes;
        bool areAxesKnown = false;
    };
    Path path;
};

/// Actions that a new command of the operator permits until the next stop.
enum class Leave { SWITCH_ON, MOVE, WORK };

/// Actions permitted since the last stop.
struct Allowed {
    bool isSwitchingOn = false, isMotion = false, isWork = false;
};

class Judge {
  public:
    Judge(const Design &design, double period_s);

    void allow(Leave leave);
    /// A stop was requested after the last sample, by a command or a fault. Motion may receive it up to
    /// `delay` cycles later.
    void stop(Stop how, int delay);
    void sample(const Sample &s);
    /// Additional time for stops: a synchronized move stops with the spindle, and a jog wheel may use only a
    /// part of the acceleration.
    double stops_later_s = 0;
    /// Start of a path that reverse run may follow. If it is outside a soft limit, the axis may return there.
    std::optional<Sample> back_to;

    bool isSound() const { return report_.empty(); }
    /// First violation: rule, cycle, figures.
    const std::string &report() const { return report_; }
    /// Rules with known violations: they are counted and do not end the session.
    std::set<std::string> known;
    const std::map<std::string, int> &broken_known() const { return broken_known_; }
    /// Braking time of the slowest joint from its maximum speed [s].
    double time_to_brake() const;
    /// Time for which motion may report a move after the axes have stopped [s]: the jerk filter (2 A / J of a
    /// joint or of the path) has not settled, or external offsets brake separately.
    double time_to_be_sure() const;
    /// Nothing moves and no stop is awaited.
    bool isAtRest() const { return standing_ >= 3 && !stop_.isAwaited; }
    /// The machine is stopped, or will be in the next cycle.
    bool mayBeAtRest() const;
    bool areOffsetsAtRest() const { return offsets_standing_ >= 3; }
    /// Maximum of the duration of a stop divided by the duration that the limits permit.
    double slowest_stop() const { return slowest_stop_; }
    std::uint64_t samples() const { return count_; }
    /// Number of checks of the optional features of a session.
    const std::map<std::string, int> &judged() const { return judged_; }

  private:
    struct JointJudge {
        testing::LimitChecker speed, jerk;
        double reference = 0;  ///< of homing without a switch
        double held = 0;       ///< motor position at standstill
        double travel = 0;     ///< since it was switched on
        double place = 0;      ///< deviation of the slide from its command at the last standstill
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
    int standing_ = 0, offsets_standing_ = 0;  ///< number of cycles at standstill
    int held_cycles_ = 0;                      ///< cycles since motion was forbidden; 0: it is permitted
    int restless_ = 0;  ///< cycles left in which commands from before a stop may arrive
    double slowest_stop_ = 0;
    std::string report_;
    std::map<std::string, int> broken_known_;
    std::map<std::string, int> judged_;
};

}  // namespace mw::campaign
