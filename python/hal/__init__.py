# SPDX-License-Identifier: GPL-2.0-or-later
"""HAL components in Python, and HAL's pins, parameters, signals and streams.

    import hal
    h = hal.component("passthrough")
    h.newpin("in", hal.HAL_FLOAT, hal.HAL_IN)
    h.newpin("out", hal.HAL_FLOAT, hal.HAL_OUT)
    h.ready()
    h["out"] = h["in"]

Values are bool (bit), float, and int. HAL refuses with hal.error; names that are unknown give RuntimeError, numbers
that do not fit OverflowError. `halcmd unload` ends a component by a KeyboardInterrupt, and a program that goes on in spite
of it two seconds later; programs with the windows of Gtk or Qt leave HAL and end at once.
"""
import atexit as _atexit
import os as _os
import signal as _signal
import sys as _sys
import threading as _threading
import weakref as _weakref

from . import _core
from ._core import *  # noqa: F401,F403
from ._core import component as _component
from ._core import error, item
from . import query


class _Wrapped:
    """An item of HAL as a Python object, from which widgets derive together with classes of their toolkit."""

    def __new__(cls, *args, **kwargs):
        return super().__new__(cls)

    def __init__(self, item, *args, **kwargs):
        if isinstance(item, _Wrapped):
            item = item._item
        if not isinstance(item, _core.item):
            raise TypeError(f"a HAL item is needed, not {type(item).__name__}")
        self._item_wrap(item)

    def _item_wrap(self, item):
        self._item = item
        for name in ("get", "set", "get_type", "get_name", "get_dir", "is_pin"):
            setattr(self, name, getattr(item, name))
        return self

    def __getattr__(self, name):
        if name == "_item":  # not made yet
            raise AttributeError(name)
        return getattr(self._item, name)  # other methods of ports

    def __repr__(self):
        return repr(self._item)

    name = property(lambda self: self._item.get_name(), doc="Without the prefix.")
    type = property(lambda self: self._item.get_type())
    dir = property(lambda self: self._item.get_dir())
    value = property(lambda self: self._item.get(), lambda self, value: self._item.set(value))


class Pin(_Wrapped):
    """Pin(item): a pin of a component."""


class Param(_Wrapped):
    """Param(item): a parameter of a component."""


def _wrap(item):
    return Pin(item) if item.is_pin() else Param(item)


_components = _weakref.WeakSet()


# : The event loops of these print the interrupt and continue.
_TOOLKITS = ("gi.repository.Gtk", "PyQt5.QtWidgets", "PyQt6.QtWidgets", "PySide2.QtWidgets", "PySide6.QtWidgets")
#: Time after which a program that ignores the interrupt is ended.
_GRACE_S = 2.0


@_atexit.register
def _leave():
    """Leaves HAL when the program ends normally, also without a request."""
    for one in list(_components):
        try:
            one.exit()
        except error:
            continue  # the instance has ended, and the component with it


def _end_now():
    try:
        _leave()
    finally:
        _os.kill(_os.getpid(), _signal.SIGTERM)


def _on_terminate(number, frame):
    _signal.signal(_signal.SIGTERM, _signal.SIG_DFL)
    if any(name in _sys.modules for name in _TOOLKITS):
        _end_now()
    last = _threading.Timer(_GRACE_S, _end_now)
    last.daemon = True
    last.start()
    raise KeyboardInterrupt


def _end_by_interrupt():
    """Converts SIGTERM, with which HAL ends programs, to a KeyboardInterrupt, unless the program handles SIGTERM."""
    if _threading.current_thread() is _threading.main_thread() \
            and _signal.getsignal(_signal.SIGTERM) == _signal.SIG_DFL:
        _signal.signal(_signal.SIGTERM, _on_terminate)


class component(_component):
    """component(name[, prefix]): a HAL component of this program."""

    def __init__(self, name, prefix=""):
        super().__init__(name, prefix or "")
        _components.add(self)
        _end_by_interrupt()

    def exit(self):
        _components.discard(self)
        super().exit()

    def newpin(self, *args, **kwargs):
        return Pin(_component.newpin(self, *args, **kwargs))

    def newparam(self, *args, **kwargs):
        return Param(_component.newparam(self, *args, **kwargs))

    def getitem(self, name):
        return _wrap(_component.getitem(self, name))

    def getpin(self, name):
        return Pin(_component.getpin(self, name))

    def getparam(self, name):
        return Param(_component.getparam(self, name))


def __getattr__(name):
    if name in ("is_rt", "is_sim"):
        try:
            realtime = _core.is_rt_now()
        except RuntimeError:
            realtime = False
        return int(realtime == (name == "is_rt"))
    raise AttributeError(f"module 'hal' has no attribute '{name}'")
