// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as seen by programs.
#pragma once

#include "gcode/interpreter/world.hh"
#include "machine/io/discrete_io.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "motion/interface/status.hh"

namespace mw::task {

/// Passes the last snapshot to the interpreter. All calls come from one thread.
class MachineWorld final : public gcode::World {
  public:
    struct Machine {
        gcode::LengthUnits units = gcode::LengthUnits::MM;
        unsigned axis_mask = 7;
        int num_spindles = 1;
    };
    explicit MachineWorld(const Machine &machine) : machine_(machine) {}

    void show(const gcode::MachineSnapshot &snapshot) { snapshot_ = snapshot; }
    void set_block_delete(bool on) { is_block_delete_ = on; }
    void set_optional_stop(bool on) { is_optional_stop_ = on; }

    gcode::MachineSnapshot snapshot() const override { return snapshot_; }
    gcode::LengthUnits machine_units() const override { return machine_.units; }
    unsigned axis_mask() const override { return machine_.axis_mask; }
    int count_spindles() const override { return machine_.num_spindles; }
    bool isBlockDeleteOn() const override { return is_block_delete_; }
    bool isOptionalStopOn() const override { return is_optional_stop_; }

  private:
    Machine machine_;
    gcode::MachineSnapshot snapshot_;
    bool is_block_delete_ = true, is_optional_stop_ = true;
};

/// The current state of the machine.
gcode::MachineSnapshot snapshot_of(const motion::Status &motion, const io::Outputs &io,
                                   const Sequencer &sequencer);

}  // namespace mw::task
