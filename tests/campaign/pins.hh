// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins between a machine and its plants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/core/instance.hh"

namespace mw::campaign {

struct JointPins {
    volatile double *pos_cmd, *pos_fb, *motor_cmd, *motor_fb;
    volatile bool *is_amp_on, *is_homed, *is_homing, *index_enable, *home_switch, *pos_limit, *neg_limit,
        *amp_fault;
};

struct SpindlePins {
    volatile bool *is_on, *amp_fault, *at_speed;
    volatile double *speed_out, *revs, *speed_in;
};

struct WheelPins {
    volatile std::int32_t *counts;
    volatile bool *is_enabled, *is_velocity_mode;
    volatile double *scale, *accel_fraction;
};

struct OffsetPins {
    volatile std::int32_t *counts;
    volatile bool *is_enabled, *is_clearing;
    volatile double *scale, *offset, *request;
};

struct MachinePins {
    volatile bool *in_position, *is_coord, *is_teleop, *are_all_homed;  ///< outputs of motion
    volatile bool *enable, *probe, *inhibit;                            ///< inputs of motion
    volatile bool *chain, *user_enable;
    volatile double *adaptive_feed;
    SpindlePins spindle;
    std::vector<JointPins> joints;
    std::vector<WheelPins> joint_wheels, axis_wheels;
    std::vector<volatile double *> axes;  ///< commanded
    std::vector<OffsetPins> offsets;      ///< of axes
    volatile bool *is_offset_limited, *input;
    std::vector<volatile bool *> outputs;  ///< amplifiers that are able to move

    /// Returns the name of a missing pin; empty if all exist. Call it after the HAL files, because links
    /// change the addresses of pins.
    std::string bind(hal::Instance &hal, std::size_t num_joints);
};

}  // namespace mw::campaign
