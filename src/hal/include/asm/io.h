/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Port access under the kernel's names, for drivers written for the kernel. */
#ifndef RTAPI_ASM_IO_H
#define RTAPI_ASM_IO_H

#include "rtapi_io.h"

#define inb(port) rtapi_inb(port)
#define inw(port) rtapi_inw(port)
#define inl(port) rtapi_inl(port)
#define outb(value, port) rtapi_outb((value), (port))
#define outw(value, port) rtapi_outw((value), (port))
#define outl(value, port) rtapi_outl((value), (port))

#endif
