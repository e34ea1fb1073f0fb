#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`millwright commission write` opens a machine again: edits are kept, or shown as conflicts (A7). usage: rewritten_machine.py
MILLWRIGHT"""
import pathlib
import subprocess
import sys
import tempfile

millwright = pathlib.Path(sys.argv[1]).resolve()
failures = 0


def expect(condition, what, more=''):
    global failures
    if not condition:
        failures += 1
        print(f'FAIL {what}\n{more}')


def commission(*words):
    return subprocess.run([millwright, 'commission', *map(str, words)], capture_output=True, text=True, check=False, timeout=60)


def doctor(folder):
    return subprocess.run([millwright, 'doctor', folder / 'machine.ini', '--strict', '--no-system', '--latency', '0'],
                          capture_output=True, text=True, check=False, timeout=60)


with tempfile.TemporaryDirectory() as place:
    folder = pathlib.Path(place) / 'mill'
    done = commission('write', folder, 'kind=mill', 'drives=stepper', 'board=7i76e', 'switches=home')
    expect(done.returncode == 0 and (folder / 'machine.ini').is_file(), 'a new machine', done.stderr)
    again = commission('write', folder)
    expect(again.returncode == 0 and again.stdout == '', 'the same answers change nothing', again.stdout + again.stderr)

    ini, coolant = folder / 'machine.ini', folder / 'coolant.hal'
    ini.write_text(ini.read_text().replace('MAX_FEED_OVERRIDE = 1.2', 'MAX_FEED_OVERRIDE = 1.5'))
    coolant.write_text(coolant.read_text().replace('# Coolant.\n', '# Coolant.\n# Mine: the chip blower.\nnet blower motion.digital-out-00\n'))
    done = commission('write', folder, 'x.max=250', 'pin.mist=1')
    expect(done.returncode == 0 and 'machine.ini: changed' in done.stdout and 'coolant.hal' in done.stdout, 'other answers', done.stdout + done.stderr)
    text = ini.read_text()
    expect('MAX_FEED_OVERRIDE = 1.5' in text and text.count('MAX_LIMIT = 250') == 2, 'edit and answer in the INI file', text)
    text = coolant.read_text()
    expect('net blower' in text and 'net mist' in text, 'an added line survives', text)

    ini.write_text(ini.read_text().replace('MAX_LIMIT = 250', 'MAX_LIMIT = 249'))
    before = {path: path.read_bytes() for path in folder.rglob('*') if path.is_file()}
    done = commission('write', folder, 'x.max=200')
    expect(done.returncode == 1 and 'edited:    MAX_LIMIT = 249' in done.stdout and 'new:       MAX_LIMIT = 200' in done.stdout
           and 'generated: MAX_LIMIT = 250' in done.stdout, 'a conflict is shown with its three versions', done.stdout + done.stderr)
    expect(before == {path: path.read_bytes() for path in folder.rglob('*') if path.is_file()}, 'and nothing is written')
    done = commission('write', folder, 'x.max=200', '--keep')
    expect(done.returncode == 0 and ini.read_text().count('MAX_LIMIT = 249') == 2, 'kept', done.stdout + done.stderr)
    done = commission('write', folder, 'x.max=180', '--replace')
    expect(done.returncode == 0 and ini.read_text().count('MAX_LIMIT = 180') == 2, 'replaced', done.stdout + done.stderr)

    (folder / 'coolant.hal').unlink()
    done = commission('write', folder, 'pin.flood=-1', 'pin.mist=-1')
    expect(done.returncode == 0 and 'HALFILE = coolant.hal' not in ini.read_text(), 'no coolant, no file', done.stdout + done.stderr)
    done = commission('write', folder, 'board=parport', 'switches=none', 'pin.flood=0', 'pin.mist=0')
    expect(done.returncode == 0 and not (folder / 'simulated_board.hal').exists() and not (folder / 'switches.hal').exists()
           and (folder / 'simulated_wires.hal').is_file(), 'another board', done.stdout + done.stderr)
    found = doctor(folder)
    expect(found.returncode == 0, 'doctor --strict', found.stdout + found.stderr)

    done = commission('describe', folder)
    expect(done.returncode == 0 and 'x.max = 180' in done.stdout and 'is the preset. ' in done.stdout, 'describe', done.stdout + done.stderr)
    done = commission('write', folder, 'x.max=1')
    expect(done.returncode == 1 and 'x.max: the travel is 1' in done.stderr, 'an answer that is not valid', done.stderr)
    done = commission('write', pathlib.Path(place) / 'mill', 'x.maxx=1')
    expect(done.returncode == 1 and 'did you mean x.max?' in done.stderr, 'an unknown key', done.stderr)
    expect(commission().returncode == 2 and commission('writ', 'x').returncode == 2 and commission('write').returncode == 2, 'wrong usage')
print(f'{failures} failed')
sys.exit(1 if failures else 0)
