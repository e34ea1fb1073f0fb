// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as programs see it.
#pragma once

#include "gcode/interpreter/world.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// Shows the interpreter what it was shown last. One thread.
class MachineWorld final : public gcode::World {
  public:
    struct Machine {
        gcode::LengthUnits units = gcode::LengthUnits::MM;
        unsigned axis_mask = 7;
        int num_spindles = 1;
    };
    explicit MachineWorld(const Machine &machine) : machine_(machine) {}

    void show(const gcode::MachineSnapshot &snapshot) { snapshot_ = snapshot; }
    void set_block_delete(bool isOn) { isBlockDelete_ = isOn; }
    void set_optional_stop(bool isOn) { isOptionalStop_ = isOn; }

    gcode::MachineSnapshot snapshot() const override { return snapshot_; }
    gcode::LengthUnits machine_units() const override { return machine_.units; }
    unsigned axis_mask() const override { return machine_.axis_mask; }
    int count_spindles() const override { return machine_.num_spindles; }
    bool isBlockDeleteOn() const override { return isBlockDelete_; }
    bool isOptionalStopOn() const override { return isOptionalStop_; }

  private:
    Machine machine_;
    gcode::MachineSnapshot snapshot_;
    bool isBlockDelete_ = true, isOptionalStop_ = true;
};

/// The state of the machine now.
gcode::MachineSnapshot snapshot_of(const motion::Status &motion, const io::Outputs &io,
                                   const Sequencer &sequencer);

}  // namespace mw::task
