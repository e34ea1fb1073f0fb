// SPDX-License-Identifier: GPL-2.0-or-later
component incl "Headers above and below";
include <rtapi_math.h>;
include "corpus_types.h";
pin in float angle;
pin out float sin_;
pin out float cos_;
function _;
license "GPL"; // GPL-2.0-or-later
;;
#include <rtapi_mutex.h>
#include <rtapi_byteorder.h>
static rtapi_mutex_t lock;
FUNCTION(_) {
    if (rtapi_mutex_try(&lock)) return;
    sin_ = sin(angle);
    cos_ = cos(angle);
    rtapi_mutex_give(&lock);
}
