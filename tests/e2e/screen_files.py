#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs print an address of the screen only if its files are installed, and script/run builds them.

usage: screen_files.py MILLWRIGHT ROOT
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

FAILURES = []


def expect(condition, what, detail=''):
    if not condition:
        FAILURES.append(what)
        print(f'FAIL {what}\n{detail}')


class Installed:
    """A copy of the program in a separate folder, with or without a screen."""

    def __init__(self, millwright, place):
        self.place = pathlib.Path(place)
        self.program = self.place / 'bin/millwright'
        self.program.parent.mkdir()
        shutil.copy(millwright, self.program)
        home = self.place / 'home'
        home.mkdir()
        self.env = {'HOME': str(home), 'PATH': '/usr/bin:/bin', 'LD_LIBRARY_PATH': str(millwright.parent.parent / 'lib'),
                    'MILLWRIGHT_INSTANCE': f'screen-files-{os.getpid()}', 'LANG': 'C'}

    def add_screen(self):
        web = self.place / 'share/millwright/web'
        web.mkdir(parents=True)
        (web / 'index.html').write_text('<!doctype html><title>screen</title>')

    def output_of_server(self, *words):
        """The output of a server until it has printed an address or has ended, and its exit status after SIGTERM."""
        path = self.place / 'output'
        with path.open('w') as file:
            process = subprocess.Popen([self.program, *words], env=self.env, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT)
        end = time.monotonic() + 30
        while 'http://' not in path.read_text() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.05)
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        return path.read_text(), process.wait(30)


def check_programs(millwright, root, place):
    installed = Installed(millwright, place)
    ini = str(root / 'configs/sim/mill_mm.ini')
    remedy = ('The screen is not installed', 'script/screen')
    output, status = installed.output_of_server('ui', ini, '--port', '0', '--open')
    expect(all(words in output for words in remedy), 'ui names the missing screen and what builds it', output)
    expect('/api/\n' in output and 'screen of' not in output and status == 0, 'ui serves programs, and prints no address of a screen', output)
    output, status = installed.output_of_server('select', '--browser', '--port', '0')
    expect(all(words in output for words in remedy) and 'http://' not in output and status == 1,
           'select --browser ends and says why', f'{status}\n{output}')
    installed.add_screen()
    output, status = installed.output_of_server('ui', ini, '--port', '0')
    expect('screen of' in output and 'not installed' not in output and status == 0, 'ui prints the address of its screen', output)
    output, status = installed.output_of_server('select', '--browser', '--port', '0')
    expect('#key=' in output, 'select --browser prints its address', output)


def check_script_run(root, place):
    """script/run with replacements of its programs, which log their names."""
    script = pathlib.Path(place) / 'script'
    tools = pathlib.Path(place) / 'tools'
    log = pathlib.Path(place) / 'called'
    script.mkdir(parents=True)
    tools.mkdir()
    shutil.copy(root / 'script/run', script / 'run')

    def put(path, text):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'#!/bin/sh\necho "{path.name} $*" >>{log}\n{text}\n')
        path.chmod(0o755)

    put(script / 'bootstrap', '')
    put(script / 'screen', '')
    put(tools / 'cmake', '')
    put(script.parent / 'build/release/bin/millwright', '')
    for name in ('bash', 'dirname', 'mkdir', 'sh', 'env'):
        os.symlink(shutil.which(name), tools / name)

    def run():
        log.write_text('')
        done = subprocess.run([script / 'run'], env={'PATH': str(tools)}, capture_output=True, text=True, check=False, timeout=60)
        return log.read_text(), done

    called, done = run()
    expect(done.returncode == 0 and 'millwright run' in called and 'screen' not in called and 'script/bootstrap --screen' in done.stderr,
           'script/run without npm says what builds the screen', f'{called}\n{done}')
    put(tools / 'npm', '')
    called, done = run()
    expect(done.returncode == 0 and 'screen ' in called and 'millwright run' in called, 'script/run builds the screen', f'{called}\n{done}')
    put(script / 'screen', 'exit 1')
    called, done = run()
    expect(done.returncode == 0 and 'millwright run' in called and 'screen' in done.stderr,
           'a screen that cannot be built is reported, and the program runs', f'{called}\n{done}')


def main():
    millwright, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as place:
        check_programs(millwright, root, place)
    with tempfile.TemporaryDirectory() as place:
        check_script_run(root, place)
    return 1 if FAILURES else 0


if __name__ == '__main__':
    sys.exit(main())
