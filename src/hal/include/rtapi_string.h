/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Bounded string copies, and words of a command line. */
#ifndef RTAPI_STRING_H
#define RTAPI_STRING_H

#include <stddef.h>
#include <string.h>

#include "rtapi_slab.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Copies at most size-1 characters and ends dst with a zero. Returns strlen(src); if it is >= size, the text
 * was cut. */
extern size_t rtapi_strlcpy(char *dst, const char *src, size_t size);
/* Appends within a buffer of `size` bytes. Returns the length that the whole text would have. */
extern size_t rtapi_strlcat(char *dst, const char *src, size_t size);

/* Splits a text at blanks into a vector ended by NULL; *argc (if not NULL) receives its length. Free it with
 * rtapi_argv_free. Returns NULL without memory. Not for realtime functions. */
extern char **rtapi_argv_split(rtapi_gfp_t flags, const char *argstr, int *argc);
extern void rtapi_argv_free(char **argv);

#ifdef __cplusplus
}
#endif

#define rtapi_static_assert(condition, message) _Static_assert(condition, message)
#ifdef __cplusplus
#undef rtapi_static_assert
#define rtapi_static_assert(condition, message) static_assert(condition, message)
#endif

/* For destinations that are arrays: the size is taken from the type, and a pointer does not compile. */
#ifdef __cplusplus
#define rtapi_is_array(x) true
#define rtapi_strxcpy(dst, src) rtapi_strlcpy((dst), (src), sizeof(dst))
#define rtapi_strxcat(dst, src) rtapi_strlcat((dst), (src), sizeof(dst))
#else
#define rtapi_is_array(x) (!__builtin_types_compatible_p(__typeof__(x), __typeof__(&(x)[0])))
#define RTAPI_ARRAY_SIZE_(x)                                                                                 \
    (sizeof(x) + 0 * sizeof(struct {                                                                         \
                     _Static_assert(rtapi_is_array(x), "an array is needed");                                \
                     int y;                                                                                  \
                 }))
#define rtapi_strxcpy(dst, src) rtapi_strlcpy((dst), (src), RTAPI_ARRAY_SIZE_(dst))
#define rtapi_strxcat(dst, src) rtapi_strlcat((dst), (src), RTAPI_ARRAY_SIZE_(dst))
#endif
#define rtapi_kstrdup(text, flags) strdup(text)

#endif
