/* SPDX-License-Identifier: GPL-2.0-or-later */
/* I/O ports of PC-style hardware. The process needs the capability CAP_SYS_RAWIO. Without it, and for ports
 * that were not claimed by rtapi_request_region or rtapi_ioperm, reads return all ones and writes have no
 * effect; the first access writes a message to the log. Realtime-safe after the first access of the calling
 * thread. */
#ifndef RTAPI_IO_H
#define RTAPI_IO_H

#ifdef __cplusplus
extern "C" {
#endif

extern unsigned char rtapi_inb(unsigned short port);
extern unsigned short rtapi_inw(unsigned short port);
extern unsigned int rtapi_inl(unsigned short port);
extern void rtapi_outb(unsigned char val, unsigned short port);
extern void rtapi_outw(unsigned short val, unsigned short port);
extern void rtapi_outl(unsigned int val, unsigned short port);
/* Permits (or forbids) `num` ports for all threads of this process. Returns 0, or -1 with errno set. */
extern int rtapi_ioperm(unsigned long from, unsigned long num, int turn_on);

#ifdef __cplusplus
}
#endif

#endif
