/* SPDX-License-Identifier: GPL-2.0-or-later */
#ifndef RTAPI_LIMITS_H
#define RTAPI_LIMITS_H
#include <limits.h>
#endif
