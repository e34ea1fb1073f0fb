/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Memory of the process (not of HAL). Only for set-up code, not for realtime functions. */
#ifndef RTAPI_SLAB_H
#define RTAPI_SLAB_H

#include <stdlib.h>

#include "rtapi_gfp.h"

#define rtapi_kmalloc(size, flags) malloc(size)
#define rtapi_kzalloc(size, flags) calloc(1, (size))
#define rtapi_krealloc(pointer, size, flags) realloc((pointer), (size))
#define rtapi_kfree free

#endif
