#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Draws the figures of docs/developer/architecture.md: the layers (from the table of check_layers.py), the processes, and one
move.

usage: figures.py ROOT           writes docs/figures/*.svg (needs dot of graphviz)
       figures.py ROOT --check   exit status 1: a figure is older than its source, or its file does not contain a name in it
"""
import hashlib
import pathlib
import subprocess
import sys

import check_layers

STYLE = 'node [shape=box, style=rounded, fontname="Helvetica", fontsize=12]; edge [fontname="Helvetica", fontsize=10];'

# Steps of a move: function, file below src, effect on the move. The function's last word must be in the file.
MOVE = (
    ('gcode::Interpreter::step', 'gcode/interpreter/interpreter.cc', 'StraightFeed: program units'),
    ('gcode::MachineFrame', 'gcode/canon/machine_frame.hh', 'LineMove: machine units'),
    ('task::TaskCanon', 'machine/task/run/task_canon.hh', 'Item in the queue, with its line'),
    ('task::Sequencer', 'machine/task/sequencer/sequencer.hh', 'in order, when what it needs is there'),
    ('task::MotionLink', 'machine/task/link/motion_link.hh', 'PathCommand with id and epoch'),
    ('motion::PathPlanner', 'motion/planner/path_planner.hh', 'Primitive in the path, checked against the limits'),
    ('trajectory::Planner', 'trajectory/planner.hh', 'phases: position over time'),
    ('trajectory::Executor', 'trajectory/follow/executor.hh', 'pose of this cycle'),
    ('motion::Controller::step', 'motion/servo/controller.hh', 'joint positions with compensation'),
    ('joint.N.motor-pos-cmd', 'motion/hal/pin_tables.hh', 'HAL pin'),
)

# Processes: name, its contents, folders of src or of the tree that must exist.
PROCESSES = (
    ('start', 'millwright start: task\\ninterpreter, sequencer, I/O controller,\\nhalui, HAL files', ('src/machine/task', 'src/machine/assembly')),
    ('rt', 'millwright-rt: realtime\\nHAL threads, motion controller,\\nplanner, drivers', ('src/hal/host', 'src/motion/hal')),
    ('screen', 'millwright ui:\\nserver of the screen', ('src/clients/screen',)),
    ('python', 'Python screens and scripts\\n(linuxcnc, hal)', ('src/clients/python',)),
    ('others', 'linuxcncrsh, NML server, schedrmt', ('src/clients/rsh', 'src/clients/nml', 'src/clients/schedule')),
    ('halcmd', 'halcmd, userspace components', ('src/hal/tools',)),
)


def layers():
    """Permitted uses; an arrow that follows from others is omitted."""
    may = {room: {one.split('/')[0] for one in used if '/' not in one} for room, used in check_layers.MAY_USE.items() if room in check_layers.IN_SRC + ('programs', 'drivers')}
    lines = [f'"{room}";' for room in may]
    for room, used in may.items():
        indirect = set().union(*(may.get(one, set()) for one in used))
        lines += [f'"{room}" -> "{one}";' for one in sorted(used - indirect)]
    return 'digraph layers { rankdir=TB; ' + STYLE + '\n' + '\n'.join(lines) + '\n}\n'


def processes():
    lines = [f'{name} [label="{label}"];' for name, label, _ in PROCESSES]
    lines += ['start -> rt [dir=both, label="channels and HAL segment\\n(shared memory)"];']
    lines += [f'{name} -> start [dir=both, label="mailbox\\n(shared memory)"];' for name in ('screen', 'python', 'others')]
    lines += ['halcmd -> rt [dir=both, label="HAL segment"];', 'browser [label="browser", style="rounded,dashed"];',
              'browser -> screen [dir=both, label="WebSocket"];']
    return 'digraph processes { rankdir=TB; ' + STYLE + '\n' + '\n'.join(lines) + '\n}\n'


def one_move():
    lines = [f'm{at} [label="{name}\\nsrc/{file}"];' for at, (name, file, _) in enumerate(MOVE)]
    lines += [f'm{at} -> m{at + 1} [label="  {MOVE[at][2]}"];' for at in range(len(MOVE) - 1)]
    return 'digraph one_move { rankdir=TB; ranksep=0.3; ' + STYLE + '\n' + '\n'.join(lines) + '\n}\n'


FIGURES = {'layers': layers, 'processes': processes, 'one_move': one_move}


def wrong_names(root):
    for name, file, _ in MOVE:
        path, word = root / 'src' / file, name.split('::')[-1].split('.')[-1]
        if not path.is_file() or word not in path.read_text():
            yield f'one_move: {word} is not in src/{file}'
    for name, _, folders in PROCESSES:
        yield from (f'processes: {name}: there is no {folder}' for folder in folders if not (root / folder).is_dir())


def main():
    root = pathlib.Path(sys.argv[1])
    failures = list(wrong_names(root))
    for name, draw in FIGURES.items():
        source = draw()
        mark = f'<!-- source: {hashlib.sha256(source.encode()).hexdigest()} -->\n'
        path = root / 'docs' / 'figures' / f'{name}.svg'
        if '--check' not in sys.argv:
            svg = subprocess.run(['dot', '-Tsvg'], input=source, capture_output=True, text=True, check=True).stdout
            path.write_text(svg.rstrip() + '\n' + mark)
        elif not path.is_file() or mark not in path.read_text():
            failures.append(f'{path}: older than tools/figures.py or tools/check_layers.py; run tools/figures.py {sys.argv[1]}')
    print('\n'.join(failures + [f'{len(FIGURES)} figures, {len(failures)} findings']))
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
