#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Texts for people are in their language, output for programs is not; two clients of one machine have different languages (A8).

usage: language.py BIN_FOLDER ROOT
"""
import os
import pathlib
import subprocess
import sys
import tempfile

from mill_by_hand import STEP_S, Findings, Mill

FOUND = Findings()
expect = FOUND.expect
PLAIN = {name: value for name, value in os.environ.items() if name not in ('LANG', 'LANGUAGE', 'LC_ALL', 'LC_MESSAGES')}
GERMAN = {**PLAIN, 'LANG': 'de_DE.UTF-8'}
SPANISH = {**PLAIN, 'LANG': 'en_US.UTF-8', 'LANGUAGE': 'es:de'}
READER = '''
import linuxcnc, sys, time
stat, command = linuxcnc.stat(), linuxcnc.command()
end = time.monotonic() + 20
while True:
    try:
        stat.poll()
        channel = linuxcnc.error_channel()
        break
    except linuxcnc.error:
        if time.monotonic() > end:
            raise
        time.sleep(0.02)
command.display_msg('the machine is not on')
command.mdi('G0 X1')
command.wait_complete()
said = []
while time.monotonic() < end and len(said) < 2:
    line = channel.poll()
    said += [line[1]] if line else []
    time.sleep(0.01)
print('|'.join(said))
'''


def output(words, env, folder=None):
    done = subprocess.run([str(word) for word in words], env=env, cwd=folder, text=True, capture_output=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=STEP_S)
    return done.stdout, done.stderr, done.returncode


def check_programs(programs, root, folder):
    bad = folder / 'bad.ngc'
    bad.write_text('G1 X10 F100\nG8.5 (the machine is not on)\nM2\n')
    words = [programs / 'millwright', 'check', bad, '--ini', root / 'configs/sim/mill_mm.ini']
    english, german, spanish = (output(words, env)[1] for env in (PLAIN, GERMAN, SPANISH))
    expect(f'{bad}:2:1: error: Unknown g code used: g8.5' in english, 'an error in English', english)
    expect(f'{bad}:2:1: Fehler: Unbekannter g-Code: g8.5' in german, 'an error in German', german)
    expect(f'{bad}:2:1: error: Código g desconocido: g8.5' in spanish, 'an error in Spanish', spanish)
    expect('G8.5 (the machine is not on)' in german, 'a line of a program stays as it is', german)
    expect('Aufruf: linuxcnc' in output([programs / 'linuxcnc', '-h'], GERMAN)[0], 'help in German')
    expect(output([programs / 'linuxcnc', '-h'], {**GERMAN, 'LC_ALL': 'C'})[0].startswith('usage: linuxcnc'), 'help in the locale C')


def check_names_in_path(programs, folder):
    """A program started by its name finds its catalogue from any folder and with other entries in PATH."""
    (folder / 'elsewhere').mkdir()
    links = folder / 'links'
    links.mkdir()
    for name in ('linuxcnc', 'millwright', 'halcmd', 'halrun', 'haltcl', 'halcompile'):
        (links / name).symlink_to(programs / name)
    for place in (programs, links):
        path = {**GERMAN, 'PATH': f"{place}:{os.environ['PATH']}"}
        for words, text in ((['linuxcnc', '-h'], 'Aufruf: linuxcnc'), (['millwright', '--help'], 'Aufruf: millwright'), (['millwright', 'check', '--help'], 'Aufruf: millwright check'),
                            (['halcmd', '-h'], 'Führt HAL-Befehle'), (['halrun', '-h'], 'Startet einen Echtzeitprozess'), (['haltcl', '-h'], 'Führt ein Tcl-Skript'),
                            (['halcompile', '--help'], 'erzeugt HAL-Komponenten')):
            said = output(words, path, folder / 'elsewhere')
            expect(text in said[0], f'{words[0]} by its name in {place.name}', said)
    # A name without a path, as a shell's exec -a passes it.
    said = output(['bash', '-c', f'exec -a linuxcnc {programs}/linuxcnc -h'], GERMAN, folder / 'elsewhere')
    expect('Aufruf: linuxcnc' in said[0], 'linuxcnc by another name', said)


def check_machine_read(programs, root, folder):
    """Output has the same bytes in every language, also for faulty input."""
    program = folder / 'run.ngc'
    program.write_text('G21 G17\nG43 H99\nG1 X10 F100\nM2\n')
    ini = root / 'configs/sim/mill_mm.ini'
    for words in ([programs / 'rs274', '-g', program], [programs / 'inivar', '-ini', ini, '-sec', 'TRAJ', '-var', 'COORDINATES'],
                  [programs / 'inivar', '-ini', ini, '-sec', 'TRAJ', '-var', 'NONE'], [programs / 'linuxcnc_var', 'all'],
                  [programs / 'halrun', '-U'], [programs / 'millwright', 'explain', 'G1 X1 F100']):
        english = output(words, PLAIN, folder)
        for env in (GERMAN, SPANISH):
            expect(output(words, env, folder) == english, f'{words[0].name} says the same in every language', english)


def check_clients(programs, root, folder):
    """The machine uses English; one of its clients reads German, another Spanish."""
    mill = Mill(str(programs / 'millwright'), str(programs / 'halcmd'), root, folder, 'language')
    modules = {**mill.env, 'PYTHONPATH': str(programs.parent / 'lib/python')}
    for name in ('LANG', 'LANGUAGE', 'LC_ALL', 'LC_MESSAGES'):
        modules.pop(name, None)
    with subprocess.Popen([programs / 'millwright', 'start', mill.ini, '--no-display'], env={**modules, 'LANG': 'C'}, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as machine:
        try:
            for language, text in (({'LANG': 'de_DE.UTF-8'}, 'die Maschine ist im Not-Halt'),
                                   ({'LANG': 'en_US.UTF-8', 'LANGUAGE': 'es'}, 'la máquina está en parada de emergencia'),
                                   ({}, 'the machine is in emergency stop')):
                said = output([sys.executable, '-c', READER], {**modules, **language})
                expect(said[0].strip().split('|') == ['the machine is not on', text], f'each client reads its language: {text}', said)
        finally:
            machine.terminate()
            told = machine.communicate(timeout=STEP_S)[0]
    expect('the machine is in emergency stop' in told, 'the machine writes English to its own terminal', told)


def main():
    programs, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix='mw_language_') as name:
        folder = pathlib.Path(name)
        check_programs(programs, root, folder)
        check_names_in_path(programs, folder)
        check_machine_read(programs, root, folder)
        check_clients(programs, root, folder)
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
