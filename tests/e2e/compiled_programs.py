#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A C program that was linked elsewhere and needs liblinuxcnchal.so.0 and liblinuxcncini.so.0 runs unmodified on Millwright's HAL
(B5).

It is compiled with Millwright's headers and linked to empty libraries of these names.

usage: compiled_programs.py BUILD_FOLDER
"""
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = r'''
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "hal.h"
#include "rtapi.h"

const char *iniFind(FILE *file, const char *tag, const char *section);
int iniFindDouble(FILE *file, const char *tag, const char *section, double *result);

typedef struct {
    hal_float_t *in, *out;
    hal_bit_t *is_on;
    hal_s32_t *turns;
    hal_u32_t *mask;
    hal_float_t gain;
    hal_s32_t offset;
} pins_t;

static volatile sig_atomic_t ended;
static void end(int number) { (void)number; ended = 1; }

int main(int argc, char **argv) {
    double gain = 0;
    FILE *file = argc > 1 ? fopen(argv[1], "r") : NULL;
    if (file == NULL || iniFindDouble(file, "GAIN", "DRIVE", &gain) != 0 || iniFind(file, "NONE", "DRIVE") != NULL) return 3;
    fclose(file);
    signal(SIGTERM, end);
    int id = hal_init("elsewhere");
    if (id < 0) return 4;
    pins_t *pins = hal_malloc(sizeof *pins);
    if (pins == NULL || hal_pin_float_newf(HAL_IN, &pins->in, id, "elsewhere.%d.in", 0) ||
        hal_pin_float_newf(HAL_OUT, &pins->out, id, "elsewhere.%d.out", 0) || hal_pin_bit_newf(HAL_IO, &pins->is_on, id, "elsewhere.%d.is-on", 0) ||
        hal_pin_s32_new("elsewhere.0.turns", HAL_OUT, &pins->turns, id) || hal_pin_u32_newf(HAL_IN, &pins->mask, id, "elsewhere.%d.mask", 0) ||
        hal_param_float_newf(HAL_RW, &pins->gain, id, "elsewhere.%d.gain", 0) || hal_param_s32_newf(HAL_RO, &pins->offset, id, "elsewhere.%d.offset", 0)) return 5;
    pins->gain = gain;
    pins->offset = -7;
    if (hal_ready(id) != 0) return 6;
    rtapi_print_msg(RTAPI_MSG_ERR, "elsewhere: %s %d\n", "ready", 42);
    while (!ended) {
        *pins->out = *pins->in * pins->gain;
        if (*pins->is_on) { *pins->turns -= (hal_s32_t)(*pins->mask & 0xffu); *pins->is_on = 0; }
        usleep(2000);
    }
    hal_exit(id);
    return 0;
}
'''
HAL = '''loadusr -W ./elsewhere drive.ini
newsig a float
net a => elsewhere.0.in
sets a 2.5
setp elsewhere.0.mask 0xffffff03
setp elsewhere.0.is-on 1
loadusr -w sleep 0.3
getp elsewhere.0.out
getp elsewhere.0.turns
getp elsewhere.0.offset
getp elsewhere.0.gain
setp elsewhere.0.gain -2
loadusr -w sleep 0.2
getp elsewhere.0.out
getp elsewhere.0.is-on
unloadusr elsewhere
loadusr -w sleep 0.3
list comp
'''


def run(words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, timeout=60, **more)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix='mw_elsewhere_') as name:
        folder = pathlib.Path(name)
        (folder / 'program.c').write_text(PROGRAM)
        (folder / 'drive.ini').write_text('[DRIVE]\nGAIN = 4.0\n')
        (folder / 'all.hal').write_text(HAL)
        names = 'hal_init hal_malloc hal_pin_float_newf hal_pin_bit_newf hal_pin_s32_new hal_pin_u32_newf hal_param_float_newf hal_param_s32_newf hal_ready hal_exit rtapi_print_msg'
        for library, functions in (('hal', names), ('ini', 'iniFind iniFindDouble')):
            (folder / f'{library}.c').write_text(''.join(f'void {one}(void) {{}}\n' for one in functions.split()))
            made = run(['cc', '-shared', '-fPIC', '-w', f'-Wl,-soname,liblinuxcnc{library}.so.0', '-o', folder / f'liblinuxcnc{library}.so', folder / f'{library}.c'])
            assert made.returncode == 0, made.stderr
        made = run(['cc', '-std=gnu11', '-Wall', '-DULAPI', f'-I{build}/include', '-o', folder / 'elsewhere', folder / 'program.c', f'-L{folder}', '-llinuxcnchal', '-llinuxcncini'])
        assert made.returncode == 0, made.stderr
        needed = run(['objdump', '-p', folder / 'elsewhere']).stdout
        assert 'liblinuxcnchal.so.0' in needed and 'liblinuxcncini.so.0' in needed and 'millwright' not in needed, needed
        env = {**os.environ, 'LD_LIBRARY_PATH': f'{build}/lib/millwright', 'MILLWRIGHT_INSTANCE': f'elsewhere-{os.getpid()}'}
        done = run([build / 'bin/halrun', '-s', '-f', 'all.hal'], cwd=folder, env=env)
    said = done.stdout.split('\n')
    wanted = ['10', '-3', '-7', '4', '-5', 'FALSE']
    got = [line.strip() for line in said if line.strip()][:6]
    failed = done.returncode != 0 or got != wanted or 'elsewhere: ready 42' not in done.stderr or any('elsewhere' in line for line in said)
    if failed:
        print(f'FAIL status {done.returncode}: {got}, not {wanted}\n{done.stdout}\n{done.stderr}')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
