# SPDX-License-Identifier: GPL-2.0-or-later
"""Common parts of the realtime checks of `millwright run` and `millwright start`: a copy of a simulated mill with manual tool
change, its pins, and the findings."""
import os
import pathlib
import shutil
import subprocess

STEP_S = 40  # a step of a working machine takes much less time
BY_HAND = """unlinkp iocontrol.0.tool-change
unlinkp iocontrol.0.tool-changed
loadusr -W hal_manualtoolchange
net by-hand iocontrol.0.tool-change => hal_manualtoolchange.change
net by-hand-done hal_manualtoolchange.changed => iocontrol.0.tool-changed
net by-hand-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number
"""


class Mill:
    """A copy of configs/sim/mill_mm.ini with halui and its own parameter file, as a separate instance."""

    def __init__(self, millwright, halcmd, root, folder, name):
        self.millwright, self.halcmd, self.folder = millwright, halcmd, folder
        shutil.copytree(pathlib.Path(root) / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        self.ini = folder / 'configs/sim/mill_mm.ini'
        plain = self.ini.read_text()
        changed = plain.replace('HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\nHALFILE = by_hand.hal\nHALUI = halui\n')
        assert changed != plain, f'{self.ini} does not load spindle_sim.hal any more'
        self.ini.write_text(changed)
        (self.ini.parent / 'by_hand.hal').write_text(BY_HAND)
        self.env = dict(os.environ, MILLWRIGHT_INSTANCE=f'{name}-{os.getpid()}', TERM='xterm')

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def pin(self, name):
        done = subprocess.run([self.halcmd, 'getp', name], env=self.env, capture_output=True, text=True, check=False)
        return done.stdout.strip()

    def set_pin(self, name, value):
        return subprocess.run([self.halcmd, 'setp', name, value], env=self.env, check=False).returncode == 0

    def position(self):
        """Position of the first joint; nan if HAL does not answer."""
        return float(self.pin('joint.0.pos-cmd') or 'nan')


class Findings:
    """Deviations from the expected state."""

    def __init__(self):
        self.failures = []

    def expect(self, condition, what, *more):
        if not condition:
            self.failures.append(what)
            print(f'FAIL {what}', *more, sep='\n')

    def status(self):
        """Prints the number of faults and returns the exit status."""
        print(f'{len(self.failures)} failed')
        return 1 if self.failures else 0
