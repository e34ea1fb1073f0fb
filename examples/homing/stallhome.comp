// SPDX-License-Identifier: GPL-2.0-or-later
component stallhome """Homing against the end stop: a joint moves at HOME_SEARCH_VEL until its drive says that it is
blocked, takes that place as HOME_OFFSET, and moves to HOME.""";
description """An example of a homing module. Joints are homed together, whatever their HOME_SEQUENCE; those whose
HOME_SEARCH_VEL is 0 are homed where they stand. Pins: *stallhome.N.blocked* bit in, from the drive of joint N;
*stallhome.N.step* s32 out: 0 none, 1 moving to the stop, 2 braking, 3 moving to HOME.

Built with *halcompile*(1) and named in the INI file: *[EMCMOT]HOMEMOD = stallhome*.""";
option homemod;
option singleton;
pin out bit is_module = 1;
license "GPL";
author "Millwright";
;;
#include "homing.h"

#define MOST_JOINTS 16
/* How often the range of the joint to look for the stop. */
#define RANGES 1.5

enum step { IDLE, TO_STOP, BRAKING, TO_HOME };

struct home {
    double offset, home, final_vel, search_vel;
    int sequence;
    enum step step;
    bool is_homed, is_begun;
};

static struct home homes[MOST_JOINTS];
static emcmot_joint_t *joints;
static int num_joints;
/* In HAL's memory: linking a pin changes the pointer to it. */
static struct pins {
    hal_bit_t *blocked[MOST_JOINTS];
    hal_s32_t *step[MOST_JOINTS];
} *pins;

void homeMotFunctions(void (*set_unlock)(int, int), int (*get_unlock)(int)) {
    (void)set_unlock;
    (void)get_unlock;
}

int homing_init(int id, double servo_period, int n_joints, int n_extrajoints, emcmot_joint_t *pjoints) {
    int j;
    (void)servo_period;
    (void)n_extrajoints;
    pins = hal_malloc(sizeof(struct pins));
    if (pins == NULL || n_joints > MOST_JOINTS) {
        return -1;
    }
    joints = pjoints;
    num_joints = n_joints;
    for (j = 0; j < n_joints; j++) {
        if (hal_pin_bit_newf(HAL_IN, &pins->blocked[j], id, "stallhome.%d.blocked", j) != 0 ||
            hal_pin_s32_newf(HAL_OUT, &pins->step[j], id, "stallhome.%d.step", j) != 0) {
            return -1;
        }
    }
    return 0;
}

void read_homing_in_pins(int njoints) { (void)njoints; }

void write_homing_out_pins(int njoints) {
    int j;
    for (j = 0; j < njoints; j++) {
        *pins->step[j] = homes[j].step;
    }
}

static void begin(int j) {
    homes[j].is_homed = false;
    homes[j].is_begun = false;
    homes[j].step = homes[j].search_vel != 0 ? TO_STOP : BRAKING;
}

void do_home_joint(int jno) {
    int j;
    for (j = 0; j < num_joints; j++) {
        if (jno == j || (jno < 0 && homes[j].sequence < 100)) {
            begin(j);
        }
    }
}

void do_cancel_homing(int jno) {
    int j;
    for (j = 0; j < num_joints; j++) {
        if (jno < 0 || jno == j) {
            homes[j].step = IDLE;
            joints[j].free_tp.enable = 0;
        }
    }
}

static void move(int j, double to, double velocity) {
    joints[j].free_tp.pos_cmd = to;
    joints[j].free_tp.max_vel = velocity;
    joints[j].free_tp.enable = 1;
}

