#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests that files written by Python programs are either the old or the new file.
usage: whole_file_test.py PYTHON_FOLDER"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

FOLDER = str(pathlib.Path(sys.argv.pop()).resolve())
sys.path.insert(0, FOLDER)
from millwright import whole_file  # noqa: E402  pylint: disable=wrong-import-position

# Creates the temporary file, prints "made" and waits.
HALF = """import pathlib, sys, time
sys.path.insert(0, sys.argv[1])
from millwright import whole_file
whole_file.create(pathlib.Path(sys.argv[2]))
print('made', flush=True)
time.sleep(60)
"""


class WholeFileTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory(prefix='mw_whole_file_')
        self.addCleanup(self.place.cleanup)
        self.folder = pathlib.Path(self.place.name)
        self.path = self.folder / 'part.ini'

    def half_writer(self):
        process = subprocess.Popen([sys.executable, '-c', HALF, FOLDER, str(self.path)], stdout=subprocess.PIPE)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), b'made\n')
        return process

    def test_content_and_permissions(self):
        whole_file.write_whole(self.path, 'first \N{DEGREE SIGN}')
        self.assertEqual(self.path.read_text(encoding='utf-8'), 'first \N{DEGREE SIGN}')
        self.path.chmod(0o640)
        whole_file.write_whole(self.path, 'a\udcffb', 'surrogateescape')
        self.assertEqual(self.path.read_bytes(), b'a\xffb')
        self.assertEqual(self.path.stat().st_mode & 0o777, 0o640)
        self.assertEqual(os.listdir(self.folder), ['part.ini'])

    def test_what_a_killed_writer_left_is_removed_by_the_next_write(self):
        process = self.half_writer()
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertEqual(len(os.listdir(self.folder)), 1)
        whole_file.write_whole(self.path, 'new')
        self.assertEqual(os.listdir(self.folder), ['part.ini'])

    def test_the_file_of_a_living_writer_stays(self):
        self.half_writer()
        [name] = os.listdir(self.folder)
        whole_file.write_whole(self.path, 'new')
        self.assertEqual(set(os.listdir(self.folder)), {'part.ini', name})

    def test_the_name_is_that_of_the_programs_in_cpp(self):
        """base/temporary_file.cc also removes the file."""
        self.half_writer()
        [name] = os.listdir(self.folder)
        self.assertRegex(name, r'^\.part\.ini\.millwright-[0-9a-v]{10}$')

    def test_other_files_stay(self):
        names = ['.part.ini.millwright-', '.part.ini.millwright-012345678w', '.other.millwright-0123456789', 'part.ini.millwright-0123456789']
        for name in names:
            (self.folder / name).touch()
        (self.folder / '.part.ini.millwright-0000000000').symlink_to(names[0])
        (self.folder / '.part.ini.millwright-0000000001').hardlink_to(self.folder / names[0])
        before = set(os.listdir(self.folder))
        whole_file.write_whole(self.path, 'new')
        self.assertEqual(set(os.listdir(self.folder)), before | {'part.ini'})

    def test_after_an_error_the_old_file_is_untouched(self):
        self.path.write_text('old', encoding='utf-8')
        with self.assertRaises(UnicodeEncodeError):
            whole_file.write_whole(self.path, '\udcff')
        self.assertEqual(self.path.read_text(encoding='utf-8'), 'old')
        pipe = self.folder / 'pipe'
        os.mkfifo(pipe)
        with self.assertRaises(OSError):
            whole_file.write_whole(pipe, 'new')
        self.assertEqual(set(os.listdir(self.folder)), {'part.ini', 'pipe'})


if __name__ == '__main__':
    unittest.main()
