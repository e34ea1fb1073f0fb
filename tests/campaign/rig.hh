// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time, task and motion as they are, with plants at the pins of its HAL in place
// of motors, encoders and switches. Its task may be held or dead, its planner late.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "campaign/design.hh"
#include "campaign/judge.hh"
#include "campaign/pins.hh"
#include "campaign/plan.hh"
#include "components/plants/amplifier.hh"
#include "components/plants/axis.hh"
#include "components/plants/bouncing_switch.hh"
#include "components/plants/encoder.hh"
#include "components/plants/spindle_plant.hh"
#include "machine/assembly/machine.hh"
#include "machine/assembly/task_side.hh"
#include "machine/config/loaded_config.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::campaign {

/// The virtual clock, under which the planner may miss periods.
class LateScheduler final : public runtime::Scheduler {
  public:
    std::int64_t now_ns() const noexcept override { return clock_.now_ns(); }
    bool isVirtual() const noexcept override { return true; }
    Result<runtime::PeriodicId> add(const runtime::PeriodicSpec &spec) override;
    void remove(runtime::PeriodicId id) override { clock_.remove(id); }
    runtime::PeriodicStats stats(runtime::PeriodicId id) const override { return clock_.stats(id); }
    void run_until(std::int64_t time_ns) { clock_.run_until(time_ns); }

    bool isPlannerHeld = false;

  private:
    static void plan(void *self, std::int64_t period_ns);
    runtime::VirtualScheduler clock_;
    runtime::PeriodicSpec planner_;
};

/// Faults of the pins and plants of one joint.
struct JointFaults {
    bool isOnLimit = false, isEncoderNan = false;
};

/// What is wrong with the rest of the machine.
struct MachineFaults {
    bool isChainOpen = false, isDisabled = false, isProbeClosed = false, isFeedInhibited = false;
    double adaptive_feed = 1;
    bool isSpindleFaulted = false, isSpindleNan = false, isAdaptiveNan = false;
    bool isTaskHeld = false, isTaskDead = false;
};

/// A joint's motor with what is around it.
struct Plant {
    plants::Axis axis;
    plants::Encoder encoder;
    plants::BouncingSwitch home_switch;
    plants::Amplifier amplifier;
    double slide = 0;   ///< where it is
    double turned = 0;  ///< by how much index marks have moved the encoder's zero
    int resets = 0;
    bool isTruthKnown = true, wasPowered = false;
};

class Rig final : public machine::Machine {
  public:
    Rig(const Design &design, std::uint64_t seed, std::string ini);
    ~Rig() override;
    /// An error in words; empty when the machine runs.
    std::string start();

    /// One servo cycle, with task's where it is due.
    void cycle() override;
    std::int64_t now_ns() const override { return scheduler_.now_ns(); }
    bool isVirtual() const override { return true; }
    machine::RealtimeFigures realtime_figures() const override { return {}; }
    client::Client &client() override { return side_->client(); }
    mailbox::Segment &mailbox() override { return side_->mailbox(); }
    task::Task &task() override { return side_->task(); }
    motion::Channels &channels() override { return side_->channels(); }
    hal::Hal &hal() override { return host_->hal(); }

    const Sample &sample() const { return sample_; }
    const machine::MachineConfig &config() const { return loaded_->machine; }
    bool isInPosition() const { return *pins_.in_position; }
    bool isSwitchedOn() const;

    /// Where the probe has contact, in machine coordinates as they are now, once it has come into the room.
    void set_contacts(const std::vector<Contact> &contacts);
    /// How far the probe is beyond the walls of its room along an axis; below 0: within.
    double beyond_walls(int axis) const;

    /// Asks for another external offset of the axis; that of all to be cleared.
    void add_offset(int axis, double by);
    void clear_offsets(bool isWanted);
    bool hasOffset() const;
    /// Every offset is what is asked for, or a limit keeps it from that.
    bool areOffsetsThere() const;

    /// Links a wheel; nullptr: none moves anything.
    void link_wheel(const Turning *turning, int target);
    void turn_wheel(int counts);

    void lose_encoder(int joint, bool isLost);
    void jump_encoder(int joint, double by);
    void trip_amplifier(int joint) { plants_[static_cast<std::size_t>(joint)].amplifier.trip(); }
    /// The machine as an operator finds it who has looked for what was wrong.
    void repair();
    /// Sides of a gantry do not stand together.
    bool isAskew() const;
    /// Switched off: they are turned together by hand, as motion jogs none alone.
    void straighten();
    /// After homing: what encoders say is true again.
    void trust_encoders();

    MachineFaults faults;
    std::vector<JointFaults> joint_faults;
    bool isPlannerHeld() const { return scheduler_.isPlannerHeld; }
    void hold_planner(bool isHeld) { scheduler_.isPlannerHeld = isHeld; }

  private:
    struct Wall {
        std::size_t joint = 0;
        Contact at;  ///< by the slide of the joint
    };
    void step_task();
    void run_plants();
    void run_spindle();
    double beyond_wall(const Wall &wall) const;
    double askew(std::size_t joint) const;
    bool isProbeTouching() const;
    void take_sample();

    const Design &design_;
    std::string ini_;
    diagnostics::Sink sink_;
    LateScheduler scheduler_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
    std::unique_ptr<hal::LocalHost> host_;
    std::unique_ptr<machine::TaskSide> side_;
    runtime::PeriodicId periodic_{};
    std::vector<Wall> walls_;
    bool areWallsUp_ = false;
    WheelPins *wheel_ = nullptr;
    std::vector<Plant> plants_;
    MachinePins pins_{};
    double spindle_rpm_ = 0, spindle_turns_ = 0;
    plants::SpindlePlant spindle_;
    std::uint64_t cycles_ = 0;
    Sample sample_;
};

}  // namespace mw::campaign
