// SPDX-License-Identifier: GPL-2.0-or-later
// The motion controller: takes commands, closes nothing itself, and says every servo cycle where each joint
// shall be. Pure: no HAL, no clock, no allocation. Everything here runs in the servo thread.
#pragma once

#include <array>
#include <cstdint>

#include "homing/homing.hh"
#include "kins/kinematics.hh"
#include "motion/api/channels.hh"
#include "motion/api/limits.hh"
#include "motion/api/settings.hh"
#include "motion/core/io.hh"
#include "motion/core/path_link.hh"
#include "traj/exec/executor.hh"
#include "traj/exec/free_planner.hh"

namespace mw::motion {

struct ControllerConfig {
    int num_joints = 3;
    int num_spindles = 1;
    int num_dio = 4;
    int num_aio = 4;
    double period_s = 1e-3;
};

class Controller {
  public:
    Controller(const ControllerConfig &config, const kins::Kinematics &kinematics, Channels &channels,
               PathLink &link) noexcept;

    /// Takes up to MAX_COMMANDS_PER_CYCLE immediate commands and answers each (function
    /// motion-command-handler).
    void handle_commands(const Inputs &in) noexcept;
    /// One servo cycle (function motion-controller).
    void step(const Inputs &in, Outputs &out) noexcept;

    static constexpr int MAX_COMMANDS_PER_CYCLE = 64;

  private:
    using MoveTag = traj::MoveTag;
    /// What a joint or axis jog is driven by.
    enum class JogSource : std::uint8_t { NONE, KEYBOARD, WHEEL };

    struct JointState {
        bool isActive = true;
        bool isAmpWanted = false;  ///< amplifier enable while the machine is on
        bool isFaulted = false, isFerrorTripped = false;
        bool isOnPosHardLimit = false, isOnNegHardLimit = false;
        double pos_cmd = 0, pos_fb = 0, vel_cmd = 0, acc_cmd = 0;
        double coarse_pos = 0;
        double motor_pos_cmd = 0, motor_pos_fb = 0, motor_offset = 0;
        double ferror = 0, ferror_limit = 0, ferror_highmark = 0;
        double backlash_raw = 0, backlash_extreme = 0;
        int backlash_side = 0;       ///< +1 or -1 once the joint has moved
        traj::FreePlanner backlash;  ///< filtered backlash compensation
        traj::JogPlanner free;
        double wanted_velocity = 0;  ///< of the jog or homing move, before the override
        JogSource jog = JogSource::NONE;
        std::int32_t wheel_counts = 0;
    };
    struct AxisState {
        traj::JogPlanner teleop;
        double wanted_velocity = 0, wanted_acceleration = 0;  ///< of the jog, before joints limit it
        JogSource jog = JogSource::NONE;
        std::int32_t wheel_counts = 0;
    };
    struct SpindleState {
        double speed_rpm = 0, css_factor = 0, css_max_rpm = 0, css_x_offset = 0;
        double scale = 1;
        double out_rpm = 0;
        bool isOn = false, isOverrideEnabled = true, isBrakeOn = false;
        bool isWaitingForSpeed = false;
        bool isOrienting = false, isLocked = false;
        double orient_angle = 0;
        int orient_mode = 0, orient_state = 0, orient_fault = 0;
    };
    enum class Stop : std::uint8_t { NONE, CATEGORY_1 };

    // --- controller_commands.cc
    Reason handle(const Inputs &in, const Command &c, std::int16_t &index) noexcept;
    Reason handle_state(const Inputs &in, const CommandBody &body, std::int16_t &index,
                        bool &isTaken) noexcept;
    Reason handle_flow(const CommandBody &body, bool &isTaken) noexcept;
    Reason handle_spindle(const CommandBody &body, bool &isTaken) noexcept;
    Reason handle_outputs(const CommandBody &body, bool &isTaken) noexcept;
    Reason enable(const Inputs &in, std::int16_t &index) noexcept;
    Reason set_mode(Mode mode) noexcept;
    Reason set_scale(const SetScale &c) noexcept;
    Reason set_switch(const SetSwitch &c) noexcept;
    Reason set_parameter(const SetParameter &c, std::int16_t &index) noexcept;
    void abort_all() noexcept;
    void disable() noexcept;
    void publish_limits() noexcept;
    void answer(CommandId id, AnswerKind kind, Reason reason, std::int16_t index) noexcept;

    // --- controller_jog.cc
    Reason handle_jog(const Inputs &in, const CommandBody &body, std::int16_t &index, bool &isTaken) noexcept;
    Reason handle_homing(const Inputs &in, const CommandBody &body, std::int16_t &index,
                         bool &isTaken) noexcept;
    Reason jog_vector(const Inputs &in, const geom::Pose &velocity, std::int16_t &index) noexcept;
    Reason check_jog(const Inputs &in, const JogTarget &target, double direction) const noexcept;
    Reason jog_to(const JogTarget &target, double position, double velocity, JogSource source) noexcept;
    JogRange range_of(const JogTarget &target) const noexcept;
    Reason home(const Inputs &in, int joint) noexcept;
    /// Or about to begin, once the jogs that it has stopped are at rest.
    bool isHomingUnderWay() const noexcept { return homing_.isActive() || isHomeDue_; }
    /// The feed override acts on jogs and homing as well.
    double jog_scale() const noexcept { return isFeedOverrideEnabled_ ? feed_scale_ : 1.0; }
    Reason unhome(int joint) noexcept;
    void step_wheel(const Inputs &in, const JogTarget &target, const WheelInput &wheel,
                    std::int32_t &counts) noexcept;
    void step_wheels(const Inputs &in) noexcept;
    void stop_jogs(bool isAtOnce) noexcept;
    traj::JogPlanner &planner_of(const JogTarget &target) noexcept;
    JogSource &source_of(const JogTarget &target) noexcept;
    /// Negative adaptive feed or reverse run is asked for, or the path is not yet back where it was left.
    bool isReversing() const noexcept { return isReverseWanted_ || link_.retrace.isAway(); }
    geom::Pose step_retrace(const geom::Pose &pose) noexcept;
    void follow_dropped_path() noexcept;
    traj::Retrace::Use use_of(const geom::Pose &pose) noexcept;

