#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks that includes point only to lower layers. usage: check_layers.py ROOT; exit status 1 lists the others."""
import pathlib
import re
import sys

# Each layer, and the layers or folders of a layer that it may use.
MAY_USE = {
    'base': (),
    'runtime': ('base',),
    'kinematics': ('base',),
    'trajectory': ('base',),
    'gcode': ('base', 'trajectory'),
    'messages': ('base', 'runtime'),
    'hal': ('base', 'runtime'),
    'motion': ('base', 'hal', 'kinematics', 'trajectory'),
    'machine': ('base', 'runtime', 'hal', 'kinematics', 'trajectory', 'gcode', 'messages', 'motion'),
    'clients': ('base', 'runtime', 'hal', 'gcode', 'messages', 'machine/setup', 'machine/config', 'machine/certificate', 'machine/tools'),
    'drivers': ('base', 'hal'),
    'programs': ('base', 'runtime', 'hal', 'kinematics', 'trajectory', 'gcode', 'messages', 'motion', 'machine', 'clients', 'drivers'),
    'components': ('base', 'hal', 'kinematics', 'trajectory', 'motion', 'machine/io'),
    'tests/support': ('base', 'hal', 'kinematics', 'trajectory', 'motion'),
}
# The order in which the folders of a layer may use each other. '' means files outside its folders.
ORDER = {
    'base': ('', 'diagnostics', 'geometry', 'language', 'options', 'ini', 'charts'),
    'messages': ('declarations', 'legacy', 'mailbox', 'client'),
    'hal': ('include', 'sdk', 'core', 'capi', 'host', 'ini', 'halcompile', 'script', 'tcl', 'tools'),
    'hal/tools': ('stream', 'view', 'programs'),
    'trajectory': ('path', 'curve', 'profile', 'follow', 'plan'),
    'gcode': ('syntax', 'tools', 'canon', 'interpreter', 'python_host', 'analysis'),
    'gcode/interpreter': ('expressions', 'scripts', 'codes', 'flow'),
    'motion': ('homing', 'interface', 'planner', 'servo', 'hal'),
    'machine': ('setup', 'commissioning', 'io', 'journal', 'task', 'config', 'certificate', 'tools', 'halui', 'assembly'),
    'machine/task': ('link', 'sequencer', 'states', 'run', 'control'),
    'clients': ('nml', 'rsh', 'schedule', 'tcl', 'offers', 'screen', 'publish', 'shop', 'python'),
    'clients/screen': ('http', 'access', 'server', 'facts', 'status', 'hal', 'path', 'files', 'session', 'setup', 'routes', 'assembly'),
    'clients/publish': ('', 'sparkplug', 'mtconnect', 'offers', 'assembly'),
    'clients/shop': ('', 'host', 'offers', 'store', 'notify', 'web', 'assembly'),
    'clients/nml': ('config', 'message', 'buffer', 'net', 'bridge', 'remote'),
    'drivers/mesa': ('lbp16', 'identity', 'hostmot2', 'ethernet', 'direct', 'board', 'virtual', 'hm2_eth', 'pci', 'epp', 'spi'),
    'programs': ('setup', 'run', 'remote', 'publish', 'shop', 'start', 'screen', 'doctor', 'commission', 'mains'),
}
# Uses that are forbidden for a folder although its layer permits them.
NEVER = {
    'motion/homing': ('hal', 'kinematics', 'trajectory'),
    'motion/interface': ('hal',),
    'motion/planner': ('hal',),
    'motion/servo': ('hal',),
    'machine/journal': ('hal', 'messages', 'motion', 'gcode'),
    'machine/setup': ('hal', 'messages', 'motion', 'gcode'),
    # Only the time estimate of programs plans their moves.
    **{f'gcode/{folder}': ('trajectory',) for folder in ('syntax', 'tools', 'canon', 'interpreter', 'python_host')},
    # Clients take part in a machine only by messages. The screen also reads the INI file and analyses programs for it.
    **{f'clients/{client}': ('machine',) for client in ('nml', 'rsh', 'schedule', 'tcl', 'python')},
    **{f'clients/screen/{folder}': ('machine', 'hal', 'messages/client') for folder in ('http', 'access', 'server')},
    **{f'clients/screen/{folder}': ('machine',) for folder in ('facts', 'status', 'hal', 'files', 'session', 'routes')},
    # An offer is a text, with which nothing can reach a machine.
    'clients/offers': ('runtime', 'hal', 'gcode', 'messages', 'machine'),
    'clients/publish/offers': ('hal', 'gcode', 'messages', 'machine'),
    # A publisher reads a machine and cannot command it.
    'clients/publish': ('hal', 'machine', 'messages/client/client.hh', 'messages/mailbox/command_server.hh', 'messages/declarations/command.hh'),
    'programs/publish': ('messages/client/client.hh', 'messages/declarations/command.hh', 'machine', 'motion'),
    'clients/shop': ('hal', 'messages', 'machine'),
    'programs/shop': ('hal', 'messages', 'machine', 'motion'),
    # Driver and simulated board are developed independently, so that each reveals the errors of the other.
    'drivers/mesa/board': ('hal', 'drivers/mesa/hostmot2', 'drivers/mesa/ethernet', 'drivers/mesa/direct', 'drivers/mesa/pci',
                           'drivers/mesa/epp', 'drivers/mesa/spi'),
    'drivers/mesa/hostmot2': ('drivers/mesa/lbp16', 'drivers/mesa/ethernet', 'drivers/mesa/board'),
    'drivers/mesa/ethernet': ('drivers/mesa/board',),
}
# Files that only one folder may use.
PRIVATE = {
    'hal/core/detail': 'hal/core',
}
IN_SRC = tuple(room for room in MAY_USE if room not in ('drivers', 'programs', 'components', 'tests/support'))
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def is_in(path, folder):
    return path == folder or path.startswith(folder + '/')


