# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine from Python: status, commands, messages, INI files.

    import linuxcnc
    s, c, e = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()
    c.state(linuxcnc.STATE_ON)
    c.wait_complete()            # RCS_DONE, RCS_ERROR, or -1 when the time is over
    s.poll()                     # takes the status as it is now; never waits
    s.position                   # nine floats, machine units and degrees
    e.poll()                     # (kind, text) or None

    ini = linuxcnc.ini("mill.ini")
    ini.find("DISPLAY", "DISPLAY")                        # text, or None
    ini.getreal("TRAJ", "MAX_LINEAR_VELOCITY", fallback=100)

The machine is that of $MILLWRIGHT_INSTANCE, which the launcher sets, or one on another computer: see nmlfile. Keys that occur several times are lists: findall
gives them all, num counts from 1. Sections of one name are one.
"""
import collections as _collections
import os as _os


class error(RuntimeError):
    """A call that this module rejects."""


tool = _collections.namedtuple("tool", "id xoffset yoffset zoffset aoffset boffset coffset uoffset voffset woffset "
                                       "diameter frontangle backangle orientation")

from ._core import *  # noqa: E402,F401,F403  the extension raises the class above
from ._core import command, error_channel, ini, positionlogger, stat  # noqa: E402,F401

# : An NML file. If its process xemc is REMOTE, the machine is that of the NML server. With the default, and with a :
# file whose process xemc is LOCAL, the machine is that of $MILLWRIGHT_INSTANCE on this computer.
nmlfile = _os.environ.get("NMLFILE", __file__)
if nmlfile == _os.environ.get("INI_FILE_NAME"):
    nmlfile = __file__  # the launcher's value for a machine without an NML file
PREFIX = "/usr"
SHARE = "/usr/share"
version = _os.environ.get("LINUXCNCVERSION", "2.9")
