# SPDX-License-Identifier: GPL-2.0-or-later
"""Intended differences for operators between this build and LinuxCNC 2.9, with reasons, for compare_operator.py.

Lists are compared element by element, with the indices of linuxcnc.stat: 'gcodes[1]' is the motion mode. A difference with a
reason keeps it while both systems report the same two values, because a value set by an act stays until another act changes it.
"""
import json

MODES = {'F', 'S', 'P', 'units', *(f'gcodes[{i}]' for i in range(1, 17)), *(f'mcodes[{i}]' for i in range(1, 10))}
AUTO = 2
IDLE = 1
FAILED = 5
RUNNING, ERROR = 2, 3
SPINDLES = {'spindles[0]', 'spindles[1]'}
SETTINGS = ('feed', 'rapid', 'spindle_override', 'block_delete', 'optional_stop', 'pause_now', 'flood', 'mist')


def is_stop(act):
    return act[0] in ('stop', 'pause')


def has_failed(act, a, b):
    """A program that failed on both."""
    return act[0] in ('run', 'step', 'stop', 'pause') and a['error_code'] == b['error_code'] == FAILED


# (row of the page, fields, when(act, ours, theirs)): the reason for a permitted difference.
INTENDED = [
    ('spindle that was stopped and is given a speed', SPINDLES,
     lambda act, a, b: all(x['on'] == y['on'] and (x == y or not x['on']) for x, y in zip(a['spindles'], b['spindles']))),
    ('modal codes of M48 to M51', {'mcodes[6]'}, lambda act, a, b: True),
    ('`stat.mcodes[2]` while a program runs', {'mcodes[2]'}, lambda act, a, b: is_stop(act) or b['interp'] != IDLE),
    ('`stat.mcodes[2]` after S0', {'mcodes[2]'}, lambda act, a, b: act[0] == 'mdi' and (a['mcodes'][1], b['mcodes'][1]) in ((3, 5), (4, 5))),
    ('`stat.pocket_prepped` after M61 of the prepared tool', {'prepared'},
     lambda act, a, b: act[0] == 'mdi' and act[1].startswith('M61') and a['prepared'] == 0 and b['prepared'] > 0),
    ('the block that is executed is M0', {'mcodes[1]'}, lambda act, a, b: a['paused'] and a['mcodes'][0] in (0, 1)),
    ('G43 is active, also with an offset of 0', {'gcodes[9]'}, lambda act, a, b: a['gcodes'][8] == 430 and not any(a['tool_offset'])),
    ('a stop inside of a subroutine', MODES | {'motion_line'}, lambda act, a, b: act[:2] == ['stop', 'insub']),
    ('modes of a program that is stopped by off or an emergency stop, or that fails', MODES | {'motion_line'},
     lambda act, a, b: act[0] == 'state' or (act[0] == 'stop' and act[2] in ('off', 'estop')) or has_failed(act, a, b)),
    ('spindle and coolant after a program that failed', SPINDLES | {'flood', 'mist'}, has_failed),
    ('a rejected or failed block', MODES, lambda act, a, b: act[0] == 'mdi' and a['rcs'] == b['rcs'] == ERROR),
    ('parameters, G10 and G92 of blocks that were read ahead when a program is stopped',
     {'read_line', *(f'{name}[{i}]' for name in ('g5x_offset', 'g92', 'tool_offset') for i in range(4))}, lambda act, a, b: is_stop(act)),
    ('`stat.queue`, `read_line` of a program that is paused', {'queue', 'read_line'}, lambda act, a, b: is_stop(act) or a['interp'] != IDLE),
    ('`stat.motion_line` in MDI and after it', {'motion_line'}, lambda act, a, b: a['mode'] != AUTO or act[0] == 'after'),
    ('`stat.motion_line` of a move of length 0', {'motion_line'}, lambda act, a, b: act[0] == 'run' and (b['motion_line'] == 0 or (act[1], a['motion_line'], b['motion_line']) == ('loop', 6, 3))),
    ('F under G95 where the units change', {'F'}, lambda act, a, b: 950 in a['gcodes'] and (act[0] != 'mdi' or act[1] in ('G20', 'G21'))),
    ('F under G93', {'F'}, lambda act, a, b: 930 in a['gcodes']),
    ('`stat.interpreter_errcode`', {'error_code'}, lambda act, a, b: a['error_code'] == 0),
    ('interpreter_errcode after a move outside of the limits', {'error_code'}, lambda act, a, b: act == ['mdi', 'G1 X1000']),
    ('pause while nothing runs', MODES | {'interp', 'rcs', 'ret', 'paused', 'task_paused', 'exec', 'mode', 'error messages', 'error_code'},
     lambda act, a, b: a['interp'] == IDLE and not a['paused'] and (act[0] in ('pause_now', 'resume') or b['task_paused'])),
    ('M62, M63, M67 without a move behind them', {'analog', 'digital[0]', 'digital[1]'},
     lambda act, a, b: act[0] == 'mdi' and act[1].split()[0] in ('M62', 'M63', 'M67') or act[:2] in (['run', 'out'], ['step', 'out'])),
    ('`stat.program_units` of a program that is paused or stopped', {'units'}, lambda act, a, b: is_stop(act)),
    ('state of the last command after a program that failed', {'rcs', 'ret'}, has_failed),
    ('abort while nothing runs', MODES | {'g5x', 'g92[0]'}, lambda act, a, b: act[0] in ('abort', 'after') and a['interp'] == b['interp'] == IDLE),
    ('a mode that is rejected while a program is paused', {'rcs', 'ret'}, lambda act, a, b: act[0] == 'mode' and a['paused'] and a['rcs'] == ERROR),
    ('G96 after the next line of MDI', {'gcodes[13]'}, lambda act, a, b: (a['gcodes'][12], b['gcodes'][12]) == (960, 970)),
    ('spindle override after a program that begins while M49 is active', SPINDLES,
     lambda act, a, b: all({**x, 'override_on': y['override_on']} == y for x, y in zip(a['spindles'], b['spindles']))),
    ('`stat.exec_state` while the end of a program or a tool change waits for moves', {'exec'}, lambda act, a, b: {a['exec'], b['exec']} == {3, 7}),
    ('S in MDI while a spindle runs that the operator started', SPINDLES, lambda act, a, b: act == ['mdi', 'S600'] and a['spindles'][0]['on']),
    ('`wait_complete()` of a setting while a program runs or is paused', {'ret'},
     lambda act, a, b: a['interp'] != IDLE and act[0] in SETTINGS and b['rcs'] == RUNNING),
]


