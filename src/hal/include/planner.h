/* SPDX-License-Identifier: GPL-2.0-or-later */
/* What a trajectory planner module of a user exports ([TRAJ]TPMOD); docs/developer/extending/planner.md. */
#ifndef MILLWRIGHT_PLANNER_H
#define MILLWRIGHT_PLANNER_H

#include "rtapi.h"

RTAPI_BEGIN_DECLS

/* What is left of a stretch of the path, and what the machine can do on it. Lengths in machine units (degrees
 * where only axes of rotation move), speeds per second. */
typedef struct mw_tp_stretch {
    double length;    /* from here to its end, above 0 */
    double speed;     /* here */
    double speed_cap; /* the highest on it: feed, overrides and limits are in it; `speed` is not above */
    double speed_out; /* the highest at its end: all that follows can be kept, stops included */
    /* The highest acceleration, up and down, at rest and at speed_cap; between them at least what a straight
     * line over the square of the speed gives. */
    double acceleration_at_rest;
    double acceleration_at_cap;
    int line;   /* of the program */
    int is_end; /* nothing is known behind it */
} mw_tp_stretch;

/* Over `length` to `speed`, with constant acceleration. */
typedef struct mw_tp_phase {
    double length, speed;
} mw_tp_phase;

#define MW_TP_PHASES 8

/* Once, while motmod is loaded: it may make pins for comp_id and allocate. 0, or negative: motmod is refused.
 */
RTAPI_EXPORT extern int mw_tp_init(int comp_id, double servo_period_s);
/* How the stretch is driven: up to MW_TP_PHASES phases, one behind the other, whose lengths make up that of
 * the stretch. Their number. In the planner's thread: no allocation, no lock, no loop without a bound. */
RTAPI_EXPORT extern int mw_tp_plan(const mw_tp_stretch *stretch, mw_tp_phase *phases);

RTAPI_END_DECLS

#endif
