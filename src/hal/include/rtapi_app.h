/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The two functions that every realtime module defines. */
#ifndef RTAPI_APP_H
#define RTAPI_APP_H

#include "rtapi.h"

RTAPI_BEGIN_DECLS

/* Called once after loading, with the module parameters set: 0 when ready, a negated errno to refuse. */
RTAPI_EXPORT extern int rtapi_app_main(void);
/* Called before unloading, with no function of the module running. */
RTAPI_EXPORT extern void rtapi_app_exit(void);

/* Build lines of modules with several files take the exported names from the objects. */
EXPORT_SYMBOL(rtapi_app_main)
EXPORT_SYMBOL(rtapi_app_exit)

RTAPI_END_DECLS

#endif