def reason(act, ours, theirs, field):
    for text, fields, when in INTENDED:
        if field in fields and when(act, ours, theirs):
            return text
    return None


def as_newer(shown):
    """Codes that 2.9 shows as 0 or 922 and LinuxCNC's newer version as -1."""
    shown['mcodes'][8] = shown['mcodes'][8] or -1
    shown['gcodes'][15] = -1 if shown['gcodes'][15] == 922 else shown['gcodes'][15]


def errors_of(messages):
    """Texts of the errors. Texts and displays (kinds 2, 3, 12, 13) are omitted, because other reports differ."""
    return [text for kind, text in messages if kind in (1, 11)]


def fields_of(shown):
    """Field to value, with separate entries for the elements of lists."""
    found = {}
    for name, value in shown.items():
        if not isinstance(value, list) or name == 'position':
            found[name] = value
            continue
        first = 1 if name in ('gcodes', 'mcodes') else 0  # the status has the line there
        found.update({f'{name}[{first + i}]': element for i, element in enumerate(value)})
    return found


def unexplained(ours, theirs):
    """(act, field, ours, theirs) without a reason, once for each continuous difference."""
    found, known, seed = [], {}, None
    for a, b in zip(ours, theirs):
        act = a['act']
        if (a['seed'], a['n'], act) != (b['seed'], b['n'], b['act']):
            found.append((act, 'order of the rows', a['n'], b['n']))
            break
        as_newer(b['shown'])
        if a['seed'] != seed:
            seed, known = a['seed'], {}
        x, y = fields_of(a['shown']), fields_of(b['shown'])
        if is_stop(act):
            x.pop('position'), y.pop('position')
        elif not act[0].startswith(('halui', 'rsh')):
            x.update({'ret': a['ret'], 'error messages': bool(errors_of(a['messages']))})
            y.update({'ret': b['ret'], 'error messages': bool(errors_of(b['messages']))})
        now = {field: json.dumps([x.get(field), y.get(field)]) for field in x.keys() | y.keys() if x.get(field) != y.get(field)}
        for field in sorted(now):
            if known.get(field) != now[field] and reason(act, a['shown'], b['shown'], field) is None:
                shown = (errors_of(a['messages']), errors_of(b['messages'])) if field == 'error messages' else (x.get(field), y.get(field))
                found.append((f"{a['seed']}.{a['n']} {' '.join(map(str, act))}", field, *shown))
        known = now
    if len(ours) != len(theirs):
        found.append(('the end', 'rows', len(ours), len(theirs)))
    return found
