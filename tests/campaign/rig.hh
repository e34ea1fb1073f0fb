// SPDX-License-Identifier: GPL-2.0-or-later
// A complete machine in virtual time: task and motion unmodified, and plant models at the HAL pins in place
// of motors, encoders and switches. Its task may hang or be dead, its planner late.
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
#include "machine/task/task.hh"
#include "messages/client/client.hh"
#include "motion/interface/channels.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::campaign {

/// The virtual clock with a planner that can miss periods.
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

/// Faults of the rest of the machine.
struct MachineFaults {
    bool isChainOpen = false, isDisabled = false, isProbeClosed = false, isFeedInhibited = false;
    double adaptive_feed = 1;
    bool isSpindleFaulted = false, isSpindleNan = false, isAdaptiveNan = false;
    bool isTaskHeld = false, isTaskDead = false;
};

/// Model of the motor, amplifier, encoder and slide of a joint.
struct Plant {
    plants::Axis axis;
    plants::Encoder encoder;
    plants::BouncingSwitch home_switch;
    plants::Amplifier amplifier;
    double slide = 0;   ///< position
    double turned = 0;  ///< sum of the changes of the encoder zero by index marks
    int resets = 0;
    bool isTruthKnown = true, wasPowered = false;
};

class Rig final : public machine::Machine {
  public:
    Rig(const Design &design, std::uint64_t seed, std::string ini);
    ~Rig() override;
    /// Returns an error text; empty when the machine runs.
    std::string start();

    /// Runs one servo cycle, and the cycle of task when it is due.
    void cycle() override;
    std::int64_t now_ns() const override { return scheduler_.now_ns(); }
    bool isVirtual() const override { return true; }
    machine::RealtimeFigures realtime_figures() const override { return {}; }
    client::Client &client() override { return side_->client(); }
    mailbox::Segment &mailbox() override { return side_->mailbox(); }
    task::Task &task() override { return side_->task(); }
    motion::Channels &channels() override { return side_->channels(); }
    hal::Instance &hal() override { return host_->hal(); }

    const Sample &sample() const { return sample_; }
    const machine::MachineConfig &config() const { return loaded_->machine; }
    bool isInPosition() const { return *pins_.in_position; }
    bool isSwitchedOn() const;

    /// Sets the contacts in current machine coordinates. They are active once the probe is inside their
    /// range.
    void set_contacts(const std::vector<Contact> &contacts);
    /// Distance of the probe outside its walls along an axis; below 0: inside.
    double beyond_walls(int axis) const;

    /// Requests another external offset of the axis; the next method clears all offsets.
    void add_offset(int axis, double by);
    void clear_offsets(bool isWanted);
    bool hasOffset() const;
    /// Each offset has its requested value, or a limit prevents it.
    bool areOffsetsThere() const;

    /// Links a jog wheel; nullptr: unlinks it.
    void link_wheel(const Turning *turning, int target);
    void turn_wheel(int counts);

    void lose_encoder(int joint, bool isLost);
    void jump_encoder(int joint, double by);
    void trip_amplifier(int joint) { plants_[static_cast<std::size_t>(joint)].amplifier.trip(); }
    /// Removes all faults, as an operator does before switching on.
    void repair();
    /// The sides of a gantry are not aligned.
    bool isAskew() const;
    /// Aligns the sides by hand while the machine is off, as motion does not jog one side alone.
    void straighten();
    /// Encoder positions are true again after homing.
    void trust_encoders();

    MachineFaults faults;
    std::vector<JointFaults> joint_faults;
    bool isPlannerHeld() const { return scheduler_.isPlannerHeld; }
    void hold_planner(bool isHeld) { scheduler_.isPlannerHeld = isHeld; }

  private:
    struct Wall {
        std::size_t joint = 0;
        Contact at;  ///< range of the slide without contact
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
