/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The two functions that every realtime module defines. */
#ifndef RTAPI_APP_H
#define RTAPI_APP_H

#include "rtapi.h"

RTAPI_BEGIN_DECLS

/* Called once after loading, with the module parameters set. Returns 0 when ready; a negated errno rejects
 * the load. */
RTAPI_EXPORT extern int rtapi_app_main(void);
/* Called before unloading, while no function of the module runs. */
RTAPI_EXPORT extern void rtapi_app_exit(void);

/* For modules with several files the exported names are read from the objects. */
EXPORT_SYMBOL(rtapi_app_main)
EXPORT_SYMBOL(rtapi_app_exit)

RTAPI_END_DECLS

#endif
