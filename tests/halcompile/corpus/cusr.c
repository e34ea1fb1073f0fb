/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A program in C that reads HAL and shows the result on a pin. */
#include <signal.h>
#include <unistd.h>

#include "hal.h"
#include "rtapi.h"

static volatile sig_atomic_t done;
static void stop(int sig) {
    (void)sig;
    done = 1;
}
static int count_one(hal_query_t *query, void *arg) {
    (void)query;
    ++*(int *)arg;
    return 0;
}
int main(void) {
    struct {
        hal_s32_t *seen;
    } *pins;
    int id = hal_lib_init() == 0 ? hal_init("cusr") : -1;
    int other = hal_init("cusr-other"); /* a second one, which ends first */
    if (id < 0 || other < 0 || hal_exit(other) != 0) {
        return 1;
    }
    hal_lib_exit();
    signal(SIGTERM, stop);
    pins = hal_malloc(sizeof(*pins));
    if (!pins || hal_pin_s32_newf(HAL_OUT, &pins->seen, id, "cusr.seen") != 0) {
        return 1;
    }
    hal_ready(id);
    while (!done) {
        int count = 0;
        hal_list_p(NULL, count_one, &count);
        *pins->seen = count;
        usleep(1000);
    }
    hal_exit(id);
    return 0;
}
