#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""mesaflash, a third-party program, reports the simulated boards; its report must agree with the model files.

usage: mesaflash_board.py HM2_BOARD MODELS_FOLDER
Exit status: 0 agrees, 1 differs, 77 skipped (mesaflash is not installed). Needs no privileges.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
# The names of the boards in mesaflash.
DEVICES = {'7i76e': '7i76e', '7i80': '7i80db-16', '7i80hd-3pwm': '7i80hd-16', '7i80hd-resolver': '7i80hd-16', '7i92': '7i92', '7i92-latch': '7i92',
           '7i92-uart': '7i92', '7i95': '7i95', '7i96s': '7i96s', '7i97': '7i97'}
# mesaflash's names for the modules of a pin.
NAMES = {'stepgen': 'StepGen', 'encoder': 'QCount', 'muxed-encoder': 'MuxedQCount', 'mux-select': 'MuxedQCountSel', 'pwm': 'PWM',
         'smart-serial': 'SSerial', 'ssr': 'SSR', 'inm': 'InM', 'inmux': 'InMux', 'three-phase-pwm': 'TPPWM', 'resolver': 'ResolverMod',
         'bspi': 'BufSPI', 'uart-tx': 'UARTTX', 'uart-rx': 'UARTRX', 'pkt-uart-tx': 'PktUARTTX', 'pkt-uart-rx': 'PktUARTRX', 'rc-pwm': 'RCPWM'}
# Smart serial cards on channels 0 to 3, with the modes that they declare.
REMOTES = 'remote 0 card=7i77\nremote 2 card=7i73\nremote 3 card=7i76\n'
REMOTE_FACTS = {0: ('7I77', 'I/O [index 00]'), 1: ('7I77', 'Analog [index 00]'), 2: ('7I73', 'I/O_Enc_Ana_FD [index 02]'),
                3: ('7I76', 'I/O_Spin_Ana_Enc [index 02]')}
PIN = re.compile(r'\s(\d+)\s+IOPort\s+(\S+)(?:\s+(\d+)\s+.*\((In|Out)\))?\s*$')
# Each run has its own address, so that simultaneous runs do not interfere.
ADDRESS = f'127.{1 + os.getpid() % 250}.{1 + os.getpid() // 250 % 250}.9'


def mesaflash(device, *options):
    run = subprocess.run(['mesaflash', '--device', device, '--addr', ADDRESS, *options], capture_output=True, text=True, timeout=60)
    return run.stdout + run.stderr


def pins_of_model(text):
    """{pin: (module, unit, direction)} of the declared pins."""
    pins = {}
    for number, module, unit, function in re.findall(r'^pin\s+(\d+) module=(\S+) unit=(\d+) function=0x(\w+)', text, re.M):
        pins[int(number)] = (NAMES[module], int(unit), 'Out' if int(function, 16) & 0x80 else 'In')
    return pins


def pins_of_report(report):
    pins = {}
    for match in filter(None, map(PIN.search, report.splitlines())):
        number, module, unit, direction = match.groups()
        if module != 'None':
            pins[int(number)] = (module, int(unit), direction)
    return pins


def check(name, device, text):
    """The differences of one board."""
    report = mesaflash(device, '--readhmid')
    wanted, reported = pins_of_model(text), pins_of_report(report)
    problems = [f'pin {pin}: {reported.get(pin)} reported, {wanted.get(pin)} in the model'
                for pin in sorted(wanted.keys() | reported.keys()) if wanted.get(pin) != reported.get(pin)]
    board = re.search(r'^board .* name=(\S+) ports=(\d+) port_width=(\d+)', text, re.M).groups()
    for fact, pattern in zip(board, (r'BoardName : (\S+)', r'Number of IO Ports: (\d+)', r'Width of one I/O port: (\d+)')):
        found = re.search(pattern, report)
        if found is None or found.group(1) != fact:
            problems.append(f'{fact} expected for "{pattern}": {found and found.group(1)}')
    for module, instances in re.findall(r'^module (\S+)\s+instances=(\d+)', text, re.M):
        if module in NAMES and f'There are {instances} of {NAMES[module]} in configuration' not in report:
            problems.append(f'{instances} of {NAMES[module]} are not reported')
    verbose = mesaflash(device, '--verbose')
    for fact in ('ip address: 192.168.1.121', 'protocol: LBP16 version 3', '0: HostMot2 (registers, RW, 32-bit) [size=64K]',
                 'parse errors: 0, mem errors 0, write errors 0'):
        if fact not in verbose:
            problems.append(f'"{fact}" is not reported')
    mesaflash(device, '--wpo=0x0200=0xA0000000')
    if 'A0000000' not in mesaflash(device, '--rpo=0x0200'):
        problems.append('a register does not read what was written')
    return [f'{name}: {problem}' for problem in problems]


def check_remotes():
    """The differences in the report about the smart serial cards."""
    report = mesaflash(DEVICES['7i80'], '--sserial')
    parts = re.split(r'sserial device at channel (\d)', report)
    found = {int(channel): text for channel, text in zip(parts[1::2], parts[2::2])}
    problems = []
    for channel, (card, mode) in REMOTE_FACTS.items():
        for fact in (card, mode, 'NVBaudRate = 2.5Mb', 'NVWatchDogTimeout = 50ms', 'SwRevision = 14'):
            if fact not in found.get(channel, ''):
                problems.append(f'smart serial channel {channel}: "{fact}" is not reported')
    return problems


def main():
    program, models = sys.argv[1], pathlib.Path(sys.argv[2])
    if shutil.which('mesaflash') is None:
        print('skipped: mesaflash is not installed (apt-get install mesaflash)')
        return SKIPPED
    problems = []
    for name, device in DEVICES.items():
        with subprocess.Popen([program, '--listen', ADDRESS, '--model', name], stdout=subprocess.PIPE, text=True) as board:
            board.stdout.readline()
            problems += check(name, device, (models / f'{name}.txt').read_text())
            board.terminate()
    with tempfile.NamedTemporaryFile('w', suffix='.txt') as physics:
        physics.write(REMOTES)
        physics.flush()
        with subprocess.Popen([program, '--listen', ADDRESS, '--model', '7i80', '--physics', physics.name], stdout=subprocess.PIPE, text=True) as board:
            board.stdout.readline()
            problems += check_remotes()
            board.terminate()
    print('\n'.join(problems) or f'{len(DEVICES)} boards and 4 smart serial channels are reported as their models declare them')
    return 1 if problems else 0


if __name__ == '__main__':
    sys.exit(main())
