# SPDX-License-Identifier: GPL-2.0-or-later
"""Files and disks: paths that are not files, a disk that is full or slow, folders and files that are removed or replaced."""
import contextlib
import os
import pathlib
import random
import subprocess
import sys
import time

from attack_types import attack

BLKIO = pathlib.Path('/sys/fs/cgroup/blkio')


@attack('files.open')
def open_odd(scene, rng):
    """Programs that are not files, opened by a Python client while another program runs."""
    paths = ['/dev/zero', '/dev/ptmx', '/dev/stdin', str(scene.nc / 'pipe.ngc'), str(scene.nc), '/proc/self/mem', str(scene.nc / 'loop.ngc'), '/nothing']
    rng.shuffle(paths)
    code = f'import linuxcnc\nc = linuxcnc.command()\nfor p in {paths!r}:\n    c.program_open(p)\n    c.wait_complete(0.5)\n'
    subprocess.run([sys.executable, '-c', code], env=scene.env, check=False, capture_output=True, timeout=10)


@attack('files.full_disk', needs=('mount',))
def full_disk(scene, rng):
    """No data can be written for some time, not even a byte."""
    blocks = scene.folder / 'filler'
    try:
        with blocks.open('wb', buffering=0) as file:
            with contextlib.suppress(OSError):
                while True:
                    file.write(b'\0' * (1 << 20))
            with contextlib.suppress(OSError):
                while True:
                    file.write(b'\0' * 512)
            scene.begins()
            scene.wait(rng.uniform(0.3, 2))
    finally:
        blocks.unlink(missing_ok=True)
        scene.ends()


@attack('files.slow_disk', causes=r'interpreter has been busy', needs=('cgroup', 'mount'))
def slow_disk(scene, rng):
    """The disk transfers only this number of bytes per second."""
    group = BLKIO / scene.cgroup
    rate = rng.choice((20_000, 200_000, 2_000_000))
    group.mkdir(exist_ok=True)
    try:
        for limit in ('read', 'write'):
            (group / f'blkio.throttle.{limit}_bps_device').write_text(f'{scene.device} {rate}')
        for process in scene.processes.values():
            with contextlib.suppress(OSError):
                (group / 'cgroup.procs').write_text(str(process))
        scene.begins()
        for path in scene.nc.glob('*.ngc'):
            if path.is_file():
                descriptor = os.open(path, os.O_RDONLY)
                os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
                os.close(descriptor)
        scene.wait(rng.uniform(0.3, 2))
    finally:
        for limit in ('read', 'write'):
            (group / f'blkio.throttle.{limit}_bps_device').write_text(f'{scene.device} 0')
        for process in (group / 'cgroup.procs').read_text().split():
            with contextlib.suppress(OSError):
                (BLKIO / 'cgroup.procs').write_text(process)
        scene.ends()
        with contextlib.suppress(OSError):
            group.rmdir()


@attack('files.removed_folder', causes=r'cut\.ngc|No such file|not found|not saved|cannot')
def removed_folder(scene, rng):
    """The folder of the programs, or the folder of the machine's files, is missing for a time."""
    folder = rng.choice((scene.nc, scene.ini.parent))
    away = folder.with_name(folder.name + '.away')
    folder.rename(away)
    try:
        scene.begins()
        scene.wait(rng.uniform(0.1, 1.5))
    finally:
        with contextlib.suppress(OSError):
            folder.rmdir()
        away.rename(folder)
        scene.ends()


@attack('files.replaced_state')
def replaced_state(scene, rng):
    """The parameter file or the tool table is removed or replaced by a pipe, a folder or a link."""
    path = scene.ini.parent / rng.choice(('mill_mm.var', 'mill_mm.tbl'))
    kept = path.with_name(path.name + '.kept')
    if path.is_symlink() or not path.is_file():
        return
    path.rename(kept)
    kind = rng.randrange(4)
    try:
        (lambda: None, lambda: os.mkfifo(path), path.mkdir, lambda: path.symlink_to('/dev/full'))[kind]()
        scene.begins()
        scene.wait(rng.uniform(0.1, 1.5))
    finally:
        while not path.parent.is_dir():  # files.removed_folder has moved it for a time
            time.sleep(0.01)
        if path.is_dir():
            path.rmdir()
        if path.is_symlink() or (path.exists() and not path.is_file()):
            path.unlink()
        if path.exists():
            kept.unlink()  # the machine has written a new file
        else:
            kept.rename(path)
        scene.ends()


@attack('files.program_changed', causes=r'cut\.ngc|changed|program')
def program_changed(scene, rng):
    """The running program is removed, truncated, or replaced by a pipe."""
    path = scene.nc / 'cut.ngc'
    kind = rng.randrange(3)
    if kind == 0:
        path.unlink()
    elif kind == 1:
        os.truncate(path, rng.randrange(path.stat().st_size))
    else:
        path.unlink()
        os.mkfifo(path)
    scene.wait(0.1)


@attack('files.many')
def many(scene, rng):
    """A program folder with thousands of files, circular links and names that are not text."""
    made = []
    count = rng.choice((100, 1500))
    try:
        folder = os.open(scene.nc, os.O_DIRECTORY)  # another attack may move it
    except FileNotFoundError:
        return
    try:
        for i in range(count):
            made.append(b'%d_' % i + rng.choice((b'a.ngc', b'\xff\xfe.ngc', b'b' * 200 + b'.ngc')))
            with contextlib.suppress(OSError):
                if rng.random() < 0.2:
                    os.symlink(made[-1], made[-1], dir_fd=folder)
                else:
                    os.close(os.open(made[-1], os.O_CREAT | os.O_WRONLY, dir_fd=folder))
            if time.monotonic() > scene.deadline:
                break
        scene.wait(0.5)
    finally:
        random.shuffle(made)
        for path in made:
            with contextlib.suppress(OSError):
                os.unlink(path, dir_fd=folder)
        os.close(folder)
