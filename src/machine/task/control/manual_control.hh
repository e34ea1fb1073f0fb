// SPDX-License-Identifier: GPL-2.0-or-later
// Manual operation of the machine: jogs, homing, spindles, coolant, lubrication.
#pragma once

#include <type_traits>

#include "machine/task/control/mode_controller.hh"
#include "machine/task/states/homing_request.hh"

namespace mw::task {

/// Receiver of the reason why a jog was rejected. A client that renews a jog does so many times a second, so
/// only the first rejection is for the operator.
inline RefusalIsFor reader_of_refusal(const JogContinuous &jog) noexcept {
    return jog.isRenewal ? RefusalIsFor::ITS_CLIENT : RefusalIsFor::EVERYBODY;
}

/// Joints are homed one request at a time. All calls come from one thread.
class ManualControl {
  public:
    ManualControl(MachinePort &port, io::DiscreteIo &io, Sequencer &sequencer, ModeController &modes,
                  int num_spindles)
        : port_(port), io_(io), sequencer_(sequencer), modes_(modes), num_spindles_(num_spindles) {}

    /// `joint` -1: all joints.
    Result<Progress> home(mailbox::Serial command, int joint);
    Result<Progress> jog(mailbox::Serial command, const JogContinuous &jog);
    Result<Progress> jog(mailbox::Serial command, const JogIncrement &jog);
    Result<Progress> jog(mailbox::Serial command, const JogAbsolute &jog);
    Result<Progress> stop_jog(const JogStop &jog);
    /// Sets a signed speed; 0 stops the spindle.
    Result<Progress> set_spindle(int spindle, double speed_rpm);
    /// Changes the speed of a running spindle.
    Result<Progress> change_spindle_speed(int spindle, double step_rpm);
    Result<> check_spindle(int spindle) const;
    template <OneOf<MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff> Device>
    Result<Progress> switch_device(const Device &) {
        if constexpr (OneOf<Device, MistOn, MistOff>) {
            io_.set_mist(std::is_same_v<Device, MistOn>);
        } else if constexpr (OneOf<Device, FloodOn, FloodOff>) {
            io_.set_flood(std::is_same_v<Device, FloodOn>);
        } else if (std::is_same_v<Device, LubeOn> && io_.isEstopRequested()) {
            return fail("there is no lubrication in emergency stop");
        } else {
            io_.set_lube(std::is_same_v<Device, LubeOn>);
        }
        return Progress::DONE;
    }

    /// Called once in each cycle: reports homing that has ended, and homes the next waiting joint.
    void step();
    /// Called when motion has rejected a command.
    void refuse(motion::CommandId order, const std::string &reason);
    /// Called when work was aborted: homing and waiting joints are abandoned.
    void abort();
    bool isHoming() const { return homing_.isUnderWay(); }
    /// The joint being homed, -1: all.
    int homed_joint() const { return homing_.joint(); }

  private:
    MachinePort &port_;
    io::DiscreteIo &io_;
    Sequencer &sequencer_;
    ModeController &modes_;
    int num_spindles_;
    HomingRequest homing_;
};

}  // namespace mw::task