def room_of(path):
    return next((room for room in MAY_USE if is_in(path, room)), None)


def rank(path, room):
    """The position of a file in the order of its layer's folders; None if the order does not include it."""
    rest = path[len(room) + 1:].split('/')
    folder = rest[0] if len(rest) > 1 else ''
    order = ORDER[room]
    return order.index(folder) if folder in order else None


def problem_of_order(source, target):
    for room in ORDER:
        if is_in(source, room) and is_in(target, room):
            user, used = rank(source, room), rank(target, room)
            if user is not None and used is not None and used > user:
                return f'{room}/{ORDER[room][user]} may not use {room}/{ORDER[room][used]}'
    return None


def are_parts_mixed(source, target):
    """True if both are in parts (folders) of the motion controller, and in different ones; parts must not include each other."""
    parts = [path.split('/') for path in (source, target)]
    are_parts = all(len(part) > 3 and part[:2] == ['motion', 'servo'] for part in parts)
    return are_parts and parts[0][2] != parts[1][2]


def problem(source, target):
    """The reason why the file source must not include target (paths without src/); None if it may."""
    user, used = room_of(source), room_of(target)
    if user is None or used is None:
        return None
    for folder, owner in PRIVATE.items():
        if is_in(target, folder) and not is_in(source, owner):
            return f'only {owner} may use {folder}'
    for folder, others in NEVER.items():
        other = next((other for other in others if is_in(source, folder) and is_in(target, other)), None)
        if other:
            return f'{folder} may not use {other}'
    if user == used:
        return 'parts of the controller may not know each other' if are_parts_mixed(source, target) else problem_of_order(source, target)
    if not any(is_in(target, allowed) for allowed in MAY_USE[user]):
        return f'{user} may not use {used}'
    return None


def sources(folder):
    """Sources and headers of a folder, without those of tests and benchmarks."""
    for path in sorted(folder.rglob('*')):
        if path.suffix in ('.cc', '.hh', '.h', '.c') and not {'test', 'bench'} & set(path.parts):
            yield path


def main():
    top = pathlib.Path(sys.argv[1])
    failures = [f'src/{path.name} is no room' for path in sorted((top / 'src').iterdir()) if path.is_dir() and path.name not in IN_SRC]
    checked = 0
    for room in MAY_USE:
        for path in sources(top / 'src' / room if room in IN_SRC else top / room):
            checked += 1
            name = path.relative_to(top / 'src' if room in IN_SRC else top).as_posix()
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                target = match.group(1)
                is_rooted = not target.startswith(('.', '/', 'src/'))
                why = problem(name, target) if is_rooted else 'includes are rooted at src/ or at the top'
                if why:
                    failures.append(f'{path}:{number}: {target}: {why}')
    print('\n'.join(failures + [f'{checked} files checked, {len(failures)} wrong includes']))
    return 1 if failures or checked == 0 else 0


if __name__ == '__main__':
    sys.exit(main())
