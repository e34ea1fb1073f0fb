// SPDX-License-Identifier: GPL-2.0-or-later
// A plasma table for tests: Z reaches the position of the offset counts one cycle later, the float switch
// closes at the material, the arc has its voltage while the torch is on. Pins are reached by name.
#pragma once

#include <cmath>
#include <string_view>

#include "components/plasma/plasma_core.hh"
#include "components/plasma/plasma_pins.hh"

namespace mw::plasma::test {

inline constexpr double PERIOD_S = 0.001;

/// Sets the input with that name. False when there is none.
inline bool set_input(Inputs &in, std::string_view name, double value) {
    bool known = false;
    sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) {
        using Value = typename std::remove_cvref_t<decltype(row)>::Value;
        if (name == row.name) {
            known = true;
            row.read(in, static_cast<Value>(value));
        }
    });
    return known;
}

/// The input with that name, as a number.
inline double input(const Inputs &in, std::string_view name) {
    double found = NAN;
    sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) {
        if (name == row.name) {
            found = static_cast<double>(in.*(row.read.member));
        }
    });
    return found;
}

struct Table {
    Inputs in;
    Core core;
    double material_mu = 2.0, z0_mu = 90.0, volts = 100.0, ohmic_mu = -1e9;
    bool has_float = true, has_volts = true, has_sideways = true;
    bool has_program = false;  ///< halui confirms program-pause and program-resume

    Table() {
        sdk::for_each_pin(INPUT_PINS, [&](const char *, const auto &row) { row.read(in, row.start); });
    }
    const Outputs &out() const { return core.out(); }

    void move() {
        in.z_offset_current = out().z_offset_counts * out().offset_scale;
        if (has_sideways) {
            in.x_offset_current = out().x_offset_counts * out().offset_scale;
            in.y_offset_current = out().y_offset_counts * out().offset_scale;
        }
        in.axis_z_position = in.z_offset_current + z0_mu;
        if (has_float) {
            in.float_switch = in.axis_z_position < material_mu;
        }
        if (has_volts) {
            in.arc_voltage_in = out().torch_on ? volts : 0.0;
        }
    }
    void pause() {
        in.program_is_paused = !in.program_is_idle;
        in.program_is_running = false;
    }
    void resume() {
        in.program_is_paused = false;
        in.program_is_running = !in.program_is_idle;
    }
    void answer() {
        if (out().program_pause && in.program_is_running) {
            pause();
        } else if (out().program_resume && in.program_is_paused) {
            resume();
        }
    }
    void cycle() {
        if (has_program) {
            answer();
        }
        move();
        core.step(in, PERIOD_S);
    }
};

}  // namespace mw::plasma::test
