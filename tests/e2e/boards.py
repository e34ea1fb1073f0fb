#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""millwright boards at a simulated board: pins, firmware as a file, and a configuration tested against that file.
usage: boards.py MILLWRIGHT HM2_BOARD SOURCE_FOLDER"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

millwright, hm2_board, source = sys.argv[1:4]


def run(*words, env=None):
    return subprocess.run([millwright, *words], capture_output=True, text=True, timeout=60, env=env)


def check(condition, what):
    if not condition:
        sys.exit(f'FAILED: {what}')


def start_board(model):
    """The process and its address. If another process uses the port, another port is tried."""
    for port in range(27300, 27400):
        process = subprocess.Popen([hm2_board, '--listen', f'127.0.0.1:{port}', '--model', model], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if process.stdout.readline().startswith('hm2-board: '):
            return process, f'127.0.0.1:{port}'
        process.wait()
    sys.exit('FAILED: no free port')


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    firmware = folder / 'board.txt'
    board, address = start_board('7i76e')
    try:
        found = run('boards', address, '--pins', '--save', str(firmware))
        check(found.returncode == 0, found.stderr)
        lines = found.stdout.splitlines()
        check('7I76E-16, hm2_7i76e in HAL' in lines[0], lines[0])
        check(any(line.split() == ['on', 'card', 'gpio.001', 'step', 'generator', '0:', 'step'] for line in lines), 'a pin of the card itself')
        check(any(line.split() == ['P1', 'pin', '14', 'gpio.018'] for line in lines), 'a pin of a connector')
    finally:
        board.terminate()
        board.wait()
    silent = run('boards', address)
    check(silent.returncode == 1 and address in silent.stderr, 'a board that does not answer is an error with its address')

    # The configuration of a shop, on a computer without the board.
    shutil.copytree(pathlib.Path(source) / 'configs/mesa', folder / 'mesa')
    hal = folder / 'mesa/board.hal'
    hal.write_text(hal.read_text().replace(' virtual_board=[HOSTMOT2](BOARD):[HOSTMOT2](MOTORS)', ''))
    ini = folder / 'mesa/7i76e.ini'
    env = dict(os.environ, MILLWRIGHT_MESA=f'127.0.0.1={firmware}:7i76e_motors.txt')
    words = ('doctor', str(ini), '--latency', '0', '--no-system')
    good = run(*words, env=env)
    check(good.returncode == 0 and 'errors: 0,' in good.stderr, good.stdout + good.stderr)
    unknown = run(*words)
    check(unknown.returncode == 1 and 'MILLWRIGHT_MESA=127.0.0.1=7i76e' in unknown.stdout + unknown.stderr, 'how to name the model')
    ini.write_text(ini.read_text().replace('num_stepgens=3', 'num_stepgens=9'))
    wrong = run(*words, env=env)
    check(wrong.returncode == 1 and 'num_stepgens=9, but this firmware has 5' in wrong.stdout, wrong.stdout + wrong.stderr)
    check('errors: 1,' in wrong.stderr, 'pins that are missing because of it are not separate errors: ' + wrong.stdout)
print('ok')
