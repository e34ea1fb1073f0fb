/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Error numbers. Functions return 0 or more for success and a negated error number for failure. */
#ifndef RTAPI_ERRNO_H
#define RTAPI_ERRNO_H
#include <errno.h>
#endif
