/* SPDX-License-Identifier: GPL-2.0-or-later */
/* rtapi_vsnprintf() and rtapi_snprintf(), under the name that LinuxCNC's components include. */
#ifndef RTAPI_VSNPRINTF_H
#define RTAPI_VSNPRINTF_H

#include "rtapi.h"

#endif
