// SPDX-License-Identifier: GPL-2.0-or-later
component userthreads "Template for threads of one's own";
description """
Makes the threads of a machine before motmod is loaded: servo-thread, in which motion runs, and between it and base-thread a
thread io-thread for slow inputs, whose cycles the function userthreads.count counts.

Copy this file, name its component anew, then: halcompile --install NAME.comp and loadrt NAME in a HAL file before motmod. What
such a module may assume stands in docs/developer/extending/threads.md.
""";
pin out s32 cycles = 0 "runs of the function";
function count;
modparam int servo_period_ns = 1000000 "of servo-thread, as [EMCMOT]SERVO_PERIOD";
modparam int io_period_ns = 4000000 "of io-thread";
option singleton yes;
option extra_setup yes;
license "GPL";
author "Millwright";
;;
#include <hal.h>

/* The fastest first: a thread has the rank of its period. */
EXTRA_SETUP() {
    int status = hal_create_thread("servo-thread", servo_period_ns, 1);
    if (status == 0) {
        status = hal_create_thread("io-thread", io_period_ns, 1);
    }
    return status;
}

FUNCTION(count) {
    cycles = (cycles + 1) % 1000000000;
}
