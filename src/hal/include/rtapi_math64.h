/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Divisions of 64-bit numbers by 32-bit ones. Realtime-safe. */
#ifndef RTAPI_MATH64_H
#define RTAPI_MATH64_H

#include "rtapi_stdint.h"

static inline rtapi_u64 rtapi_div_u64_rem(rtapi_u64 dividend, rtapi_u32 divisor, rtapi_u32 *remainder) {
    *remainder = (rtapi_u32)(dividend % divisor);
    return dividend / divisor;
}
static inline rtapi_u64 rtapi_div_u64(rtapi_u64 dividend, rtapi_u32 divisor) {
    return dividend / divisor;
}
static inline rtapi_s64 rtapi_div_s64_rem(rtapi_s64 dividend, rtapi_s32 divisor, rtapi_s32 *remainder) {
    *remainder = (rtapi_s32)(dividend % divisor);
    return dividend / divisor;
}
static inline rtapi_s64 rtapi_div_s64(rtapi_s64 dividend, rtapi_s32 divisor) {
    return dividend / divisor;
}

#endif
