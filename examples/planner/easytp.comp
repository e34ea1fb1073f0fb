// SPDX-License-Identifier: GPL-2.0-or-later
component easytp "Template for a trajectory planner module of one's own";
description """
Drives paths with a share of the machine's speed and acceleration: easytp.speed-share and easytp.acceleration-share, 0.05 to 1.

Copy this file, name its component anew, write mw_tp_plan, then: halcompile --install NAME.comp and [TRAJ]TPMOD = NAME. What a
planner module may assume stands in docs/developer/extending/planner.md.
""";
pin out s32 asked = 0 "a component has a pin of its own";
option singleton yes;
option tpmod yes;
license "GPL";
author "Millwright";
;;
#include <rtapi_math.h>
#include <hal.h>
#include <planner.h>

/* Pins of the planner live in HAL memory, and belong to motmod, which asks it. */
typedef struct {
    hal_float_t *speed_share, *acceleration_share;
} easytp_pins;
static easytp_pins *pins;

/* Once, while motmod is loaded. */
int mw_tp_init(int comp_id, double servo_period_s) {
    int status;
    (void)servo_period_s;
    pins = hal_malloc(sizeof(*pins));
    if (pins == NULL) {
        return -ENOMEM;
    }
    status = hal_pin_float_newf(HAL_IN, &pins->speed_share, comp_id, "easytp.speed-share");
    if (status == 0) {
        status = hal_pin_float_newf(HAL_IN, &pins->acceleration_share, comp_id, "easytp.acceleration-share");
    }
    if (status == 0) {
        *pins->speed_share = 1;
        *pins->acceleration_share = 1;
    }
    return status;
}

static double within(double x, double low, double high) {
    return x < low ? low : x > high ? high : x == x ? x : low;
}

/* Up with a share of the acceleration, on at the top, down as the machine can. */
int mw_tp_plan(const mw_tp_stretch *s, mw_tp_phase *phases) {
    const double most = s->acceleration_at_cap < s->acceleration_at_rest ? s->acceleration_at_cap : s->acceleration_at_rest;
    const double up_a = most * within(*pins->acceleration_share, 0.05, 1);
    const double v2 = s->speed * s->speed;
    const double wish = s->speed_cap * within(*pins->speed_share, 0.05, 1);
    double end2, top2, up, down;
    /* At its end as fast as is wished, may be and can be come to. */
    end2 = wish < s->speed_out ? wish * wish : s->speed_out * s->speed_out;
    end2 = end2 < v2 + 2 * up_a * s->length ? end2 : v2 + 2 * up_a * s->length;
    end2 = end2 > v2 - 2 * most * s->length ? end2 : v2 - 2 * most * s->length;
    /* The top from which the end is in reach: up by up_a, down by most. */
    top2 = (2 * up_a * most * s->length + most * v2 + up_a * end2) / (up_a + most);
    top2 = top2 < wish * wish ? top2 : wish * wish;
    top2 = top2 > v2 ? top2 : v2;
    top2 = top2 > end2 ? top2 : end2;
    up = (top2 - v2) / (2 * up_a);
    down = (top2 - end2) / (2 * most);
    up = up < s->length ? up : s->length;
    down = down < s->length - up ? down : s->length - up;
    phases[0].length = up;
    phases[0].speed = sqrt(top2);
    phases[1].length = s->length - up - down;
    phases[1].speed = phases[0].speed;
    phases[2].length = down;
    phases[2].speed = sqrt(end2);
    return 3;
}

EXPORT_SYMBOL(mw_tp_init);
EXPORT_SYMBOL(mw_tp_plan);
