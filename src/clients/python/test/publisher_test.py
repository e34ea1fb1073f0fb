#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests of mqtt-publisher without a broker. usage: publisher_test.py BIN_FOLDER"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

BIN = pathlib.Path(sys.argv.pop())


def run(lines):
    """Output of halrun for a HAL file: (output, errors)."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / 'a.hal'
        path.write_text(lines)
        env = {**os.environ, 'MILLWRIGHT_INSTANCE': f'publisher-{os.getpid()}', 'PATH': f'{BIN}:{os.environ["PATH"]}'}
        ended = subprocess.run([BIN / 'halrun', path], env=env, capture_output=True, text=True, timeout=50)
    return ended.stdout, ended.stderr


class PublisherTest(unittest.TestCase):
    def test_values_are_published_under_their_names(self):
        began = int(time.time())
        out, err = run('newsig s float\nsets s 2.5\nnewsig b bit\nsets b 1\n'
                       'loadusr -W mqtt-publisher --dryrun --mqtt-prefix=a/b keys=s,b,nothing\n'
                       'loadusr -w sleep 0.5\ngetp mqtt-publisher.lastpublish\ngetp mqtt-publisher.period\n')
        lines = out.splitlines()
        topic, _, message = lines[0].partition(': ')
        self.assertEqual(topic, 'a/b')
        self.assertEqual(json.loads(message), {'s': 2.5, 'b': True, 'nothing': None})
        self.assertEqual(len(lines), 3, out)
        self.assertGreaterEqual(int(lines[1]), began)
        self.assertEqual(lines[2], '10')
        self.assertEqual(err.count('no pin, parameter or signal nothing'), 1, err)

    def test_nothing_is_published_while_it_is_not_enabled(self):
        out, _ = run('newsig s s32\nloadusr -W mqtt-publisher --dryrun keys=s\nsetp mqtt-publisher.enable 0\n'
                     'setp mqtt-publisher.period 0\nloadusr -w sleep 0.4\nsetp mqtt-publisher.enable 1\n'
                     'sets s 7\nloadusr -w sleep 0.5\n')
        messages = [json.loads(line.partition(': ')[2]) for line in out.splitlines()]
        self.assertLessEqual(sum(message == {'s': 0} for message in messages), 2, out)
        self.assertIn({'s': 7}, messages)

    def test_without_keys_it_says_so(self):
        ended = subprocess.run([BIN / 'mqtt-publisher', '--dryrun', 'key=s'], capture_output=True, text=True, timeout=20)
        self.assertEqual(ended.returncode, 2)
        self.assertIn('keys=NAME', ended.stderr)


if __name__ == '__main__':
    unittest.main()
