/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A device by name, as required by requests for firmware. */
#ifndef RTAPI_DEVICE_H
#define RTAPI_DEVICE_H

#ifdef __cplusplus
extern "C" {
#endif

#define RTAPI_DEVICE_NAME_LEN 64

struct rtapi_device {
    char name[RTAPI_DEVICE_NAME_LEN];
    void (*release)(struct rtapi_device *dev);
};

/* Formats the name as printf does. Returns 0, or -EINVAL when it is too long. */
extern int rtapi_dev_set_name(struct rtapi_device *dev, const char *name, ...)
    __attribute__((format(printf, 2, 3)));
/* There is no device model, so it always returns 0. */
extern int rtapi_device_register(struct rtapi_device *dev);
/* Calls dev->release, if there is one. */
extern void rtapi_device_unregister(struct rtapi_device *dev);

#ifdef __cplusplus
}
#endif

#endif
