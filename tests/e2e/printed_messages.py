#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of components: rtapi_print, during loading and in a realtime function, goes to standard output, complete, in order and
with all conversions of printf; rtapi_print_msg goes to standard error. The expected lines are those of LinuxCNC 2.9.

usage: printed_messages.py BIN_FOLDER
"""
import os
import pathlib
import subprocess
import sys
import tempfile

LINES = 300
SOURCE = r"""
#include <limits.h>
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
MODULE_LICENSE("GPL");
static int id;
static long cycles;
static void all(const char *who) {
    rtapi_print("%s: [%d] [%5d] [%-5d] [%05d] [%+d] [% d] [%x] [%X] [%#x] [%o] [%u] [%c] [%%]\n", who, -42, 42, 42, 42, 42, 42, 0xbeef,
                0xbeef, 0xbeef, 8, 4000000000u, 'q');
    rtapi_print("%s: [%ld] [%lu] [%lld] [%llu] [%llx] [%hd] [%hhd] [%zu] [%i]\n", who, LONG_MIN, ULONG_MAX, LLONG_MIN, ULLONG_MAX,
                ULLONG_MAX, (short)-3, (signed char)-4, (size_t)7, 9);
    rtapi_print("%s: [%f] [%.3f] [%10.2f] [%-10.2f] [%+.1f] [%e] [%g] [%G] [%.0f]\n", who, 1.5, 3.14159, 2.5, 2.5, 1.25, 12345.678,
                0.0001, 1e20, 2.5);
    rtapi_print("%s: [%s] [%10s] [%-10s] [%.3s] [%*d] [%.*f] [%s]\n", who, "abc", "abc", "abc", "abcdef", 6, 42, 2, 1.0, "");
    rtapi_print("%s: a line", who);
    rtapi_print(" of %d", 3);
    rtapi_print(" texts\n");
}
static void run(void *arg, long period) {
    (void)arg, (void)period;
    if (++cycles == 1) {
        all("realtime");
        for (int i = 0; i < LINES; ++i) { rtapi_print("line %d\n", i); }
    } else if (cycles < 1000) {
        rtapi_print("cycle %ld\n", cycles);
    } else if (cycles == 1000) {
        rtapi_print_msg(RTAPI_MSG_ERR, "an error\n");
        rtapi_print_msg(RTAPI_MSG_INFO, "not at this level\n");
        rtapi_print("end\n");
    }
}
int rtapi_app_main(void) {
    id = hal_init("printer");
    all("loading");
    hal_export_funct("printer", run, 0, 1, 0, id);
    hal_ready(id);
    return 0;
}
void rtapi_app_exit(void) { rtapi_print("unloaded\n"); hal_exit(id); }
""".replace('LINES', str(LINES))
ALL = """[-42] [   42] [42   ] [00042] [+42] [ 42] [beef] [BEEF] [0xbeef] [10] [4000000000] [q] [%]
[-9223372036854775808] [18446744073709551615] [-9223372036854775808] [18446744073709551615] [ffffffffffffffff] [-3] [-4] [7] [9]
[1.500000] [3.142] [      2.50] [2.50      ] [+1.2] [1.234568e+04] [0.0001] [1E+20] [2]
[abc] [       abc] [abc       ] [abc] [    42] [1.00] []
a line of 3 texts""".splitlines()
EXPECTED = [*(f'loading: {line}' for line in ALL), *(f'realtime: {line}' for line in ALL), *(f'line {i}' for i in range(LINES)),
            *(f'cycle {i}' for i in range(2, 1000)), 'end', 'unloaded']
HAL = """loadrt printer
loadrt threads name1=t period1=1000000
addf printer t
start
loadusr -w sleep 2
"""


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix='mw_printed_') as folder:
        env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'printed-{os.getpid()}', 'MILLWRIGHT_MODULE_PATH': folder, 'LC_ALL': 'C'}
        (pathlib.Path(folder) / 'printer.c').write_text(SOURCE, encoding='ascii')
        (pathlib.Path(folder) / 'printer.hal').write_text(HAL, encoding='ascii')
        for command in (['halcompile', '--compile', 'printer.c'], ['halrun', '-f', 'printer.hal']):
            done = subprocess.run([programs / command[0], *command[1:]], cwd=folder, env=env, capture_output=True, text=True, check=False,
                                  timeout=100, stdin=subprocess.DEVNULL)
            if done.returncode != 0:
                sys.exit(f'{command}: {done.stdout}{done.stderr}')
    lines, errors = done.stdout.splitlines(), done.stderr.splitlines()
    for number, (line, wanted) in enumerate(zip(lines, EXPECTED)):
        if line != wanted:
            sys.exit(f'line {number} is {line!r}, not {wanted!r}')
    if len(lines) != len(EXPECTED):
        sys.exit(f'{len(lines)} lines, not {len(EXPECTED)}: ... {lines[-3:]}')
    if 'an error' not in errors or any('not at this level' in line for line in errors):
        sys.exit(f'standard error: {errors}')


if __name__ == '__main__':
    main()
