# SPDX-License-Identifier: GPL-2.0-or-later
"""HAL components with named enums and ports, based on the module hal.

import pyhal
c = pyhal.component("writer")
port = c.pinNew("port", pyhal.halType.PORT, pyhal.pinDir.OUT)
c.ready()
if port.waitWritable(3, timeout=1):
    port.write(b"abc")
"""
import enum
import time

import hal


class halType(enum.IntEnum):
    """Types of pins and signals."""
    BIT = hal.HAL_BIT
    FLOAT = hal.HAL_FLOAT
    SIGNED = hal.HAL_S32
    UNSIGNED = hal.HAL_U32
    PORT = hal.HAL_PORT
    SIGNED64 = hal.HAL_S64
    UNSIGNED64 = hal.HAL_U64


class pinDir(enum.IntEnum):
    """Directions of pins."""
    IN = hal.HAL_IN
    OUT = hal.HAL_OUT
    IO = hal.HAL_IO


class pin:
    """A pin; `value` reads and sets it. Ports transfer bytes."""

    POLL_S = 0.001

    def __init__(self, item, full_name):
        self._item = item
        self.name = full_name
        self.type = halType(item.get_type())
        self.dir = pinDir(item.get_dir())

    @property
    def value(self):
        """The value now."""
        return self._item.get()

    @value.setter
    def value(self, new):
        self._item.set(new)

    def get(self):
        """The value now."""
        return self._item.get()

    def set(self, new):
        """Sets the value."""
        self._item.set(new)

    def size(self):
        """Port: size of the queue; it can hold one byte less."""
        return self._item.size()

    def readable(self):
        """Port: bytes that can be read."""
        return self._item.readable()

    def writable(self):
        """Port: bytes that can be written."""
        return self._item.writable()

    def write(self, data):
        """Port: writes all of data, or nothing and returns False."""
        return self._item.write(data)

    def read(self, count):
        """Port: removes and returns count bytes; '' if there are fewer."""
        return self._item.read(count) or ''

    def peek(self, count):
        """Port: as read(), but the bytes remain in the queue."""
        return self._item.peek(count) or ''

    def peekCommit(self, count):
        """Port: discards count bytes; False if there are fewer."""
        return self._item.peek_commit(count)

    def clear(self):
        """Port: empties the queue."""
        self._item.clear()

    def waitReadable(self, count, timeout=None):
        """Port: waits until count bytes can be read; False after timeout seconds."""
        return self._wait(self.readable, count, timeout)

    def waitWritable(self, count, timeout=None):
        """Port: waits until count bytes can be written; False after timeout seconds."""
        return self._wait(self.writable, count, timeout)

    def _wait(self, available, count, timeout):
        end = None if timeout is None else time.monotonic() + timeout
        while available() < count:
            if end is not None and time.monotonic() >= end:
                return False
            time.sleep(self.POLL_S)
        return True


class component:
    """A HAL component. The names of its pins begin with the component's name."""

    def __init__(self, name):
        self.name = name
        self._component = hal.component(name)

    def pinNew(self, name, type, dir):
        """A new pin COMPONENT.name."""
        return pin(self._component.newpin(name, int(type), int(dir)), f"{self.name}.{name}")

    def sigNew(self, name, type):
        """A new signal."""
        return sigNew(name, type)

    def sigLink(self, pin_name, signal_name):
        """Links a pin, by its full name or as an object, to a signal."""
        return sigLink(pin_name, signal_name)

    def ready(self):
        """All pins are made."""
        self._component.ready()

    def exit(self):
        """Ends the component."""
        self._component.exit()


def sigNew(name, type):
    """A new signal; hal.error if HAL rejects it."""
    if not hal.new_sig(name, int(type)):
        raise hal.error(f"no new signal '{name}'")
    return name


def sigLink(pin_name, signal_name):
    """Links a pin to a signal; hal.error if HAL rejects it."""
    if not hal.connect(getattr(pin_name, "name", pin_name), signal_name):
        raise hal.error(f"no link of '{pin_name}' to '{signal_name}'")
