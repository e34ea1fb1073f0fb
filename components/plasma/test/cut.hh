// SPDX-License-Identifier: GPL-2.0-or-later
// A table that is ready to cut, with the functions that tests use: run until a state, start, end, pause.
#pragma once

#include <gtest/gtest.h>

#include "components/plasma/test/table.hh"

namespace mw::plasma::test {

/// The material is at 2 mm, the torch at 90 mm, the voltage 100 V; a cut needs only a few hundred cycles.
struct Cut : Table {
    Cut() {
        in.units_per_mm = 1.0;
        in.homed = in.machine_is_on = in.torch_enable = in.thc_enable = true;
        in.program_is_idle = true;
        in.axis_z_max_limit = 100.0;
        in.arc_fail_delay = 0.03;
        in.arc_lost_delay = 0.02;
        in.arc_max_starts = 3;
        in.restart_delay = 0.03;
        in.arc_ok_low = 50.0;
        in.arc_ok_high = 200.0;
        in.arc_voltage_scale = 1.0;
        in.cut_feed_rate = 3000.0;
        in.cut_height = 1.5;
        in.cut_volts = 100.0;
        in.pierce_height = 3.0;
        in.pierce_delay = 0.02;
        in.probe_start_height = 20.0;
        in.probe_feed_rate = 60000.0;
        in.probe_final_speed = 10;
        in.setup_feed_rate = 600000.0;
        in.xy_feed_rate = 60000.0;
        in.thc_feed_rate = 6000.0;
        in.thc_delay = 0.01;
        in.thc_threshold = 1.0;
        in.pid_p_gain = 10.0;
        in.safe_height = 15.0;
        in.float_switch_travel = 1.0;
        in.feed_override = 1.0;
        in.cornerlock_threshold = 90.0;
        has_program = true;
    }
    void start() {
        in.program_is_idle = false;
        in.program_is_running = true;
        in.offsets_active = true;
        cycle();
        in.cutting_start = true;
    }
    /// Runs cycles until the cut is in this state. False when it is not reached within a second.
    bool reaches(State state) {
        constexpr int MOST_CYCLES = 1000;
        for (int i = 0; i < MOST_CYCLES; ++i) {
            cycle();
            if (core.state() == state) {
                return true;
            }
        }
        return false;
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            cycle();
        }
    }
    /// Cuts at full speed with the height control active.
    void cut() {
        start();
        ASSERT_TRUE(reaches(State::CUT_BY_VOLTAGE));
        in.current_velocity = 50.0;
        run(20);
        ASSERT_TRUE(out().thc_active);
    }
    double torch_mu() const { return z0_mu + out().z_offset_counts * out().offset_scale; }
};

}  // namespace mw::plasma::test
