/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A module in C, written by hand. */
#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"
#include "rtapi_errno.h"
#include "rtapi_list.h"
#include "rtapi_string.h"

MODULE_AUTHOR("Millwright");
MODULE_DESCRIPTION("steps of several channels");
MODULE_LICENSE("GPL");

#define MOST 8
static char *ch[MOST];
RTAPI_MP_ARRAY_STRING(ch, MOST, "names of the channels")
static long scale = 1;
RTAPI_MP_LONG(scale, "what a step is worth")

typedef struct {
    struct rtapi_list_head list;
    hal_s32_t *count;
    hal_float_t *speed;
    hal_bit_t reset;
    hal_bool_t flag;
} channel_t;

static int comp_id;
static struct rtapi_list_head all;

static void run(void *arg, long period) {
    struct rtapi_list_head *at;
    (void)arg;
    rtapi_list_for_each(at, &all) {
        channel_t *c = rtapi_list_entry(at, channel_t, list);
        *c->count = c->reset ? 0 : *c->count + (int)scale;
        *c->speed = (double)scale / (period * 1e-9);
        hal_set_bool(c->flag, !hal_get_bool(c->flag));
    }
}

int rtapi_app_main(void) {
    int i, r = 0;
    RTAPI_INIT_LIST_HEAD(&all);
    comp_id = hal_init("cmod");
    if (comp_id < 0) {
        return comp_id;
    }
    for (i = 0; i < MOST && ch[i] && *ch[i] && r == 0; i++) {
        channel_t *c = hal_malloc(sizeof(channel_t));
        if (!c) {
            r = -ENOMEM;
            break;
        }
        rtapi_list_add_tail(&c->list, &all);
        r = hal_pin_s32_newf(HAL_OUT, &c->count, comp_id, "cmod.%s.count", ch[i]);
        if (r == 0) {
            r = hal_pin_float_newf(HAL_OUT, &c->speed, comp_id, "cmod.%s.speed", ch[i]);
        }
        if (r == 0) {
            r = hal_param_bit_newf(HAL_RW, &c->reset, comp_id, "cmod.%s.reset", ch[i]);
        }
        if (r == 0) {
            r = hal_pin_new_bool(comp_id, HAL_OUT, &c->flag, 1, "cmod.%s.flag", ch[i]);
        }
    }
    if (i == 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "cmod: no channels; ch= names them\n");
        r = -ERANGE;
    }
    if (r == 0) {
        r = hal_export_funct("cmod.run", run, 0, 1, 0, comp_id);
    }
    if (r != 0) {
        hal_exit(comp_id);
        return r;
    }
    hal_ready(comp_id);
    return 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
