/* SPDX-License-Identifier: GPL-2.0-or-later */
#ifndef RTAPI_CTYPE_H
#define RTAPI_CTYPE_H
#include <ctype.h>
#endif
