# SPDX-License-Identifier: GPL-2.0-or-later
"""HAL components in Python, and HAL's pins, parameters, signals and streams.

    import hal
    h = hal.component("passthrough")
    h.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
    h.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
    h.ready()
    h["out"] = h["in"]

Values are bool (bit), float, and int. HAL refuses with hal.error; names that are unknown give RuntimeError, numbers
that do not fit OverflowError. `halcmd unload` ends a component by a KeyboardInterrupt.
"""
import signal as _signal
import threading as _threading

from . import _core
from ._core import *  # noqa: F401,F403
from ._core import component as _component
from ._core import error, item
from . import query

Pin = Param = item


def _end_by_interrupt():
    """Lets SIGTERM, with which HAL ends programs, come as a KeyboardInterrupt, unless the program decides itself."""
    if _threading.current_thread() is _threading.main_thread() \
            and _signal.getsignal(_signal.SIGTERM) == _signal.SIG_DFL:
        _signal.signal(_signal.SIGTERM, _signal.default_int_handler)


class component(_component):
    """component(name[, prefix]): a HAL component of this program."""

    def __init__(self, name, prefix=""):
        super().__init__(name, prefix or "")
        _end_by_interrupt()


def __getattr__(name):
    if name in ("is_rt", "is_sim"):
        try:
            realtime = _core.is_rt_now()
        except RuntimeError:
            realtime = False
        return int(realtime == (name == "is_rt"))
    raise AttributeError(f"module 'hal' has no attribute '{name}'")
