/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Standard atomics under names that C and C++ share. */
#ifndef RTAPI_ATOMIC_H
#define RTAPI_ATOMIC_H

#define RTAPI_USE_STDATOMIC 1

#ifdef __cplusplus
#include <atomic>
typedef std::atomic<bool> rtapi_atomic_bool;
typedef std::atomic<char> rtapi_atomic_char;
typedef std::atomic<signed char> rtapi_atomic_schar;
typedef std::atomic<unsigned char> rtapi_atomic_uchar;
typedef std::atomic<short> rtapi_atomic_short;
typedef std::atomic<unsigned short> rtapi_atomic_ushort;
typedef std::atomic<int> rtapi_atomic_int;
typedef std::atomic<unsigned int> rtapi_atomic_uint;
typedef std::atomic<long> rtapi_atomic_long;
typedef std::atomic<unsigned long> rtapi_atomic_ulong;
typedef std::atomic<long long> rtapi_atomic_llong;
typedef std::atomic<unsigned long long> rtapi_atomic_ullong;
#else
#include <stdatomic.h>
typedef atomic_bool rtapi_atomic_bool;
typedef atomic_char rtapi_atomic_char;
typedef atomic_schar rtapi_atomic_schar;
typedef atomic_uchar rtapi_atomic_uchar;
typedef atomic_short rtapi_atomic_short;
typedef atomic_ushort rtapi_atomic_ushort;
typedef atomic_int rtapi_atomic_int;
typedef atomic_uint rtapi_atomic_uint;
typedef atomic_long rtapi_atomic_long;
typedef atomic_ulong rtapi_atomic_ulong;
typedef atomic_llong rtapi_atomic_llong;
typedef atomic_ullong rtapi_atomic_ullong;
#endif

#endif
