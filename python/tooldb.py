# SPDX-License-Identifier: GPL-2.0-or-later
"""The other side of [EMCIO]DB_PROGRAM: a program that keeps the tools of a machine.

    tooldb_tools([10, 11, 12])            # the tools that there are
    tooldb_callbacks(get, put, load, unload)
    tooldb_loop()                         # until the machine ends

get(number) returns the line of a tool as a tool table has it; put, load and unload get a tool's number and the
line that says what has changed. An exception in any of them refuses the command, with its text.
"""
import sys

DB_VERSION = 'v2.1'

_tools = []
_callbacks = {}


def tooldb_tools(numbers):
    """The numbers of all tools; may be called again when tools come or go."""
    _tools[:] = list(numbers)


def tooldb_callbacks(get, put, load, unload):
    """What is called for each command of the machine."""
    _callbacks.update(g=get, p=put, l=load, u=unload)


def _say(line):
    sys.stdout.write(line + '\n')
    sys.stdout.flush()


def _tell_tools():
    for number in list(_tools):
        _say(_callbacks['g'](number))
    _say('FINI (get_cmd)')


def _tell_change(letter, words):
    """`words`: a line of a tool table, whole or its T and P alone."""
    line = words.upper()
    first = line.split()[0] if line.split() else ''
    if not first.startswith('T'):
        raise ValueError(f'expected T<number>, not <{words}>')
    _callbacks[letter](int(first[1:]), line)
    _say(f'FINI (update recvd) {words}')


def _answer(command):
    letter, _, words = command.partition(' ')
    if letter == '':
        _say('NAK empty_line <>')
    elif letter == 'g' and words == '':
        _tell_tools()
    elif letter in ('p', 'l', 'u'):
        _tell_change(letter, words.strip())
    else:
        _say(f'NAK unknown cmd <{command}>')


def tooldb_loop():
    """Answers the machine until it closes its end."""
    missing = [letter for letter in 'gplu' if not callable(_callbacks.get(letter))]
    if missing:
        raise TypeError(f'tooldb_callbacks() wants four functions; there is none for {" ".join(missing)}')
    _say(DB_VERSION)
    for line in sys.stdin:
        command = line.strip()
        try:
            _answer(command)
        except Exception as error:  # any exception of the user's functions becomes an answer
            text = ' '.join(str(error).split())
            _say(f'NAK cmd={command[:1]}: {type(error).__name__}:{text} <{command}>')
