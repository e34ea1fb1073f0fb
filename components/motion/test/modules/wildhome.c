/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A homing module for tests: `manner` selects its behaviour. The joint moves to 4 below its start, sets its
 * position there to 10, and moves to 12. */
#include <math.h>

#include "hal.h"
#include "homing.h"
#include "rtapi.h"
#include "rtapi_app.h"

enum { MILD, FAST, FAR, NOT_A_NUMBER, STUBBORN, GIVING_UP, OWN_PINS, LETTING_GO };
static int manner = MILD;
RTAPI_MP_INT(manner, "0 mild, 1 fast, 2 far, 3 not a number, 4 ignores cancel, 5 stops, 6 has its own pins, "
                     "7 releases half way");

static int component, joint_count, step[16];
static bool homed[16];
static double start[16];
static emcmot_joint_t *joints;
/* Pins show the data of a joint that the module reads in each cycle. */
#define SEEN 7
static const char *const seen_names[SEEN] = {"pos-fb",        "motor-pos-fb",  "vel-limit",   "acc-limit",
                                             "min-pos-limit", "max-pos-limit", "motor-offset"};
static struct pins {
    hal_bit_t *home_switch[16];
    hal_float_t *seen[16][SEEN];
} *pins;

int rtapi_app_main(void) {
    component = hal_init("wildhome");
    return component < 0 ? component : hal_ready(component);
}
void rtapi_app_exit(void) {
    hal_exit(component);
}

void homeMotFunctions(void (*set_unlock)(int, int), int (*get_unlock)(int)) {
    (void)set_unlock;
    (void)get_unlock;
}
int homing_init(int id, double servo_period, int n_joints, int n_extrajoints, emcmot_joint_t *pjoints) {
    int i, j, status = 0;
    (void)servo_period;
    (void)n_extrajoints;
    joints = pjoints;
    joint_count = n_joints;
    pins = hal_malloc(sizeof *pins);
    for (j = 0; j < n_joints && manner == OWN_PINS && status == 0; j++) {
        status = hal_pin_bit_newf(HAL_IN, &pins->home_switch[j], id, "joint.%d.home-sw-in", j);
    }
    for (i = 0; i < n_joints * SEEN && status == 0; i++) {
        status = hal_pin_float_newf(HAL_OUT, &pins->seen[i / SEEN][i % SEEN], id, "wildhome.%d.%s", i / SEEN,
                                    seen_names[i % SEEN]);
    }
    return status;
}
void read_homing_in_pins(int njoints) {
    (void)njoints;
}
void write_homing_out_pins(int njoints) {
    (void)njoints;
}
void do_home_joint(int jno) {
    int j;
    for (j = 0; j < joint_count; j++) {
        if (jno < 0 || jno == j) {
            step[j] = 1;
            homed[j] = false;
        }
    }
}
void do_cancel_homing(int jno) {
    int j;
    for (j = 0; j < joint_count && manner != STUBBORN; j++) {
        if (jno < 0 || jno == j) {
            step[j] = 0;
        }
    }
}
static void go(int j, double to) {
    joints[j].free_tp.pos_cmd = manner == NOT_A_NUMBER ? NAN : to;
    joints[j].free_tp.max_vel = manner == FAST ? 1e6 : 5;
    joints[j].free_tp.max_acc = manner == FAST ? 1e9 : 100;
    joints[j].free_tp.enable = 1;
}
static void show_seen(int j) {
    const double values[SEEN] = {joints[j].pos_fb,      joints[j].motor_pos_fb,  joints[j].vel_limit,
                                 joints[j].acc_limit,   joints[j].min_pos_limit, joints[j].max_pos_limit,
                                 joints[j].motor_offset};
    int i;
    for (i = 0; i < SEEN; i++) {
        *pins->seen[j][i] = values[i];
    }
}
bool do_homing(void) {
    int j;
    for (j = 0; j < joint_count; j++) {
        show_seen(j);
        switch (step[j]) {
        case 1:
            start[j] = joints[j].pos_cmd;
            go(j, manner == FAR || manner == STUBBORN ? -1e7 : start[j] - 4);
            joints[j].pos_cmd = 1e5; /* which counts for nothing */
            step[j] = 2;
            break;
        case 2:
            if (manner == LETTING_GO && joints[j].pos_cmd < start[j] - 2) {
                joints[j].free_tp.enable = 0;
                step[j] = 5; /* and waits */
            } else if (!joints[j].free_tp.active) {
                joints[j].motor_offset = joints[j].motor_pos_fb - 10;
                joints[j].free_tp.enable = 0;
                step[j] = manner == GIVING_UP ? 0 : 3;
            }
            break;
        case 3:
            go(j, 12);
            step[j] = 4;
            break;
        case 4:
            if (!joints[j].free_tp.active) {
                joints[j].free_tp.enable = 0;
                homed[j] = true;
                step[j] = 0;
            }
            break;
        default: break;
        }
    }
    return false;
}
void set_unhomed(int jno, motion_state_t motstate) {
    (void)motstate;
    homed[jno < 0 ? 0 : jno] = false;
}
void set_joint_homing_params(int jno, double offset, double home, double home_final_vel,
                             double home_search_vel, double home_latch_vel, int home_flags, int home_sequence,
                             bool volatile_home) {
    (void)jno, (void)offset, (void)home, (void)home_final_vel, (void)home_search_vel, (void)home_latch_vel;
    (void)home_flags, (void)home_sequence, (void)volatile_home;
}
void update_joint_homing_params(int jno, double home_offset, double home_home, int home_sequence) {
    (void)jno, (void)home_offset, (void)home_home, (void)home_sequence;
}
int get_home_sequence(int jno) {
    (void)jno;
    return 0;
}
bool get_homing(int jno) {
    return step[jno] != 0;
}
bool get_homed(int jno) {
    return homed[jno];
}
bool get_allhomed(void) {
    int j;
    for (j = 0; j < joint_count && homed[j]; j++) {
    }
    return j == joint_count;
}
bool get_homing_is_active(void) {
    int j;
    for (j = 0; j < joint_count && step[j] == 0; j++) {
    }
    return j < joint_count;
}
bool get_home_is_idle(int jno) {
    return step[jno] == 0;
}
bool get_home_is_synchronized(int jno) {
    (void)jno;
    return false;
}
bool get_home_needs_unlock_first(int jno) {
    (void)jno;
    return false;
}
bool get_index_enable(int jno) {
    (void)jno;
    return false;
}
bool get_homing_at_index_search_wait(int jno) {
    (void)jno;
    return false;
}
