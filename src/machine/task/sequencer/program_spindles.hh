// SPDX-License-Identifier: GPL-2.0-or-later
// The spindles as programmed, and as the operator commands them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/limits.hh"
#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "machine/task/link/motion_link.hh"

namespace mw::task {

/// Keeps the commands sent to motion, for calls that change a part of them. All calls come from one thread.
class ProgramSpindles {
  public:
    void set_mode(const gcode::SetSpindleMode &mode);
    void set_speed(const gcode::UseSpindleSpeed &speed, MotionLink &motion);
    void start(const gcode::StartSpindle &start, MotionLink &motion);
    void stop(const gcode::StopSpindle &stop, MotionLink &motion);
    /// The operator's command, executed at once; 0 stops.
    void command(int spindle, double signed_rpm, bool waiting, MotionLink &motion);
    /// New signed speed of a running spindle [rev/min]; a step does not start or stop a spindle.
    Result<double> stepped_rpm(int spindle, double step_rpm) const;
    void stop_all(MotionLink &motion);
    // Updates the centre line of spindles with constant surface speed.
    void use(const gcode::UseOffsets &offsets, MotionLink &motion);
    void use(const gcode::UseToolOffset &offset, MotionLink &motion);

    /// Calls that start the running spindles with their current settings.
    std::vector<gcode::MachineCall> starts() const;
    /// True if all spindles that run here have the same direction and speed in the other object.
    bool isKeptBy(const ProgramSpindles &other) const;

    /// As programmed, unscaled. [rev/min or surface units/min]
    double speed(int spindle) const { return spindles_[static_cast<std::size_t>(spindle)].speed; }
    int direction(int spindle) const { return spindles_[static_cast<std::size_t>(spindle)].direction; }
    /// The next cut waits until spindles have reached the speeds commanded since the last cut; it does not
    /// wait for a stopped spindle.
    bool isNextCutWaiting() const { return awaited_ != 0; }
    void end_wait() { awaited_ = 0; }

  private:
    struct Spindle {
        double speed = 0;
        double surface_unit = 0;
        double css_max_rpm = 0;
        int direction = 0;
        bool waiting = false;

        bool isKeptBy(const Spindle &other) const {
            return direction == 0 || (direction == other.direction && speed == other.speed &&
                                      surface_unit == other.surface_unit && css_max_rpm == other.css_max_rpm);
        }
    };
    Spindle &at(int spindle) { return spindles_[static_cast<std::size_t>(spindle)]; }
    void send(int spindle, MotionLink &motion);
    void set_awaited(int spindle, bool awaited);
    void follow_offsets(MotionLink &motion);

    std::array<Spindle, MAX_SPINDLES> spindles_{};
    gcode::UseOffsets offsets_;
    gcode::UseToolOffset tool_offset_;
    double centre_line_x_ = 0;   ///< machine X of program X0 [machine units]
    std::uint32_t awaited_ = 0;  ///< spindles that the next cut waits for; bit per spindle
};

}  // namespace mw::task
