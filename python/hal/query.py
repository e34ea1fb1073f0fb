# SPDX-License-Identifier: GPL-2.0-or-later
"""The current objects of HAL as dicts, sorted by name; components with the newest first, threads with the fastest first.

pins(), params(), signals(), comps(), functs(), threads() take a pattern with * ? [abc]. pin(), param(), signal(), funct(),
thread() take a name, and comp() a name or an id; they return None if the object does not exist.
"""
import enum
import fnmatch

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


def _named(kind, row, keys):
    """The dict that LinuxCNC's programs expect, in its order: name, alias and kind first."""
    found = {"haltype": kind, "name": row.get("original_name") or row["name"]}
    row = dict(row, alias=row["name"] if row.get("original_name") else None)
    found.update((key, row[key]) for key in keys)
    if "dir" in found:
        found["dir"] = Dir(found["dir"])
    return found


def _dict(rows):
    return {row["name"]: row for row in rows}


def pins(glob="*"):
    """By name: haltype, name, type, dir, value, alias, signal, comp, comp_id."""
    return _dict(_named("pin", dict(row, type=Type(row["type"])),
                        ("type", "dir", "value", "alias", "signal", "comp", "comp_id")) for row in _query.pins(glob))


def params(glob="*"):
    """By name: haltype, name, type, dir, value, alias, comp, comp_id."""
    return _dict(_named("parameter", dict(row, type=Type(row["type"])),
                        ("type", "dir", "value", "alias", "comp", "comp_id")) for row in _query.params(glob))


def _driver(row):
    for pin_row in row["pins"]:
        if pin_row["dir"] == Dir.OUT:
            return pin_row["name"]
    return None


def signals(glob="*"):
    """By name: haltype, name, type, value, writers, readers, bidirs, driver (the pin that writes)."""
    return _dict(_named("signal", dict(row, type=Type(row["type"]), driver=_driver(row)),
                        ("type", "value", "writers", "readers", "bidirs", "driver")) for row in _query.signals(glob))


def comps(glob="*"):
    """By name: haltype, name, type, id, pid (0 in realtime), ready, insmod (arguments of loadrt)."""
    rows = sorted(_query.comps(glob), key=lambda row: -row["id"])
    # Components created by threads run in the same process as the threads.
    kinds = [CompType.USER if row["type"] == CompType.USER else CompType.REALTIME for row in rows]
    return _dict(_named("component", dict(row, type=kind, pid=row["pid"] if kind == CompType.USER else 0,
                                          insmod=row["args"]), ("type", "id", "pid", "ready", "insmod"))
                 for row, kind in zip(rows, kinds))


def functs(glob="*"):
    """By name: haltype, name, comp, comp_id, users (number of entries in threads), reentrant."""
    return _dict(_named("function", row, ("comp", "comp_id", "users", "reentrant")) for row in _query.functs(glob))


def threads(glob="*"):
    """By name: haltype, name, comp, comp_id, priority (0: the fastest), period [ns], functions (haltype, name,
    index, is_init)."""
    found = {}
    for priority, row in enumerate(_query.threads()):
        if not fnmatch.fnmatchcase(row["name"], glob):
            continue
        functions = [(name, True) for name in row["init_functs"]] + [(name, False) for name in row["functs"]]
        own = comp("__" + row["name"])
        found[row["name"]] = {
            "haltype": "thread", "name": row["name"], "comp": own["name"], "comp_id": own["id"],
            "priority": priority, "period": row["period"],
            "functions": [{"haltype": "threadfunction", "name": name, "index": index, "is_init": is_init}
                          for index, (name, is_init) in enumerate(functions)]}
    return found


def signalpins(name):
    """The pins of a signal, as pins() returns them; None if the signal does not exist."""
    for row in _query.signals():
        if row["name"] == name:
            all_pins = pins()
            return {entry["name"]: all_pins[entry["name"]] if entry["name"] in all_pins else pin(entry["name"])
                    for entry in row["pins"]}
    return None


def _one(rows, name):
    if name in rows:
        return rows[name]
    return next((row for row in rows.values() if name == row.get("alias")), None)


def pin(name):
    """One pin, by its name or alias; None if it does not exist. The following functions do the same."""
    return _one(pins(), name)


def param(name):
    """One parameter."""
    return _one(params(), name)


def signal(name):
    """One signal."""
    return _one(signals(), name)


def comp(name_or_id):
    """One component."""
    return next((row for row in comps().values() if name_or_id in (row["name"], row["id"])), None)


def funct(name):
    """One function."""
    return _one(functs(), name)


def thread(name):
    """One thread."""
    return _one(threads(), name)