    // --- controller_teleop.cc: jogs of axes where joints are not axes
    struct TeleopLoad;
    void limit_teleop() noexcept;
    bool add_load(const geom::Pose &pose, TeleopLoad &load) const noexcept;
    void apply_load(const TeleopLoad &load) noexcept;
    int joint_left_by(const geom::Pose &pose) const noexcept;
    void check_joint_steps() noexcept;

    // --- controller_joints.cc
    void read_feedback(const Inputs &in) noexcept;
    void check_faults(const Inputs &in) noexcept;
    void check_joint(const Inputs &in, int joint) noexcept;
    void check_watchdog() noexcept;
    std::uint32_t homed_mask() const noexcept;
    void step_homing(const Inputs &in) noexcept;
    void drive_homing(const Inputs &in) noexcept;
    void move_joints() noexcept;
    void move_by_pose(const geom::Pose &pose) noexcept;
    void output_joints() noexcept;
    void stop_category_1(FaultKind kind, int index, double value) noexcept;
    void stop_category_0(FaultKind kind, int index, double value) noexcept;
    void raise(FaultKind kind, int index, double value, std::uint16_t detail = 0) noexcept;

    // --- controller_coord.cc
    void step_coord(const Inputs &in) noexcept;
    void step_holds(const Inputs &in) noexcept;
    void check_probe(const Inputs &in) noexcept;
    void fire_events() noexcept;
    void publish_view(const Inputs &in) noexcept;
    bool isSpindleReady(const Inputs &in, int spindle) const noexcept;

    // --- controller_status.cc
    void step_spindles(const Inputs &in) noexcept;
    void fill(const Inputs &in, Outputs &out) noexcept;
    void fill_motion(Status &s) const noexcept;
    void fill_joints(Status &s, Outputs &out) const noexcept;
    void fill_axes(Outputs &out) const noexcept;
    void fill_spindles(const Inputs &in, Outputs &out) const noexcept;
    void trace(const Inputs &in, const Status &s) noexcept;

    static std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
    JointState &joint(int j) noexcept { return joints_[at(j)]; }
    const JointState &joint(int j) const noexcept { return joints_[at(j)]; }
    double get(Parameter p, int index = 0) const noexcept { return settings_.get(p, index); }
    bool isAnythingMoving() const noexcept;
    bool isIdentity() const noexcept { return kinematics_.identity() != nullptr; }
    const MoveTag *active_tag() const noexcept;

    ControllerConfig config_;
    const kins::Kinematics &kinematics_;
    Channels &channels_;
    PathLink &link_;
    Settings settings_;
    traj::Executor executor_;
    homing::Homing homing_;

    std::uint64_t cycle_ = 0;
    Epoch epoch_ = 0;
    Mode mode_ = Mode::FREE;
    bool isEnabled_ = false;
    Stop stop_ = Stop::NONE;
    std::uint32_t enables_ = 0;
    CommandId last_id_ = 0;

    std::array<JointState, MAX_JOINTS> joints_{};
    std::array<AxisState, MAX_AXES> axes_{};
    std::array<SpindleState, MAX_SPINDLES> spindles_{};
    geom::Pose carte_pos_cmd_, carte_pos_fb_;
    double carte_velocity_ = 0;
    bool isCartePosValid_ = false;

    bool isOverridingLimits_ = false;
    bool isOverrideInJog_ = false;  ///< the jog that ends the override has begun
    bool isPaused_ = false, isStepping_ = false;
    bool isReverse_ = false;         ///< reverse run by command
    bool isReverseWanted_ = false;   ///< that, or adaptive feed below 0
    bool isStandingWanted_ = false;  ///< paused or held
    bool isPathLeft_ = false;        ///< the path was dropped while going back
    double reverse_rate_ = 0;        ///< of the commanded speed, without its sign
    std::uint64_t drops_seen_ = 0;
    bool isHomeDue_ = false;
    int home_due_ = -1;                 ///< the joint, -1: all
    bool isTeleopStopped_ = false;      ///< by a joint's limit, and said
    geom::Pose last_pose_, last_step_;  ///< of coordinated motion
    AxisMap map_;
    FoldedLimits limits_;
    std::uint32_t steps_ = 0;
    double feed_scale_ = 1, rapid_scale_ = 1, net_feed_scale_ = 1, max_velocity_ = 1e300;
    bool isFeedOverrideEnabled_ = true, isAdaptiveFeedEnabled_ = false, isFeedHoldEnabled_ = true;

    bool isWatchdogOn_ = false, isTaskLost_ = false;
    double watchdog_timeout_s_ = 0.5, watchdog_s_ = 0;
    std::uint64_t task_loops_ = 0;

    bool isProbeTripped_ = false, wasProbeClosed_ = false;
    traj::Sequence probe_move_ = 0;  ///< whose start has cleared the tripped flag
    std::uint32_t probe_trips_ = 0;
    geom::Pose probed_pos_, tool_offset_;

    std::uint64_t digital_out_ = 0;
    std::array<double, MAX_ANALOG_IO> analog_out_{};
    std::uint32_t limits_version_ = 0;
    SourceTag fault_source_;
    bool isCoordError_ = false;
};

}  // namespace mw::motion
