#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The disk of the configuration does not respond while a program uses a file on it: an abort is answered, and the machine stays
on.

usage: disks.py BIN_FOLDER ROOT [NAME]
"""
import contextlib
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import ABORT_S, END_S, run_attacks  # noqa: E402  pylint: disable=wrong-import-position

LIBRARY = os.environ.get('HUNG_DISK_LIBRARY')
REPORTED_S = 3  # the operator reads a message after 1 s, or later on a busy computer


def prepare(machine):
    """The programs of the machine are run with hung_disk.c; M101 creates a file as its mark."""
    library = LIBRARY or machine.programs.parent / 'test/libhung_disk.so'
    machine.env.update(LD_PRELOAD=str(library), HUNG_DISK=str(machine.folder / 'hung'))
    code = machine.folder / 'nc_files/M101'
    code.parent.mkdir(exist_ok=True)
    code.write_text(f'#!/bin/sh\necho done >> {machine.folder}/marks\n')
    code.chmod(0o755)


@contextlib.contextmanager
def hung(machine, name):
    """Calls on files with this text in their path do not return."""
    control = machine.folder / 'hung'
    new = machine.folder / 'hung.new'
    new.write_text(name)
    new.rename(control)
    try:
        yield
    finally:
        control.unlink()


def is_reported(machine, name):
    return machine.until(lambda: any(name in text and '1 s' in text for text in machine.messages), REPORTED_S)


def stays_on_and_stops(machine, found, name):
    """While the disk does not respond, there is a message, no stop by a watchdog, and an abort in time."""
    found.expect(is_reported(machine, name), f'a message names {name}', *machine.messages)
    machine.until(lambda: False, 0.5)
    found.expect(machine.stat.task_state == machine.linuxcnc.STATE_ON, 'the machine stays on', *machine.messages)
    took = machine.abort_s()
    found.expect(took < ABORT_S, f'an abort is answered in {took:.3f} s')
    found.expect(machine.until(lambda: machine.stat.interp_state == machine.linuxcnc.INTERP_IDLE, 1), 'the program has ended')


def table_written(machine, found):
    """G10 L1 repeatedly: the machine continues to cut, and the last change is in the file when the disk responds again."""
    table = machine.ini.with_name('mill_mm.tbl')
    with hung(machine, 'mill_mm.tbl'):
        machine.cut('G21 G90 G61 F1200\n#1=1\no1 repeat [2000]\nG1 X5\nG10 L1 P1 Z[#1]\n#1=[#1+1]\nG1 X0\no1 endrepeat\nM2\n')
        found.expect(is_reported(machine, 'mill_mm.tbl'), 'a message names the file', *machine.messages)
        before = machine.stat.tool_table[1].zoffset
        found.expect(machine.cuts_on(2), 'the machine cuts on', *machine.messages)
        found.expect(machine.stat.tool_table[1].zoffset > before, 'changes are active')
        stays_on_and_stops(machine, found, 'mill_mm.tbl')
        last = machine.stat.tool_table[1].zoffset
    written = machine.until(lambda: f'Z{last:g}' in table.read_text().split('T2')[0].replace('+', ''), 3)
    found.expect(written, f'the last change Z{last:g} is in the file', table.read_text())
    found.expect(machine.run('G21\nG10 L1 P1 Z77\nM2\n') and 'Z77' in table.read_text().replace('+', ''), 'the file is written when a program has ended')


def table_read(machine, found):
    """G10 L0."""
    with hung(machine, 'mill_mm.tbl'):
        machine.open(machine.write('read.ngc', 'G21 G90 G61 F1200\nG1 X5\nG10 L0\nG1 X0\nM2\n'))
        machine.command.auto(machine.linuxcnc.AUTO_RUN, 1)
        stays_on_and_stops(machine, found, 'mill_mm.tbl')
    is_read = machine.run('G10 L0\nM2\n')
    others = [text for text in machine.messages if not text.startswith('journal: the disk was slow')]
    found.expect(is_read and not others, 'the table is read when the disk answers', *others)


def user_code(machine, found):
    """The look-up of M101 and its start."""
    marks = machine.folder / 'marks'
    found.expect(machine.run('M101\nM2\n') and marks.read_text() == 'done\n', 'M101 runs', *machine.messages)
    machine.open(machine.write('code.ngc', 'G21 G90 G61 F1200\nG1 X5\nM101\nG1 X0\nM2\n'))
    machine.command.auto(machine.linuxcnc.AUTO_RUN, 1)
    assert machine.until(lambda: machine.stat.current_vel > 0, 5), machine.messages  # M101 has been read
    with hung(machine, 'M101'):
        stays_on_and_stops(machine, found, 'M101')
    machine.until(lambda: False, 0.3)
    found.expect(marks.read_text() == 'done\n', 'it is not run after the abort', marks.read_text())
    found.expect(machine.run('M101\nM2\n') and marks.read_text() == 'done\n' * 2, 'M101 runs when the disk answers', *machine.messages)


def end(machine, found):
    """SIGTERM ends the machine and reports the files that were not written."""
    with hung(machine, 'mill_mm.'):
        assert machine.run('G21\nG10 L1 P1 Z33\nG10 L2 P1 X2\nM2\n'), machine.messages
        took = machine.end_s()
        found.expect(took < END_S, f'SIGTERM ends it in {took:.1f} s', machine.text()[-300:])
        found.expect('mill_mm.tbl' in machine.text(), 'the end names what was not written', machine.text()[-300:])


if __name__ == '__main__':
    run_attacks(__file__, {'table_written': table_written, 'table_read': table_read, 'user_code': user_code, 'end': end}, prepare)
