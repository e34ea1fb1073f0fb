# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine from Python: INI files.

    import linuxcnc
    ini = linuxcnc.ini("mill.ini")
    ini.find("DISPLAY", "DISPLAY")                        # text, or None
    ini.getreal("TRAJ", "MAX_LINEAR_VELOCITY", fallback=100)

Keys that occur several times are lists: findall gives them all, num counts from 1. Sections of one name are one.
"""


class error(RuntimeError):
    """What this module refuses."""


from ._core import ini  # noqa: E402  the extension raises the class above

__all__ = ["error", "ini"]
