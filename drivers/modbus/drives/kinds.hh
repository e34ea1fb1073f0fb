// SPDX-License-Identifier: GPL-2.0-or-later
// The types of drives, with the pins and the behaviour of LinuxCNC's programs of the same names.
#pragma once

#include <memory>

#include "drivers/modbus/drives/drive.hh"

namespace mw::modbus::drives {

/// AutomationDirect GS2.
struct Gs2Settings {
    double accel_s = 10.0;
    double decel_s = 0.0;  ///< 0: coast to stop
    bool has_braking_resistor = false;
};
std::unique_ptr<Drive> make_gs2(const Gs2Settings &settings);

/// Delta VFD-B.
struct VfdbSettings {
    double motor_hz = 50.0, motor_rpm = 1410.0;
    int poll_cycles = 10;  ///< load, current and voltage are read in every n-th round
};
std::unique_ptr<Drive> make_vfdb(const VfdbSettings &settings);

}  // namespace mw::modbus::drives
