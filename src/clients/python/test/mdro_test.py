#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of mdro through its pins and its page (J3, J4). usage: mdro_test.py BIN_FOLDER"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

BIN = pathlib.Path(sys.argv.pop()).resolve()
sys.path.insert(0, str(BIN.parent / 'lib/python'))
from millwright import mdro  # noqa: E402


class MdroTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory(prefix='mw_mdro_')
        self.folder = pathlib.Path(self.place.name)
        self.env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'mdro-{os.getpid()}', 'PATH': f'{BIN}:{os.environ["PATH"]}', 'LC_ALL': 'C',
                    'PYTHONPATH': str(BIN.parent / 'lib/python')}
        for name in ('DISPLAY', 'WAYLAND_DISPLAY'):
            self.env.pop(name, None)
        self.hal = None

    def tearDown(self):
        if self.hal:
            self.hal.stdin.close()
            self.hal.wait(20)
        self.place.cleanup()

    def start(self, words, after='', nets='net x mdro.axis.0\nnet y mdro.axis.1\nnet i mdro.index-enable.0\n'):
        """Runs mdro with a HAL at whose prompt nothing is typed; the signals x, y, z are its scales."""
        (self.folder / 'a.hal').write_text('newsig x float\nnewsig y float\nnewsig z float\nnewsig i bit\n' f'loadusr -W mdro {words}\n{nets}{after}')
        with open(self.folder / 'said', 'w') as said:
            self.hal = subprocess.Popen([BIN / 'halrun', '-I', 'a.hal'], cwd=self.folder, env=self.env, text=True, stdin=subprocess.PIPE,
                                        stdout=subprocess.DEVNULL, stderr=said)
        end = time.monotonic() + 20
        while time.monotonic() < end:
            found = re.search(r'mdro: (http://127\.0\.0\.1:\d+/\S+/)', (self.folder / 'said').read_text())
            if found:
                self.address = found[1]
                return
            self.assertIsNone(self.hal.poll(), (self.folder / 'said').read_text())
            time.sleep(0.01)
        self.fail((self.folder / 'said').read_text())

    def halcmd(self, *words):
        return subprocess.run([BIN / 'halcmd', *map(str, words)], env=self.env, capture_output=True, text=True, check=False, timeout=20).stdout.strip()

    def ask(self, path='state', **request):
        data = json.dumps(request).encode() if request else None
        try:
            with urllib.request.urlopen(self.address + path, data, timeout=10) as answer:
                return json.load(answer)
        except urllib.error.HTTPError as error:
            text = error.read().decode()
            error.close()
            return json.loads(text)['refused'] if error.code == 400 else error.code

    def do(self, what, axis=0, value=None):
        return self.ask('do', do=what, axis=axis, value=value)

    def values(self, **at):
        for name, value in at.items():
            self.halcmd('sets', name, value)
        return [one['value'] and round(one['value'], 9) for one in self.ask()['axes']]

    def test_values_offsets_and_units(self):
        self.start('-p 30 XYA', 'net z mdro.axis.2\n')
        self.assertEqual(self.values(x=2, y=-1.5, z=90), [2, -1.5, 90])
        self.do('zero')
        self.do('half', 1)
        self.do('set', 2, 10)
        self.assertEqual(self.values(), [0, -0.75, 10])
        self.assertEqual(self.values(x=3), [1, -0.75, 10])
        # Scales in inches are shown in millimetres; degrees are not converted. Shown values include the
        # settings.
        self.do('units', value='mm')
        self.assertEqual(self.values(), [25.4, -19.05, 10])
        self.do('set', 0, 12.7)
        self.do('units', value='inch')
        self.assertEqual(self.values(), [0.5, -0.75, 10])
        # Each coordinate system has separate offsets; the machine's offsets cannot be changed.
        self.do('system', value='G55')
        self.assertEqual(self.values(), [3, -1.5, 90])
        self.do('system', value='machine')
        for what in ('zero', 'half', 'set'):
            self.assertIn('machine coordinates cannot be changed', self.do(what, 0, 1))
        self.assertEqual(self.values(), [3, -1.5, 90])
        with urllib.request.urlopen(self.address, timeout=10) as page:
            self.assertIn('font: 30pt', page.read().decode())

    def test_index(self):
        self.start('XY')
        self.do('index')
        self.assertEqual(self.halcmd('gets', 'i'), 'TRUE')
        self.assertTrue(self.ask()['axes'][0]['index'])
        self.halcmd('sets', 'i', 0)  # the encoder has detected the index
        self.assertFalse(self.ask()['axes'][0]['index'])
        self.do('index')
        self.do('index')  # and cancelled
        self.assertEqual(self.halcmd('gets', 'i'), 'FALSE')
        self.do('index')
        self.halcmd('unloadusr', 'mdro')
        self.assertEqual(self.halcmd('gets', 'i'), 'FALSE')

    def test_offsets_of_a_file(self):
        (self.folder / 'a.var').write_text('5161\t9\n5221\t1.0\n5222 2\n5223 3\n5241 10\n5282 40\n5301 7\n')
        self.start('-m -l a.var XY')
        self.assertEqual(self.values(x=0, y=0), [-1, -2])
        self.assertTrue(self.ask()['mm'])
        self.do('system', value='G55')
        self.assertEqual(self.values(), [-10, 0])
        self.do('system', value='G57')
        self.assertEqual(self.values(), [0, -40])

    def test_what_cannot_be_done_is_said(self):
        self.start('XY')
        self.values(x=4)
        for request, text in ((dict(do='zero', axis=2), 'no axis 2'), (dict(do='zero', axis=-1), 'no axis'), (dict(do='zero', axis=True), 'no axis'),
                              (dict(do='set', axis=0, value='1'), 'no number'), (dict(do='set', axis=0, value=float('nan')), 'no number'),
                              (dict(do='set', axis=0, value=float('inf')), 'no number'), (dict(do='system', value='G58'), 'no coordinate system'),
                              (dict(do='dance'), 'nothing that it does')):
            self.assertIn(text, self.ask('do', **request), request)
        self.assertEqual(self.values()[0], 4)
        # A request without its address.
        whole, self.address = self.address, re.sub(r'[^/]+/$', '', self.address)
        for path in ('', 'state', 'do', 'x/state', '../state'):
            self.assertEqual(self.ask(path), 404)
        self.assertEqual(self.ask('do', do='zero', axis=0), 404)
        self.address = whole
        self.assertEqual(self.ask('other'), 404)

    def test_a_scale_without_a_number(self):
        readout = mdro.Readout('XY', True, mdro.offsets_of(os.devnull, 'XY'), [float('nan'), 3.0].__getitem__, lambda *_: False)
        self.assertEqual([one['value'] for one in readout.state()['axes']], [None, 3])
        for what in ('zero', 'half', 'set'):
            with self.assertRaisesRegex(mdro.Refused, 'is not a number'):
                readout.do({'do': what, 'axis': 0, 'value': 1})

    def test_command_lines_that_are_wrong(self):
        (self.folder / 'bad.var').write_text('5221 0\n5222 two\n')
        for words, text in (('XX', "'XX': letters"), ('XQ', "'XQ': letters"), ('-p 2', "'2': 6 to 200"), ('-l none.var', 'none.var: No such file'),
                            ('-l bad.var', 'bad.var:2: "5222 two" is no parameter'), ('-z', 'unrecognized arguments: -z')):
            done = subprocess.run([BIN / 'mdro', *words.split()], cwd=self.folder, env=self.env, capture_output=True, text=True, check=False, timeout=20)
            self.assertEqual(done.returncode, 2)
            self.assertIn(text, done.stderr)

    def test_ini_file(self):
        (self.folder / 'post.hal').write_text('newsig w float\nnet w mdro.axis.1\nsets w 7\n')
        (self.folder / 'a.var').write_text('5222 5\n5223 2\n')
        (self.folder / 'a.ini').write_text('[DISPLAY]\nDISPLAY = mdro\nGEOMETRY = XZ\nMDRO_VAR_FILE = a.var\nPOINT_SIZE = 25\nMM = 1\n'
                                           '[HAL]\nPOSTGUI_HALFILE = post.hal\n')
        self.start(f'-ini {self.folder}/a.ini', nets='')
        state = self.ask()
        self.assertEqual([one['letter'] for one in state['axes']], ['X', 'Z'])
        self.assertEqual((state['axes'][1]['value'], state['mm']), (5, True))


if __name__ == '__main__':
    unittest.main()