/* One cycle of a joint that is being homed. */
static void go_on(int j) {
    struct home *h = &homes[j];
    double range = joints[j].max_pos_limit - joints[j].min_pos_limit;
    double way = h->search_vel > 0 ? RANGES * range : -RANGES * range;
    double velocity = h->search_vel > 0 ? h->search_vel : -h->search_vel;
    switch (h->step) {
    case IDLE: break;
    case TO_STOP:
        if (!h->is_begun) {
            move(j, joints[j].pos_cmd + way, velocity);
            h->is_begun = true;
        } else if (*pins->blocked[j]) {
            joints[j].free_tp.enable = 0;
            h->step = BRAKING;
        } else if (!joints[j].free_tp.active) {
            rtapi_print_msg(RTAPI_MSG_ERR, "stallhome: joint %d was not blocked within its travel\n", j);
            joints[j].free_tp.enable = 0;
            h->step = IDLE;
        }
        break;
    case BRAKING:
        if (!joints[j].free_tp.active) {
            /* joint position = motor position - offset: from here the place has another number. */
            joints[j].motor_offset += joints[j].pos_fb - h->offset;
            move(j, h->home, h->final_vel > 0 ? h->final_vel : joints[j].vel_limit);
            h->step = TO_HOME;
            h->is_begun = false;
        }
        break;
    case TO_HOME:
        if (!h->is_begun) {
            h->is_begun = true; /* it begins to move in this cycle */
        } else if (!joints[j].free_tp.active) {
            joints[j].free_tp.enable = 0;
            h->step = IDLE;
            h->is_homed = true;
        }
        break;
    }
}

bool get_homing_is_active(void) {
    int j;
    for (j = 0; j < num_joints; j++) {
        if (homes[j].step != IDLE) {
            return true;
        }
    }
    return false;
}

bool get_allhomed(void) {
    int j;
    for (j = 0; j < num_joints; j++) {
        if (!homes[j].is_homed) {
            return false;
        }
    }
    return num_joints > 0;
}

bool do_homing(void) {
    bool was_active = get_homing_is_active();
    int j;
    for (j = 0; j < num_joints; j++) {
        go_on(j);
    }
    return was_active && !get_homing_is_active() && get_allhomed();
}

void set_unhomed(int jno, motion_state_t motstate) {
    int j;
    (void)motstate;
    for (j = 0; j < num_joints; j++) {
        if (jno < 0 || jno == j) {
            homes[j].is_homed = false;
        }
    }
}

void update_joint_homing_params(int jno, double home_offset, double home_home, int home_sequence) {
    homes[jno].offset = home_offset;
    homes[jno].home = home_home;
    homes[jno].sequence = home_sequence < 0 ? -home_sequence : home_sequence;
}

void set_joint_homing_params(int jno, double offset, double home, double home_final_vel, double home_search_vel,
                             double home_latch_vel, int home_flags, int home_sequence, bool volatile_home) {
    (void)home_latch_vel;
    (void)home_flags;
    (void)volatile_home;
    homes[jno].final_vel = home_final_vel;
    homes[jno].search_vel = home_search_vel;
    update_joint_homing_params(jno, offset, home, home_sequence);
}

int get_home_sequence(int jno) { return homes[jno].sequence; }
bool get_homing(int jno) { return homes[jno].step != IDLE; }
bool get_homed(int jno) { return homes[jno].is_homed; }
bool get_home_is_idle(int jno) { return homes[jno].step == IDLE; }
bool get_home_is_synchronized(int jno) { (void)jno; return false; }
bool get_home_needs_unlock_first(int jno) { (void)jno; return false; }
bool get_index_enable(int jno) { (void)jno; return false; }
bool get_homing_at_index_search_wait(int jno) { (void)jno; return false; }

EXPORT_SYMBOL(homeMotFunctions);
EXPORT_SYMBOL(homing_init);
EXPORT_SYMBOL(read_homing_in_pins);
EXPORT_SYMBOL(write_homing_out_pins);
EXPORT_SYMBOL(do_home_joint);
EXPORT_SYMBOL(do_cancel_homing);
EXPORT_SYMBOL(do_homing);
EXPORT_SYMBOL(set_unhomed);
EXPORT_SYMBOL(set_joint_homing_params);
EXPORT_SYMBOL(update_joint_homing_params);
EXPORT_SYMBOL(get_home_sequence);
EXPORT_SYMBOL(get_homing);
EXPORT_SYMBOL(get_homed);
EXPORT_SYMBOL(get_allhomed);
EXPORT_SYMBOL(get_homing_is_active);
EXPORT_SYMBOL(get_home_is_idle);
EXPORT_SYMBOL(get_home_is_synchronized);
EXPORT_SYMBOL(get_home_needs_unlock_first);
EXPORT_SYMBOL(get_index_enable);
EXPORT_SYMBOL(get_homing_at_index_search_wait);
