/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Values from an INI file that is open for reading. Link with -llinuxcncini or -lmillwright_ini.
 *
 * iniFind answers the value as a text, valid until the thread's next call, or NULL. The others answer 0,
 * -ENOENT when there is no such key, -EINVAL when the value is not of the type or out of its range, and leave
 * *result alone then. `section` may be NULL for any section. Not realtime-safe. */
#ifndef INIFILE_H
#define INIFILE_H

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

#ifdef __cplusplus
}
#endif

#endif
