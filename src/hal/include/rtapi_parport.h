/* SPDX-License-Identifier: GPL-2.0-or-later */
/* PC-style parallel ports. Registers are accessed by rtapi_inb and rtapi_outb; their requirements apply. */
#ifndef RTAPI_PARPORT_H
#define RTAPI_PARPORT_H

#include "rtapi_io.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rtapi_parport_t {
    unsigned short base;
    unsigned short base_hi; /* 0: no ECP registers */
    void *region, *region_hi;
    void *dev;
} rtapi_parport_t;

/* Claims a port. base below 16 is the number of a port known to Linux, else the address. base_hi 0 searches
 * for the ECP registers, 0xffff means none. modes are as in <linux/parport.h>; a warning is logged when Linux
 * reports that the port does not have them. Returns 0, or a negated errno with a message. For set-up code. */
extern int rtapi_parport_get(const char *mod_name, rtapi_parport_t *port, unsigned short base,
                             unsigned short base_hi, unsigned int modes);
extern void rtapi_parport_release(rtapi_parport_t *port);

#define RTAPI_PARPORT_DATA_PORT(t) ((t)->base)
#define RTAPI_PARPORT_STATUS_PORT(t) ((unsigned short)((t)->base + 1))
#define RTAPI_PARPORT_CONTROL_PORT(t) ((unsigned short)((t)->base + 2))
#define RTAPI_PARPORT_EPP_ADDR_PORT(t) ((unsigned short)((t)->base + 3))
#define RTAPI_PARPORT_EPP_DATA_PORT(t) ((unsigned short)((t)->base + 4))
#define RTAPI_PARPORT_ECR_PORT(t) ((unsigned short)((t)->base_hi + 2))

static inline unsigned char rtapi_parport_data_read(rtapi_parport_t *t) {
    return rtapi_inb(RTAPI_PARPORT_DATA_PORT(t));
}
static inline void rtapi_parport_data_write(rtapi_parport_t *t, unsigned char v) {
    rtapi_outb(v, RTAPI_PARPORT_DATA_PORT(t));
}
static inline unsigned char rtapi_parport_status_read(rtapi_parport_t *t) {
    return rtapi_inb(RTAPI_PARPORT_STATUS_PORT(t));
}
static inline void rtapi_parport_status_write(rtapi_parport_t *t, unsigned char v) {
    rtapi_outb(v, RTAPI_PARPORT_STATUS_PORT(t));
}
static inline unsigned char rtapi_parport_control_read(rtapi_parport_t *t) {
    return rtapi_inb(RTAPI_PARPORT_CONTROL_PORT(t));
}
static inline void rtapi_parport_control_write(rtapi_parport_t *t, unsigned char v) {
    rtapi_outb(v, RTAPI_PARPORT_CONTROL_PORT(t));
}
static inline void rtapi_parport_epp_addr_write(rtapi_parport_t *t, unsigned char v) {
    rtapi_outb(v, RTAPI_PARPORT_EPP_ADDR_PORT(t));
}
static inline unsigned char rtapi_parport_epp_data_readb(rtapi_parport_t *t) {
    return rtapi_inb(RTAPI_PARPORT_EPP_DATA_PORT(t));
}
static inline unsigned long rtapi_parport_epp_data_readl(rtapi_parport_t *t) {
    return rtapi_inl(RTAPI_PARPORT_EPP_DATA_PORT(t));
}
static inline void rtapi_parport_epp_data_writeb(rtapi_parport_t *t, unsigned char v) {
    rtapi_outb(v, RTAPI_PARPORT_EPP_DATA_PORT(t));
}
static inline void rtapi_parport_epp_data_writel(rtapi_parport_t *t, unsigned long v) {
    rtapi_outl((unsigned int)v, RTAPI_PARPORT_EPP_DATA_PORT(t));
}
/* Without ECP registers reads return 0 and writes have no effect. */
static inline unsigned char rtapi_parport_ecr_read(rtapi_parport_t *t) {
    return t->base_hi == 0 ? 0 : rtapi_inb(RTAPI_PARPORT_ECR_PORT(t));
}
static inline void rtapi_parport_ecr_write(rtapi_parport_t *t, unsigned char v) {
    if (t->base_hi != 0) {
        rtapi_outb(v, RTAPI_PARPORT_ECR_PORT(t));
    }
}

#ifdef __cplusplus
}
#endif

#endif
