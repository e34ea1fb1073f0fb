# SPDX-License-Identifier: GPL-2.0-or-later
"""Faults that are inserted into a run on purpose, and the expected reports of the judges. A judge that does not report its fault is a fault of the campaign."""
import copy
import pathlib
import signal
import subprocess

import judges

# {fault: the beginning of the judge's sentence}
RECORD_FAULTS = {
    'off_path': 'path: ',
    'stops_late': 'stop: ',
    'no_message': 'message: the machine stopped',
    'one_screen': 'message: the web screen lacks',
    'late_abort': 'abort: answered',
    'no_abort': 'abort: no answer',
    'runs_on': 'abort: the axes move',
}
FILE_FAULTS = {
    'cut_parameters': 'file: mill_mm.var',
    'cut_tools': 'file: mill_mm.tbl',
    'no_tools': 'file: mill_mm.tbl',
    'changed_ini': 'file: mill_mm.ini',
}
END_FAULTS = {
    'dead_server': 'process: the server rsh',
    'late_end': 'end: SIGTERM',
    'left_file': 'left: nc/.part.ngc.millwright-',
    'left_temporary': 'left: tmp/',
    'left_memory': 'left: /dev/shm/',
    'left_process': 'left: process sleep',
}
FAULTS = {**RECORD_FAULTS, **FILE_FAULTS, **END_FAULTS}


def of_record(record):
    """{fault: the reports of the judges about this record with the fault}"""
    found = {'sound': judges.of_run(record)}
    for fault in RECORD_FAULTS:
        spoiled = copy.deepcopy(record)
        spoil_record(fault, spoiled)
        found[fault] = judges.of_run(spoiled)
    return found


def of_files(session):
    found = {}
    paths = [session.parameters, session.tools, session.machine.ini]
    for fault in FILE_FAULTS:
        kept = {path: path.read_bytes() for path in paths}
        spoil_files(fault, session.machine, session.parameters)
        found[fault] = []
        session.check_files(found[fault])
        for path, content in kept.items():
            path.write_bytes(content)
    session.isWhole = True
    return found


def spoil_record(fault, record):
    """The record of a machine with this fault."""
    if fault == 'off_path':
        when, x, y, z, enabled = record.samples[len(record.samples) // 2]
        record.samples[len(record.samples) // 2] = (when, x, y + 0.05, z + 0.05, enabled)
    elif fault in ('stops_late', 'no_message'):
        stopped = next(sample for sample in record.samples if sample[0] > record.begin + 0.05)
        record.samples = [sample if sample[0] <= stopped[0] else (sample[0], *stopped[1:]) for sample in record.samples]
        record.abort = None
    elif fault == 'one_screen':
        record.python.insert(0, (record.begin, 'Only Python shows this.'))
        record.python.append((record.begin + 60, 'later'))
    elif fault == 'late_abort':
        record.abort['answered'] = record.abort['sent'] + 0.15
    elif fault == 'no_abort':
        record.abort['result'] = 'none'
    elif fault == 'runs_on':
        when, x, y, z, enabled = record.samples[-1]
        record.samples += [(record.abort['answered'] + 1, x + 1e-4, y, z, enabled)]


def spoil_files(fault, machine, parameters):
    if fault == 'cut_parameters':
        parameters.write_text(parameters.read_text()[:200] if parameters.exists() else '51')
    elif fault == 'cut_tools':
        tools = parameters.with_suffix('.tbl')
        tools.write_text(tools.read_text()[:40])
    elif fault == 'no_tools':
        parameters.with_suffix('.tbl').unlink()
    elif fault == 'changed_ini':
        machine.ini.write_text(machine.ini.read_text() + '\n')


def spoil_end(machine):
    """Called before SIGTERM."""
    machine.servers['nml'].send_signal(signal.SIGSTOP)
    (machine.nc / '.part.ngc.millwright-0123456789').write_text('G0')
    (machine.temporary / 'abc').write_text('')
    pathlib.Path(f'/dev/shm/millwright-{machine.instance}').write_text('')
    subprocess.Popen(['sleep', '20'], env=machine.env)
