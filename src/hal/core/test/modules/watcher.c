/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Replaces a motion controller in tests: brakes for some cycles after its controlling process has died. */
#include "millwright_ext.h"
#include "rtapi_app.h"

static int cycles = 20;
RTAPI_MP_INT(cycles, "cycles of braking");

typedef struct {
    hal_bit_t *gone;
    hal_s32_t *left;
    rtapi_u32 is_gone;
    rtapi_u32 is_safe;
} watch_t;

static int comp_id;

static void update(void *arg, long period) {
    watch_t *watch = arg;
    (void)period;
    if (__atomic_load_n(&watch->is_gone, __ATOMIC_ACQUIRE) != 0) {
        *watch->gone = 1;
        if (*watch->left > 0) {
            *watch->left -= 1;
        }
        __atomic_store_n(&watch->is_safe, *watch->left == 0, __ATOMIC_RELEASE);
    }
}

int rtapi_app_main(void) {
    watch_t *watch;
    comp_id = hal_init("watcher");
    if (comp_id < 0) {
        return comp_id;
    }
    watch = hal_malloc(sizeof(*watch));
    hal_pin_bit_newf(HAL_OUT, &watch->gone, comp_id, "watcher.gone");
    hal_pin_s32_newf(HAL_OUT, &watch->left, comp_id, "watcher.left");
    *watch->left = cycles;
    mw_ext_watch_controller(&watch->is_gone, &watch->is_safe, comp_id);
    hal_export_funct("watcher", update, watch, 0, 0, comp_id);
    return hal_ready(comp_id);
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
