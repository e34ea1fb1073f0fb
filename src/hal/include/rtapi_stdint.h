/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Integer and real types of fixed size under the names that components use. */
#ifndef RTAPI_STDINT_H
#define RTAPI_STDINT_H

#include <stdbool.h>
#include <stdint.h>

typedef int8_t rtapi_s8;
typedef int16_t rtapi_s16;
typedef int32_t rtapi_s32;
typedef int64_t rtapi_s64;
typedef uint8_t rtapi_u8;
typedef uint16_t rtapi_u16;
typedef uint32_t rtapi_u32;
typedef uint64_t rtapi_u64;
typedef intptr_t rtapi_intptr_t;
typedef uintptr_t rtapi_uintptr_t;

/* The widths in which HAL stores values. */
typedef bool rtapi_bool;
typedef double rtapi_real;
typedef int64_t rtapi_sint;
typedef uint64_t rtapi_uint;
typedef int rtapi_port;

#define RTAPI_INT8_MIN INT8_MIN
#define RTAPI_INT8_MAX INT8_MAX
#define RTAPI_UINT8_MAX UINT8_MAX
#define RTAPI_INT16_MIN INT16_MIN
#define RTAPI_INT16_MAX INT16_MAX
#define RTAPI_UINT16_MAX UINT16_MAX
#define RTAPI_INT32_MIN INT32_MIN
#define RTAPI_INT32_MAX INT32_MAX
#define RTAPI_UINT32_MAX UINT32_MAX
#define RTAPI_INT64_MIN INT64_MIN
#define RTAPI_INT64_MAX INT64_MAX
#define RTAPI_UINT64_MAX UINT64_MAX
#define RTAPI_SINT_MIN INT64_MIN
#define RTAPI_SINT_MAX INT64_MAX
#define RTAPI_UINT_MAX UINT64_MAX

#endif
