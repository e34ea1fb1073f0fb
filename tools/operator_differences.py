# SPDX-License-Identifier: GPL-2.0-or-later
"""Where an operator sees something else on this build than on LinuxCNC 2.9, and why. For compare_operator.py.

Lists are compared element by element, with the indices of linuxcnc.stat: 'gcodes[1]' is the motion mode. A difference that has
a reason keeps it for as long as both systems show these two values: what an act has set stays until another act changes it.
"""
import json

MODES = {'F', 'S', 'P', 'units', *(f'gcodes[{i}]' for i in range(1, 17)), *(f'mcodes[{i}]' for i in range(1, 10))}
MANUAL, AUTO, MDI = 1, 2, 3
IDLE = 1


def is_stop(act):
    return act[0] in ('stop', 'pause')


# (row of the page, fields, when(act, ours, theirs)): why they may differ.
INTENDED = [
    ('spindle that was stopped and is given a speed', {'spindles[0]', 'spindles[1]'},
     lambda act, a, b: all(x['on'] == y['on'] and (x == y or not x['on']) for x, y in zip(a['spindles'], b['spindles']))),
    ('modal codes of M48 to M51', {'mcodes[6]'}, lambda act, a, b: True),
    ('`stat.mcodes[2]` while a program runs', {'mcodes[2]'}, lambda act, a, b: is_stop(act) or b['interp'] != IDLE),
    ('a stop inside of a subroutine', MODES | {'motion_line'}, lambda act, a, b: act[:2] == ['stop', 'insub']),
    ('modes of a program that is stopped by off or an emergency stop, or that fails', MODES | {'motion_line'},
     lambda act, a, b: (act[0] == 'stop' and act[2] in ('off', 'estop')) or act == ['run', 'bad']),
    ('parameters, G10 and G92 of blocks that were read ahead when a program is stopped',
     {'read_line', *(f'{name}[{i}]' for name in ('g5x_offset', 'g92', 'tool_offset') for i in range(4))}, lambda act, a, b: is_stop(act)),
    ('`stat.queue`, `read_line` of a program that is paused', {'queue', 'read_line'}, lambda act, a, b: is_stop(act)),
    ('`stat.motion_line` in MDI and after it', {'motion_line'}, lambda act, a, b: a['mode'] != AUTO or act[0] == 'after'),
    ('`stat.interpreter_errcode`', {'error_code'}, lambda act, a, b: a['error_code'] == 0),
    ('pause while nothing runs', {'interp', 'rcs', 'ret', 'paused', 'task_paused', 'exec'},
     lambda act, a, b: a['interp'] == IDLE and not a['paused'] and (act[0] in ('pause_now', 'resume') or b['task_paused'])),
    ('M62, M63, M67 without a move behind them', {'analog', 'digital[0]', 'digital[1]'},
     lambda act, a, b: act[0] == 'mdi' and act[1].split()[0] in ('M62', 'M63', 'M67')),
    ('G96 while a spindle runs that the operator started', {'spindles[0]', 'spindles[1]'},
     lambda act, a, b: 960 in a['gcodes'] and 960 in b['gcodes']),
    ('`stat.program_units` of a program that is paused or stopped', {'units'}, lambda act, a, b: is_stop(act)),
    ('state of the last command after a program that failed', {'rcs', 'ret'},
     lambda act, a, b: act[0] == 'run' and a['error_code'] == b['error_code'] == 5),
    ('F after M2 and M30 in MDI', {'F'}, lambda act, a, b: act in (['mdi', 'M2'], ['mdi', 'M30'])),
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


def has_error(messages):
    """Texts and displays (kinds 2, 3, 12, 13) are left out: what is reported beside errors differs."""
    kinds = [m[0] if isinstance(m, list) else m for m in messages]
    return any(kind in (1, 11) for kind in kinds)


def fields_of(shown):
    """Field to value, elements of lists by themselves."""
    found = {}
    for name, value in shown.items():
        if not isinstance(value, list) or name == 'position':
            found[name] = value
            continue
        first = 1 if name in ('gcodes', 'mcodes') else 0  # the status has the line there
        found.update({f'{name}[{first + i}]': element for i, element in enumerate(value)})
    return found


def unexplained(ours, theirs):
    """(act, field, ours, theirs) without a reason, each once for as long as it lasts."""
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
            x.update({'ret': a['ret'], 'error messages': has_error(a['messages'])})
            y.update({'ret': b['ret'], 'error messages': has_error(b['messages'])})
        now = {field: json.dumps([x.get(field), y.get(field)]) for field in x.keys() | y.keys() if x.get(field) != y.get(field)}
        for field in sorted(now):
            if known.get(field) != now[field] and reason(act, a['shown'], b['shown'], field) is None:
                found.append((f"{a['seed']}.{a['n']} {' '.join(map(str, act))}", field, x.get(field), y.get(field)))
        known = now
    if len(ours) != len(theirs):
        found.append(('the end', 'rows', len(ours), len(theirs)))
    return found
