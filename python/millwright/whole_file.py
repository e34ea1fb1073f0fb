# SPDX-License-Identifier: GPL-2.0-or-later
"""Replaces files atomically, as base/temporary_file.hh does in C++."""

import errno
import fcntl
import os
import pathlib
import re
import secrets

MARK = '.millwright-'
LETTERS = '0123456789abcdefghijklmnopqrstuv'
NUM_LETTERS = 10
TRIES = 10
MOST_OF_TARGET = 200  # bytes; the name of the target may be as long as the file system allows


def prefix_of(path):
    return '.' + os.fsdecode(os.fsencode(path.name)[:MOST_OF_TARGET]) + MARK


def is_same(path, fd):
    """True if the name is that of the open file."""
    try:
        named, opened = os.lstat(path), os.fstat(fd)
    except FileNotFoundError:
        return False
    return os.path.samestat(named, opened)


def remove_dead(path):
    """Removes temporary files of this file that killed processes have left: those without a lock."""
    pattern = re.compile(re.escape(prefix_of(path)) + f'[{LETTERS}]{{{NUM_LETTERS}}}')
    for name in os.listdir(path.parent):
        if not pattern.fullmatch(name):
            continue
        temporary = path.parent / name
        try:
            fd = os.open(temporary, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY)
        except OSError:
            continue
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if is_same(temporary, fd) and os.fstat(fd).st_nlink <= 1:
                os.unlink(temporary)
        except OSError:
            pass  # a process writes it, or the file system has no locks
        finally:
            os.close(fd)


def create(path):
    """Name and descriptor of a new locked file."""
    for _ in range(TRIES):
        temporary = path.parent / (prefix_of(path) + ''.join(secrets.choice(LETTERS) for _ in range(NUM_LETTERS)))
        fd = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:  # another process is removing it as abandoned
            os.close(fd)
            continue
        except OSError:
            return temporary, fd  # not removed without locks
        if is_same(temporary, fd):
            return temporary, fd
        os.close(fd)
    raise OSError(errno.EBUSY, 'other processes remove its temporary files', str(path))


def write_whole(path, text, errors='strict'):
    """Replaces the file by `text` in UTF-8. An existing file keeps its permissions. After an OSError the old file is unchanged."""
    path = pathlib.Path(path)
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, 'not a regular file', str(path))
    remove_dead(path)
    data = text.encode('utf-8', errors)
    temporary, fd = create(path)
    with os.fdopen(fd, 'wb') as file:
        try:
            file.write(data)
            file.flush()
            os.fchmod(fd, os.stat(path).st_mode & 0o7777 if path.exists() else 0o644)
            os.fsync(fd)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
