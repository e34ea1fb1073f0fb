/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Byte order of integers and of doubles. */
#ifndef RTAPI_BYTEORDER_H
#define RTAPI_BYTEORDER_H

#define RTAPI_BIG_ENDIAN (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)
#define RTAPI_LITTLE_ENDIAN (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__)
#define RTAPI_FLOAT_BIG_ENDIAN (__FLOAT_WORD_ORDER__ == __ORDER_BIG_ENDIAN__)

#endif
