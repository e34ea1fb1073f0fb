// SPDX-License-Identifier: GPL-2.0-or-later
// Loaded into a program by LD_PRELOAD. Calls on files whose path contains the text in the file $HUNG_DISK do
// not return until that file is removed.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static int is_hung(const char *path) {
    char text[1024];
    const char *control = getenv("HUNG_DISK");
    if (control == NULL || path == NULL || strcmp(path, control) == 0) {
        return 0;
    }
    const int file = (int)syscall(SYS_openat, AT_FDCWD, control, O_RDONLY | O_CLOEXEC, 0);
    if (file < 0) {
        return 0;
    }
    const ssize_t size = read(file, text, sizeof(text) - 1);
    close(file);
    text[size > 0 ? size : 0] = '\0';
    return size > 0 && strstr(path, text) != NULL;
}

static void wait_for(const char *path) {
    const struct timespec while_hung = {0, 5000000};
    while (is_hung(path)) {
        nanosleep(&while_hung, NULL);
    }
}

#pragma GCC visibility push(default)  // the project hides symbols

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static mode_t mode_of(int flags, va_list words) {
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(words, mode_t) : 0;
}

int open(const char *path, int flags, ...) {
    va_list words;
    va_start(words, flags);
    const mode_t mode = mode_of(flags, words);
    va_end(words);
    wait_for(path);
    return NEXT(open)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...) {
    va_list words;
    va_start(words, flags);
    const mode_t mode = mode_of(flags, words);
    va_end(words);
    wait_for(path);
    return NEXT(openat)(folder, path, flags, mode);
}

int rename(const char *from, const char *to) {
    wait_for(to);
    return NEXT(rename)(from, to);
}

int renameat(int old_folder, const char *from, int new_folder, const char *to) {
    wait_for(to);
    return NEXT(renameat)(old_folder, from, new_folder, to);
}

int stat(const char *restrict path, struct stat *restrict status) {
    wait_for(path);
    return NEXT(stat)(path, status);
}

int mkstemp(char *path) {
    wait_for(path);
    return NEXT(mkstemp)(path);
}

int posix_spawn(pid_t *restrict pid, const char *restrict path,
                const posix_spawn_file_actions_t *restrict files,
                const posix_spawnattr_t *restrict attributes, char *const argv[restrict],
                char *const env[restrict]) {
    wait_for(path);
    return NEXT(posix_spawn)(pid, path, files, attributes, argv, env);
}
