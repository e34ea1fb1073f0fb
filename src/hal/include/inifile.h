/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Values from an INI file. Link with -llinuxcncini or -lmillwright_ini.
 *
 * The file is a stream that is open for reading, or a name: iniFindInt("mill.ini", ...). Included files are
 * read only if the file is passed by name.
 *
 * iniFind returns the value as a text, valid until the thread's next call, or NULL. The other functions
 * return 0, -ENOENT when there is no such key or file, or -EINVAL when the value has another type or is out
 * of its range; *result is then unchanged. `section` may be NULL for any section. Not realtime-safe. */
#ifndef INIFILE_H
#define INIFILE_H

#include <limits.h> /* PATH_MAX, for buffers of iniFindString */
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "rtapi_stdint.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const char *iniFind(FILE *fp, const char *tag, const char *section);
extern int iniFindInt(FILE *fp, const char *tag, const char *section, int *result);
extern int iniFindSInt(FILE *fp, const char *tag, const char *section, rtapi_sint *result);
extern int iniFindUInt(FILE *fp, const char *tag, const char *section, rtapi_uint *result);
extern int iniFindDouble(FILE *fp, const char *tag, const char *section, double *result);
/* TRUE YES ON 1 and FALSE NO OFF 0 in any case. */
extern int iniFindBool(FILE *fp, const char *tag, const char *section, bool *result);
/* -ENOSPC when dest, of n bytes, is too small. */
extern int iniFindString(FILE *fp, const char *tag, const char *section, char *dest, size_t n);

/* The same functions with the name of the file. The names above select them for a text argument. */
extern const char *iniFindIn(const char *file, const char *tag, const char *section);
extern int iniFindIntIn(const char *file, const char *tag, const char *section, int *result);
extern int iniFindSIntIn(const char *file, const char *tag, const char *section, rtapi_sint *result);
extern int iniFindUIntIn(const char *file, const char *tag, const char *section, rtapi_uint *result);
extern int iniFindDoubleIn(const char *file, const char *tag, const char *section, double *result);
extern int iniFindBoolIn(const char *file, const char *tag, const char *section, bool *result);
extern int iniFindStringIn(const char *file, const char *tag, const char *section, char *dest, size_t n);

#ifdef __cplusplus
}

inline const char *iniFind(const char *file, const char *tag, const char *section) {
    return iniFindIn(file, tag, section);
}
inline int iniFindInt(const char *file, const char *tag, const char *section, int *result) {
    return iniFindIntIn(file, tag, section, result);
}
inline int iniFindSInt(const char *file, const char *tag, const char *section, rtapi_sint *result) {
    return iniFindSIntIn(file, tag, section, result);
}
inline int iniFindUInt(const char *file, const char *tag, const char *section, rtapi_uint *result) {
    return iniFindUIntIn(file, tag, section, result);
}
inline int iniFindDouble(const char *file, const char *tag, const char *section, double *result) {
    return iniFindDoubleIn(file, tag, section, result);
}
inline int iniFindBool(const char *file, const char *tag, const char *section, bool *result) {
    return iniFindBoolIn(file, tag, section, result);
}
inline int iniFindString(const char *file, const char *tag, const char *section, char *dest, size_t n) {
    return iniFindStringIn(file, tag, section, dest, n);
}
#else
#define iniFind(file, tag, section) _Generic((file), FILE *: iniFind, default: iniFindIn)(file, tag, section)
#define iniFindInt(file, tag, section, result)                                                               \
    _Generic((file), FILE *: iniFindInt, default: iniFindIntIn)(file, tag, section, result)
#define iniFindSInt(file, tag, section, result)                                                              \
    _Generic((file), FILE *: iniFindSInt, default: iniFindSIntIn)(file, tag, section, result)
#define iniFindUInt(file, tag, section, result)                                                              \
    _Generic((file), FILE *: iniFindUInt, default: iniFindUIntIn)(file, tag, section, result)
#define iniFindDouble(file, tag, section, result)                                                            \
    _Generic((file), FILE *: iniFindDouble, default: iniFindDoubleIn)(file, tag, section, result)
#define iniFindBool(file, tag, section, result)                                                              \
    _Generic((file), FILE *: iniFindBool, default: iniFindBoolIn)(file, tag, section, result)
#define iniFindString(file, tag, section, dest, n)                                                           \
    _Generic((file), FILE *: iniFindString, default: iniFindStringIn)(file, tag, section, dest, n)
#endif

#endif
