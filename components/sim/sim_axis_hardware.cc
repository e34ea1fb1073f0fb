// SPDX-License-Identifier: GPL-2.0-or-later
// sim_axis_hardware: home and limit switches of the axes X X2 Y Y2 Z A U V, from their positions. Function
// sim-axis-hardware.N.update.
// For each axis, here x (old names have its letter in upper case without a hyphen, such as Xcurrent-pos;
// pins are float unless stated otherwise): inputs x-current-pos; x-homesw-pos (1) and x-homesw-hyst (0.025):
// the home
// switch is true within half of the hysteresis; x-maxsw-upper, x-maxsw-lower, x-minsw-upper, x-minsw-lower:
// the
// positions between which the limit switches are true; x-homing (bit). `limit-offset` (0.01) is added to
// x-maxsw-lower and subtracted from x-minsw-upper. Outputs (bit): x-homesw-out, x-maxsw-out, x-minsw-out;
// x-bothsw-out one of the limits, but not while any axis homes; x-maxsw-homesw-out, x-minsw-homesw-out,
// x-bothsw-homesw-out with the home switch too. Over all axes: limitsw-all (any bothsw), homesw-all (any home
// switch while an axis homes), limitsw-homesw-all.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr const char *AXES[] = {"X", "X2", "Y", "Y2", "Z", "A", "U", "V"};
constexpr int AXIS_COUNT = sizeof AXES / sizeof AXES[0];

struct SimAxis {
    In<double> current_pos, homesw_pos, maxsw_upper, maxsw_lower, minsw_upper, minsw_lower, homesw_hyst;
    In<bool> homing;
    Out<bool> homesw_out, maxsw_out, minsw_out, bothsw_out;
    Out<bool> maxsw_homesw_out, minsw_homesw_out, bothsw_homesw_out;

    void declare(Declare &d, const char *axis) noexcept {
        pin(d, current_pos, axis, "current-pos");
        pin(d, homesw_pos, axis, "homesw-pos", 1.0);
        pin(d, maxsw_upper, axis, "maxsw-upper");
        pin(d, maxsw_lower, axis, "maxsw-lower");
        pin(d, minsw_upper, axis, "minsw-upper");
        pin(d, minsw_lower, axis, "minsw-lower");
        pin(d, homesw_hyst, axis, "homesw-hyst", 0.025);
        pin(d, homing, axis, "homing");
        pin(d, homesw_out, axis, "homesw-out");
        pin(d, maxsw_out, axis, "maxsw-out");
        pin(d, minsw_out, axis, "minsw-out");
        pin(d, bothsw_out, axis, "bothsw-out");
        pin(d, maxsw_homesw_out, axis, "maxsw-homesw-out");
        pin(d, minsw_homesw_out, axis, "minsw-homesw-out");
        pin(d, bothsw_homesw_out, axis, "bothsw-homesw-out");
    }

    void update(double limit_offset, bool is_homing) noexcept {
        const double at = current_pos;
        const bool is_home = std::fabs(at - homesw_pos) <= homesw_hyst / 2.0;
        const bool is_max = maxsw_lower + limit_offset < at && at < maxsw_upper;
        const bool is_min = minsw_lower < at && at < minsw_upper - limit_offset;
        const bool is_limit = (is_max || is_min) && !is_homing;
        homesw_out = is_home;
        maxsw_out = is_max;
        minsw_out = is_min;
        bothsw_out = is_limit;
        maxsw_homesw_out = is_max || is_home;
        minsw_homesw_out = is_min || is_home;
        bothsw_homesw_out = is_limit || is_home;
    }

  private:
    template <class P>
    static void pin(Declare &d, P &made, const char *axis, const char *what,
                    typename P::Value start = {}) noexcept {
        char name[32];
        char legacy[32];
        rtapi_snprintf(legacy, sizeof legacy, "%s%s", axis, what);
        rtapi_snprintf(name, sizeof name, "%c%s-%s", axis[0] | 0x20, axis + 1, what);
        d.legacy_pin(made, name, legacy, start);
    }
};

struct SimAxisHardware {
    SimAxis axis[AXIS_COUNT];
    Out<bool> homesw_all, limitsw_all, limitsw_homesw_all;
    In<double> limit_offset;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < AXIS_COUNT; ++i) {
            axis[i].declare(d, AXES[i]);
        }
        d.pin(homesw_all, "homesw-all");
        d.pin(limitsw_all, "limitsw-all");
        d.pin(limitsw_homesw_all, "limitsw-homesw-all");
        d.pin(limit_offset, "limit-offset", 0.01);
        d.function<&SimAxisHardware::update>(this, "update");
    }

    void update() noexcept {
        bool is_homing = false;
        for (const SimAxis &each : axis) {
            is_homing = is_homing || each.homing;
        }
        bool is_home = false;
        bool is_limit = false;
        const double offset = limit_offset;
        for (SimAxis &each : axis) {
            each.update(offset, is_homing);
            is_home = is_home || (is_homing && each.homesw_out);
            is_limit = is_limit || each.bothsw_out;
        }
        homesw_all = is_home;
        limitsw_all = is_limit;
        limitsw_homesw_all = is_home || is_limit;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimAxisHardware, "sim_axis_hardware", mw::sdk::MANY);
