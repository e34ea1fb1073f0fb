# SPDX-License-Identifier: GPL-2.0-or-later
"""What is in HAL now, as dicts. Lists are sorted by name, except components (newest first) and threads (fastest first).

pins(), params(), signals(), comps(), functs(), threads() take a pattern with * ? [abc]; pin(), param(), signal(),
funct(), thread() take a name and comp() a name or an id, and raise RuntimeError when there is none.
"""
import enum

from ._core import _query


class Type(enum.IntEnum):
    """Types; the values are those of hal.HAL_BIT and so on."""
    BOOL = 1
    REAL = 2
    S32 = 3
    U32 = 4
    PORT = 5
    SINT = 6
    UINT = 7


class Dir(enum.IntEnum):
    """Directions of pins (IN, OUT, IO) and parameters (RO, RW)."""
    IN = 16
    OUT = 32
    IO = 48
    RO = 64
    RW = 192


class CompType(enum.IntEnum):
    """Where a component runs."""
    USER = 0
    REALTIME = 1
    OTHER = 2


def _typed(row):
    row["type"] = Type(row["type"])
    if "dir" in row:
        row["dir"] = Dir(row["dir"])
    for pin in row.get("pins", ()):
        pin["dir"] = Dir(pin["dir"])
    return row


def _comp(row):
    row["type"] = CompType(row["type"])
    return row


def _one(rows, kind, name):
    for row in rows:
        if name in (row["name"], row.get("original_name")):
            return row
    raise RuntimeError(f"there is no {kind} '{name}'")


def pins(glob="*"):
    """name, original_name (where there is an alias), type, dir, value, comp, comp_id, signal."""
    return [_typed(row) for row in _query.pins(glob)]


def params(glob="*"):
    """name, original_name, type, dir, value, comp, comp_id."""
    return [_typed(row) for row in _query.params(glob)]


def signals(glob="*"):
    """name, type, value, readers, writers, bidirs, pins (name, dir)."""
    return [_typed(row) for row in _query.signals(glob)]


def comps(glob="*"):
    """name, id, type, ready, pid, args (of loadrt)."""
    return sorted((_comp(row) for row in _query.comps(glob)), key=lambda row: -row["id"])


def functs(glob="*"):
    """name, comp, comp_id, users (places in threads), reentrant."""
    return _query.functs(glob)


def threads(glob="*"):
    """name, period [ns], init_functs, functs, overruns, time [ns], tmax [ns]."""
    return _query.threads(glob)


def signalpins(name):
    """The pins of a signal."""
    return [pin(row["name"]) for row in signal(name)["pins"]]


def pin(name):
    """The row of one pin."""
    return _one(pins(), "pin", name)


def param(name):
    """The row of one parameter."""
    return _one(params(), "parameter", name)


def signal(name):
    """The row of one signal."""
    return _one(signals(), "signal", name)


def comp(name_or_id):
    """The row of one component."""
    for row in comps():
        if name_or_id in (row["name"], row["id"]):
            return row
    raise RuntimeError(f"there is no component '{name_or_id}'")


def funct(name):
    """The row of one function."""
    return _one(functs(), "function", name)


def thread(name):
    """The row of one thread."""
    return _one(threads(), "thread", name)
