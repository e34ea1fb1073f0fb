#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""runtests: runs tests that are folders."""
import pathlib
import sys

for place in ('../lib/python', '../lib/millwright/python'):  # in the build folder, and installed
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / place))
from millwright.runtests import main  # noqa: E402

sys.exit(main(sys.argv[1:], pathlib.Path(__file__).resolve().parent))
