/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Calls in the form that a component in C uses. */
#include "hal/include/inifile.h"

int level_of_name(const char *name, int *level) {
    return iniFindInt(name, "LEVEL", "A", level);
}

int level_of_stream(FILE *stream, int *level) {
    return iniFindInt(stream, "LEVEL", "A", level);
}

int text_of_name(char *name, char *text, size_t n) {
    return iniFindString(name, "TEXT", NULL, text, n);
}

const char *find_in_name(const char *name) {
    return iniFind(name, "TEXT", "A");
}

/* The header declares PATH_MAX, so that a buffer for a path needs no other header. */
int path_of_stream(FILE *stream, char (*path)[PATH_MAX]) {
    return iniFindString(stream, "PATH", "A", *path, sizeof *path);
}
