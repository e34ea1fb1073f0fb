# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines in the program that the machine cuts. `run` of these attacks is called before the program is written and returns the lines."""
from attack_types import attack


@attack('program.operators', causes=r'operators|too long|characters')
def operators(_scene, rng):
    return '#1=[' + '1+' * rng.choice((1500, 20_000, 60_000)) + '1]\n'


@attack('program.brackets', causes=r'bracket|nested|too long|characters')
def brackets(_scene, rng):
    depth = rng.choice((200, 5000, 50_000))
    return rng.choice(('#1=' + '[' * depth + '1' + ']' * depth + '\n', '#1=' + 'sin[' * depth + '1' + ']' * depth + '\n', '#' * depth + '1=2\n'))


@attack('program.call_pipe', causes=r'not a file|no subroutine')
def call_pipe(_scene, _rng):
    return 'o<pipe> call\n'


@attack('program.log_pipe', causes=r'not a file')
def log_pipe(scene, rng):
    return f'({rng.choice(("LOGOPEN,", "LOGAPPEND,", "PROBEOPEN "))}{rng.choice((scene.nc / "pipe.ngc", "/dev/ptmx", scene.nc, "/dev/zero"))})\n'


@attack('program.python', causes=r'TOPLEVEL|Python')
def python(_scene, rng):
    return rng.choice((';py,import time; time.sleep(6)\n', ';py,import os; os._exit(0)\n', ';py,while True: pass\n'))


@attack('program.slip', causes=r'limit|Radius')
def slip(_scene, rng):
    return rng.choice(('G1 X1000000000000000\n', 'G1 Z-5000\n', 'G2 X9000 Y0 I4500\n'))


@attack('program.rubbish', causes=r'cut\.ngc')
def rubbish(_scene, rng):
    return rng.choice(('G1 X\n', 'G999\n', 'o5 endif\n', 'G1 X1 X2\n', '\x01\x02\x03 Q\n', 'M4711\n', 'o<nothing> call\n', '#<_x>=#<_none>\n', 'G' * 300 + '\n'))


@attack('program.messages', causes=r'part x')
def messages(_scene, rng):
    """Messages faster than any client can read; the axes may wait until the last message."""
    return f'o9 repeat [{rng.choice((100, 2000))}]\n(MSG, part {"x" * rng.choice((1, 200))})\n(DEBUG, #5420)\no9 endrepeat\n'


@attack('program.comments')
def comments(_scene, rng):
    """Few enough comments to be read quickly, because the axes wait for the next lines."""
    return ('(' + 'c' * 200 + ')\n') * rng.choice((100, 1000)) if rng.random() < 0.5 else ';' + 'x' * rng.choice((100, 240)) + '\n'
