/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Functions that a homing module exports. docs/developer/extending/homing.md describes the assumptions that
 * it may make and how motion treats its requests. Positions are in joint units, speeds in joint units per
 * second. */
#ifndef HOMING_H
#define HOMING_H

#include <stdbool.h>

#include "rtapi.h"

RTAPI_BEGIN_DECLS

/* home_flags of set_joint_homing_params. */
#define HOME_IGNORE_LIMITS 1
#define HOME_USE_INDEX 2
#define HOME_IS_SHARED 4
#define HOME_UNLOCK_FIRST 8
#define HOME_ABSOLUTE_ENCODER 16
#define HOME_NO_REHOME 32
#define HOME_NO_FINAL_MOVE 64
#define HOME_INDEX_NO_ENCODER_RESET 128

typedef enum {
    EMCMOT_MOTION_DISABLED = 0,
    EMCMOT_MOTION_FREE,
    EMCMOT_MOTION_TELEOP,
    EMCMOT_MOTION_COORD
} motion_state_t;

/* The joint planner of a joint: a trapezoidal move to pos_cmd. */
typedef struct {
    double pos_cmd; /* target position */
    double max_vel; /* maximum velocity */
    double max_acc;
    int enable; /* 1: move to pos_cmd, 0: stop */
    double curr_pos;
    double curr_vel;
    int active; /* 1 while the joint moves */
} simple_tp_t;

/* A joint, as shared by motion and homing. */
typedef struct {
    int flag;
    double pos_cmd, vel_cmd;
    double pos_fb;
    double coarse_pos, backlash_filt;
    double motor_pos_cmd, motor_pos_fb;
    double motor_offset; /* motor position at joint position 0 */
    double max_pos_limit, min_pos_limit;
    double vel_limit, acc_limit;
    int on_pos_limit, on_neg_limit;
    simple_tp_t free_tp;
} emcmot_joint_t;

RTAPI_EXPORT extern void homeMotFunctions(void (*pSetRotaryUnlock)(int, int), int (*pGetRotaryUnlock)(int));
/* Creates the module's pins with component `id`. Returns 0, or nonzero when the module cannot be used. */
RTAPI_EXPORT extern int homing_init(int id, double servo_period, int n_joints, int n_extrajoints,
                                    emcmot_joint_t *pjoints);
RTAPI_EXPORT extern void read_homing_in_pins(int njoints);
RTAPI_EXPORT extern void write_homing_out_pins(int njoints);
/* jno -1: all joints, by their sequences. */
RTAPI_EXPORT extern void do_home_joint(int jno);
RTAPI_EXPORT extern void do_cancel_homing(int jno);
/* Runs one cycle; true in the cycle in which the last joint became homed. */
RTAPI_EXPORT extern bool do_homing(void);
/* jno -1: all joints; -2: joints with volatile_home. */
RTAPI_EXPORT extern void set_unhomed(int jno, motion_state_t motstate);
RTAPI_EXPORT extern void set_joint_homing_params(int jno, double offset, double home, double home_final_vel,
                                                 double home_search_vel, double home_latch_vel,
                                                 int home_flags, int home_sequence, bool volatile_home);
RTAPI_EXPORT extern void update_joint_homing_params(int jno, double home_offset, double home_home,
                                                    int home_sequence);

RTAPI_EXPORT extern int get_home_sequence(int jno);
RTAPI_EXPORT extern bool get_homing(int jno);
RTAPI_EXPORT extern bool get_homed(int jno);
RTAPI_EXPORT extern bool get_allhomed(void);
RTAPI_EXPORT extern bool get_homing_is_active(void);
RTAPI_EXPORT extern bool get_home_is_idle(int jno);
RTAPI_EXPORT extern bool get_home_is_synchronized(int jno);
RTAPI_EXPORT extern bool get_home_needs_unlock_first(int jno);
RTAPI_EXPORT extern bool get_index_enable(int jno);
RTAPI_EXPORT extern bool get_homing_at_index_search_wait(int jno);

RTAPI_END_DECLS

#endif
