#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""update_ini: updates INI files from before the introduction of joints and axes."""
import pathlib
import sys

for place in ('../lib/python', '../lib/millwright/python'):  # in the build folder, and installed
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / place))
from millwright.update_ini import main  # noqa: E402

sys.exit(main(sys.argv[1:]))
