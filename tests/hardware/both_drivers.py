# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs a HAL file with a driver on a simulated board, each in a separate network namespace."""
import os
import pathlib
import subprocess
import tempfile
import time

import linuxcnc_board

LINUXCNC = '/usr/bin/halrun'


def run(halrun, board, model, texts):
    """texts: physics and HAL. Returns the output of halrun and the log of the board."""
    physics, hal = texts
    with tempfile.TemporaryDirectory() as name, linuxcnc_board.Network() as network:
        folder = pathlib.Path(name)
        folder.chmod(0o777)  # the driver of LinuxCNC runs as another user
        (folder / 'physics.txt').write_text(physics)
        (folder / 'test.hal').write_text(hal)
        command = ['ip', 'netns', 'exec', network.board, board, '--listen', linuxcnc_board.IP, '--model', model, '--physics',
                   str(folder / 'physics.txt'), '--log', str(folder / 'log')]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as program:
            program.stdout.readline()
            # The two drivers must not share a HAL with another program.
            environment = dict(os.environ, RTAPI_UID='65534', RTAPI_FIFO_PATH=str(folder / 'fifo'), MILLWRIGHT_INSTANCE=folder.name)
            apart = ['ip', 'netns', 'exec', network.host, 'unshare', '--ipc', '--pid', '--fork', '--mount-proc', '--']
            done = subprocess.run([*apart, halrun, '-f', str(folder / 'test.hal')], env=environment, capture_output=True, text=True,
                                  timeout=120, check=False)
            time.sleep(0.2)
            program.terminate()
        return done.stdout + done.stderr, (folder / 'log').read_text()
