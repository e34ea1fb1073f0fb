/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A component in C as users write it: pins in memory of hal_malloc, a static variable, module parameters of
 * all types. */
#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"
#include "rtapi_string.h"

MODULE_AUTHOR("Millwright");
MODULE_DESCRIPTION("counts how often it runs");
MODULE_LICENSE("GPL");

static int start = 0;
RTAPI_MP_INT(start, "first count");
static int steps[3] = {1, 1, 1};
RTAPI_MP_ARRAY_INT(steps, 3, "step of each channel");
static char *names[3] = {0, 0, 0};
RTAPI_MP_ARRAY_STRING(names, 3, "names of channels");
static char *config = 0;
RTAPI_MP_STRING(config, "anything");

typedef struct {
    hal_s32_t *count;
    hal_bit_t *reset;
    hal_float_t scale;
    int step;
} channel_t;

static int comp_id;
static int loads;

int test_loads(void);
RTAPI_EXPORT int test_loads(void);
int test_loads(void) {
    return loads;
}

static void update(void *arg, long period) {
    channel_t *channel = arg;
    (void)period;
    if (*channel->reset) {
        *channel->count = 0;
    } else {
        *channel->count += channel->step;
    }
}

static int make_channel(int number) {
    channel_t *channel = hal_malloc(sizeof(channel_t));
    char name[HAL_NAME_LEN + 1];
    int status;
    if (channel == 0) {
        return -ENOMEM;
    }
    if (names[number] != 0) {
        rtapi_strxcpy(name, names[number]);
    } else {
        rtapi_snprintf(name, sizeof(name), "counter.%d", number);
    }
    status = hal_pin_s32_newf(HAL_OUT, &channel->count, comp_id, "%s.count", name);
    if (status < 0) {
        return status;
    }
    status = hal_pin_bit_newf(HAL_IN, &channel->reset, comp_id, "%s.reset", name);
    if (status < 0) {
        return status;
    }
    status = hal_param_float_newf(HAL_RW, &channel->scale, comp_id, "%s.scale", name);
    if (status < 0) {
        return status;
    }
    *channel->count = start;
    channel->step = steps[number];
    channel->scale = 1.0;
    return hal_export_functf(update, channel, 1, 0, comp_id, "%s.update", name);
}

int rtapi_app_main(void) {
    int i;
    int status = 0;
    ++loads;
    comp_id = hal_init("counter");
    if (comp_id < 0) {
        return comp_id;
    }
    if (start < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "counter: start=%d is below 0\n", start);
        hal_exit(comp_id);
        return -EINVAL;
    }
    for (i = 0; i < 2 && status == 0; ++i) {
        status = make_channel(i);
    }
    if (status < 0) {
        hal_exit(comp_id);
        return status;
    }
    return hal_ready(comp_id);
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
