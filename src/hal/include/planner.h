/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Functions that a user's trajectory planner module exports ([TRAJ]TPMOD); see
 * docs/developer/extending/planner.md. */
#ifndef MILLWRIGHT_PLANNER_H
#define MILLWRIGHT_PLANNER_H

#include "rtapi.h"

RTAPI_BEGIN_DECLS

/* The remaining part of a section of the path, and the limits of the machine on it. Lengths in machine units
 * (degrees if only rotary axes move), speeds per second. */
typedef struct mw_tp_stretch {
    double length;    /* remaining length, above 0 */
    double speed;     /* current speed */
    double speed_cap; /* maximum speed: includes feed, overrides and limits; `speed` does not exceed it */
    double speed_out; /* maximum speed at the end, so that the following path stays within its limits */
    /* Maximum acceleration and deceleration at standstill and at speed_cap. In between it is at least a
     * linear function of the square of the speed. */
    double acceleration_at_rest;
    double acceleration_at_cap;
    int line;   /* line of the program */
    int is_end; /* 1 if the following path is not known */
} mw_tp_stretch;

/* A phase ends after `length` at `speed`, with constant acceleration. */
typedef struct mw_tp_phase {
    double length, speed;
} mw_tp_phase;

#define MW_TP_PHASES 8

/* Called once while motmod is loaded; may create pins for comp_id and allocate memory. Returns 0; with a
 * negative result motmod is not loaded. */
RTAPI_EXPORT extern int mw_tp_init(int comp_id, double servo_period_s);
/* Calculates the motion on the section: up to MW_TP_PHASES consecutive phases whose lengths add up to the
 * length of the section. Returns their number. Runs in the planner's thread: no allocation, no lock, no loop
 * without a bound. */
RTAPI_EXPORT extern int mw_tp_plan(const mw_tp_stretch *stretch, mw_tp_phase *phases);

RTAPI_END_DECLS

#endif
