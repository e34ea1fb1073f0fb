#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs LinuxCNC's hm2_eth and ours with the same HAL file, at 1 kHz, on the same simulated 7I76E, over a link that loses, repeats
and delays packets.

usage: lossy_links.py HM2_BOARD HALRUN [--seconds N] [--cases NAME,NAME] (as root)
Prints a table: failed cycles (packet-error-total) since the faults began, and whether io_error has stopped all traffic. Exit
status 0 done, 77 skipped with the reason. Driver and board have SCHED_FIFO and separate network namespaces. Both drivers have
their default limits.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import linuxcnc_board

SKIPPED = 77
# LinuxCNC's driver needs each packet while it loads, so the faults begin later.
START_S = 12
CASES = {
    'none': '',
    'loss 0.1 %': 'loss=0.001',
    'loss 1 %': 'loss=0.01',
    'loss 5 %': 'loss=0.05',
    'duplicates 5 %': 'duplicate=0.05',
    'delay 0.25 ms': 'delay_us=250',
}
HAL = '''loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=1 num_stepgens=5"
loadrt threads name1=servo period1=1000000
addf BOARD.read servo
addf BOARD.write servo
setp BOARD.watchdog.timeout_ns 20000000
start
'''.replace('BOARD', 'hm2_7i76e.0')
LOOK = '''loadusr -w sleep 1
show pin hm2_7i76e.0.packet-error-total
show param hm2_7i76e.0.io_error
'''


def run(halrun, board, faults, seconds):
    """The failed cycles, and whether the traffic was stopped."""
    with tempfile.TemporaryDirectory() as name, linuxcnc_board.Network() as network:
        folder = pathlib.Path(name)
        folder.chmod(0o777)  # the driver of LinuxCNC runs as another user
        (folder / 'faults.txt').write_text('seed 1\n' + ''.join(f'{way} start_ms={1000 * START_S} {faults}\n' for way in ('to_board', 'to_host')))
        (folder / 'test.hal').write_text(HAL + LOOK + f'loadusr -w sleep {START_S + seconds}\n' + LOOK + 'stop\n')
        command = ['ip', 'netns', 'exec', network.board, 'chrt', '-f', '60', board, '--listen', linuxcnc_board.IP, '--model', '7i76e', '--faults',
                   str(folder / 'faults.txt')]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
            program.stdout.readline()
            # The two drivers must not share a HAL with another program.
            environment = dict(os.environ, RTAPI_UID='65534', RTAPI_FIFO_PATH=str(folder / 'fifo'), MILLWRIGHT_INSTANCE=folder.name)
            apart = ['ip', 'netns', 'exec', network.host, 'unshare', '--ipc', '--pid', '--fork', '--mount-proc', '--', 'chrt', '-f', '50']
            done = subprocess.run([*apart, halrun, '-f', str(folder / 'test.hal')], env=environment, capture_output=True, text=True,
                                  timeout=120 + 3 * seconds, check=False)
            program.terminate()
        text = done.stdout + done.stderr
        errors = [int(value, 0) for value in re.findall(r'(\S+)\s+hm2_7i76e\.0\.packet-error-total', done.stdout)]
        stopped = re.findall(r'(TRUE|FALSE)\s+hm2_7i76e\.0\.io[_-]error', done.stdout)
        if len(errors) != 2 or len(stopped) != 2:
            sys.exit(f'{halrun}: {text}')
        return errors[1] - errors[0], stopped[1] == 'TRUE'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('board')
    parser.add_argument('halrun')
    parser.add_argument('--seconds', type=int, default=10)
    parser.add_argument('--cases', default=','.join(CASES))
    options = parser.parse_args()
    if reason := linuxcnc_board.reason_to_skip():
        print(f'skipped: {reason}')
        return SKIPPED
    print('| disturbance, each way | LinuxCNC | Millwright |\n|---|---|---|')
    for case in options.cases.split(','):
        cells = []
        for halrun in (linuxcnc_board.HALRUN, options.halrun):
            errors, isStopped = run(halrun, options.board, CASES[case], options.seconds)
            cells.append(f'{errors} failed cycles' + (', stopped' if isStopped else ''))
        print(f'| {case} | {" | ".join(cells)} |', flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
