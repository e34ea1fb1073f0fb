/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Firmware files of drivers. */
#ifndef RTAPI_FIRMWARE_H
#define RTAPI_FIRMWARE_H

#include "rtapi_device.h"
#include "rtapi_stdint.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rtapi_firmware {
    unsigned long size; /* bytes */
    const rtapi_u8 *data;
};

/* Reads a file below /lib/firmware. Folders in $MILLWRIGHT_FIRMWARE (colon separated) are searched first.
 * Returns 0, or a negated errno with a message. The caller releases the firmware. For set-up code only. */
extern int rtapi_request_firmware(const struct rtapi_firmware **fw, const char *name,
                                  struct rtapi_device *device);
extern void rtapi_release_firmware(const struct rtapi_firmware *fw);

#ifdef __cplusplus
}
#endif

#endif
