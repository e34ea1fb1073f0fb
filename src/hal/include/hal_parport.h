/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The older names of rtapi_parport.h. */
#ifndef HAL_PARPORT_H
#define HAL_PARPORT_H

#include "hal.h"
#include "rtapi_parport.h"

typedef rtapi_parport_t hal_parport_t;

static inline int hal_parport_get(int comp_id, hal_parport_t *port, unsigned short base,
                                  unsigned short base_hi, unsigned int modes) {
    return rtapi_parport_get(hal_comp_name(comp_id), port, base, base_hi, modes);
}
static inline void hal_parport_release(hal_parport_t *port) {
    rtapi_parport_release(port);
}

#endif
