# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface for [EMCIO]DB_PROGRAM: a program that stores the tools of a machine.

    tooldb_tools([10, 11, 12])            # the existing tools
    tooldb_callbacks(get, put, load, unload)
    tooldb_loop()                         # until the machine ends

get(number) returns the line of a tool in the format of a tool table. put, load and unload receive a tool's number and a line with
the changes. If one of them raises an exception, the command is rejected with its text.
"""
import sys

DB_VERSION = 'v2.1'

_tools = []
_callbacks = {}


def tooldb_tools(numbers):
    """The numbers of all tools; may be called again when tools are added or removed."""
    _tools[:] = list(numbers)


def tooldb_callbacks(get, put, load, unload):
    """Functions that are called for the commands of the machine."""
    _callbacks.update(g=get, p=put, l=load, u=unload)


def _say(line):
    sys.stdout.write(line + '\n')
    sys.stdout.flush()


def _tell_tools():
    for number in list(_tools):
        _say(_callbacks['g'](number))
    _say('FINI (get_cmd)')


def _tell_change(letter, words):
    """`words`: a line of a tool table, complete or only its T and P."""
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
