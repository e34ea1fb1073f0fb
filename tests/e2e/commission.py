#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs `millwright commission check` and `report` with an operator who answers in lines (A7). usage: commission.py MILLWRIGHT"""
import pathlib
import re
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


def commission(*words, given=''):
    return subprocess.run([millwright, 'commission', *map(str, words)], capture_output=True, text=True, check=False, timeout=120, input=given)


def operate(folder, measured):
    """Answers each prompt when it appears. `measured`: factor of the true travel."""
    moved, prompts, lines = 0.0, [], []
    with subprocess.Popen([millwright, 'commission', 'check', folder, '--simulate', '--fast'], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, bufsize=1) as process:
        for line in process.stdout:
            lines.append(line)
            found = re.match(r'\[(\w+)\] (\w+): (.*)', line)
            if not found:
                continue
            step, ask, text = found.groups()
            prompts.append((step, ask))
            answer = None
            if ask == 'confirm':
                answer = 'confirm'
            elif ask == 'hold':
                distance = re.search(r'moves by ([\d.]+) ', text)
                moved = float(distance[1]) if distance else moved
                answer = 'hold 200'
            elif ask == 'number':
                answer = 'number 6000' if 'tachometer' in text else 'number 0' if 'indicator' in text else f'number {moved * measured(len(prompts)):.4f}'
            elif ask == 'choice':
                answer = 'choice positive'
            if answer is not None:
                process.stdin.write(answer + '\n')
                process.stdin.flush()
    return process.returncode, ''.join(lines)


with tempfile.TemporaryDirectory() as place:
    folder = pathlib.Path(place) / 'mill'
    done = commission('write', folder, 'kind=lathe', 'drives=stepper', 'board=7i76e', 'pin.estop=-1')
    expect(done.returncode == 0, 'written', done.stderr)

    done = commission('check', folder, '--simulate', '--fast', given='')
    expect(done.returncode == 1 and 'the input has ended' in done.stderr, 'a lost operator', done.stdout + done.stderr)

    status, output = operate(folder, lambda _: 1.0)
    expect(status == 0 and 'Direction of X: passed' in output and 'Spindle speed: passed' in output, 'all steps', output)
    before = (folder / 'machine.ini').read_text()
    expect('STEP_SCALE = 160' in before, 'a right scale is not changed', before)

    again = commission('check', folder, '--simulate', '--fast', given='')
    expect(again.returncode == 0 and 'Direction' not in again.stdout, 'steps that are done are not repeated', again.stdout + again.stderr)
    tuned = commission('tune', folder, '--simulate', '--fast', given='')
    expect(tuned.returncode == 0 and 'The machine is ready.' in tuned.stdout, 'nothing to tune in a stepper', tuned.stdout + tuned.stderr)

    report = commission('report', folder)
    expect(report.returncode == 0 and 'State: ready' in report.stdout and 'NOT READY' not in report.stdout, 'report', report.stdout)
    page = pathlib.Path(place) / 'report.html'
    done = commission('report', folder, '--html', page)
    text = page.read_text()
    expect(done.returncode == 0 and 'Signature' in text and text.count('<tr>') > 40 and 'My lathe' in text, 'a page for the printer', text[:500])

    commission('write', folder, 'board.simulated=no')
    report = commission('report', folder)
    expect('State: ready' not in report.stdout and 'NOT READY' in report.stdout, 'a simulated board says nothing about a real one', report.stdout)
    done = commission('check', folder, '--simulate', '--fast', given='')
    expect(done.returncode == 2 and 'practice values' in done.stderr, 'no practice with the files of a real machine', done.stderr)
    commission('write', folder, 'board.simulated=yes')

    changed = commission('write', folder, 'x.correction=1.5')
    expect(changed.returncode == 0, 'another scale', changed.stderr)
    report = commission('report', folder)
    expect('State: ready' not in report.stdout, 'a changed scale is not ready', report.stdout)

    lost = pathlib.Path(place) / 'simulated'
    commission('write', lost, 'kind=mill')
    done = commission('check', lost, '--simulate')
    expect(done.returncode == 1 and 'nothing to check' in done.stderr, 'no hardware', done.stderr)
    (folder / 'commissioning.json').write_text('{')
    done = commission('report', folder)
    expect(done.returncode == 1 and 'cannot be read' in done.stderr, 'a damaged record', done.stderr)

    root = pathlib.Path(place) / 'root'
    (root / 'sys/bus/pci/devices/0000:01:00.0').mkdir(parents=True)
    (root / 'sys/bus/pci/devices/0000:01:00.0/vendor').write_text('0x2718\n')
    (root / 'sys/bus/pci/devices/0000:01:00.0/device').write_text('0x6125\n')
    (root / 'sys/class/parport/parport0').mkdir(parents=True)
    done = commission('find', '127.0.0.9', '--root', root)
    expect(done.returncode == 0 and 'device 0x6125' in done.stdout and 'parport0' in done.stdout, 'find', done.stdout + done.stderr)
print(f'{failures} failed')
sys.exit(1 if failures else 0)
