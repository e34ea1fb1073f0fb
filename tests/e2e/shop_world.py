# SPDX-License-Identifier: GPL-2.0-or-later
"""Common parts of the checks of `millwright shop`: a private PostgreSQL in a temporary folder (Unix socket only, ordinary user),
and the collector."""
import os
import pathlib
import pwd
import shutil
import signal
import subprocess
import sys

from publish_shop import wait_for

SKIPPED = 77


def server_folder():
    """The folder of PostgreSQL's programs; None if it is not installed."""
    folders = sorted(pathlib.Path('/usr/lib/postgresql').glob('*/bin'), key=lambda each: int(each.parent.name), reverse=True)
    on_path = shutil.which('initdb')
    folders += [pathlib.Path(on_path).resolve().parent] if on_path else []
    return next((folder for folder in folders if all((folder / name).exists() for name in ('initdb', 'postgres', 'psql'))), None)


def skip_without_database():
    if server_folder() is None:
        print('SKIPPED: PostgreSQL is not installed (script/bootstrap --shop installs it).')
        sys.exit(SKIPPED)


class Postgres:
    """The server does not run as root. Root starts it as the user "nobody"."""

    def __init__(self, folder):
        self.bin, self.data, self.sockets = server_folder(), pathlib.Path(folder) / 'database', pathlib.Path(folder) / 'socket'
        self.log, self.process = pathlib.Path(folder) / 'database.log', None
        self.user = pwd.getpwnam('nobody') if os.geteuid() == 0 else None
        for path in (self.data, self.sockets):
            path.mkdir()
            if self.user:
                os.chown(path, self.user.pw_uid, self.user.pw_gid)
        # Collector and server reach their folders through the temporary folder.
        pathlib.Path(folder).chmod(0o755)
        self.sockets.chmod(0o755)
        self.connection = f'host={self.sockets} dbname=postgres user=shop'
        self.run(str(self.bin / 'initdb'), '-D', str(self.data), '-U', 'shop', '-A', 'trust', '-E', 'UTF8', '--no-instructions', '--no-sync', '--locale=C')

    def as_user(self):
        return {'user': self.user.pw_uid, 'group': self.user.pw_gid, 'extra_groups': []} if self.user else {}

    def run(self, *words):
        done = subprocess.run(words, cwd='/', capture_output=True, text=True, check=False, **self.as_user())
        if done.returncode:
            raise RuntimeError(f'{words[0]}: {done.stdout}{done.stderr}')

    def start(self, *options):
        """Does not wait for the disk: a kill loses no data that the kernel has."""
        with open(self.log, 'a') as log:
            self.process = subprocess.Popen([str(self.bin / 'postgres'), '-D', str(self.data), '-k', str(self.sockets), '-h', '',
                '-c', 'max_connections=20', '-c', 'fsync=off', *options], cwd='/', stdout=log, stderr=log, **self.as_user())
        wait_for(self.is_there, 'the database starts')
        return self

    def psql(self, sql):
        return subprocess.run([str(self.bin / 'psql'), '-X', '-q', '-A', '-t', '-v', 'ON_ERROR_STOP=1', self.connection, '-c', sql],
            capture_output=True, text=True, check=False)

    def is_there(self):
        return self.psql('SELECT 1').returncode == 0

    def ask(self, sql):
        """Rows as texts."""
        answer = self.psql(sql)
        if answer.returncode:
            raise RuntimeError(answer.stderr)
        return [line.split('|') for line in answer.stdout.splitlines()]

    def family(self):
        """The server and its processes; those of a killed server end later by themselves."""
        children = pathlib.Path(f'/proc/{self.process.pid}/task/{self.process.pid}/children').read_text().split()
        return [self.process.pid, *(int(child) for child in children)]

    def kill(self):
        """Kills the server and all its processes at once, as in a crash."""
        family = self.family()
        self.signal(signal.SIGKILL, family)
        self.process.wait()
        wait_for(lambda: not any(pathlib.Path(f'/proc/{pid}').exists() for pid in family), 'the processes of the database end')

    def signal(self, what, family=None):
        for pid in family or self.family():
            try:
                os.kill(pid, what)
            except ProcessLookupError:
                pass

    def end(self):
        self.signal(signal.SIGCONT)
        self.process.send_signal(signal.SIGINT)
        self.process.wait()


class Collector:
    def __init__(self, program, folder, database, port, *lines):
        self.ini = pathlib.Path(folder) / 'shop.ini'
        self.ini.write_text('\n'.join(['[SHOP]', f'BROKER = 127.0.0.1:{port}', f'DATABASE = {database.connection}', *lines]) + '\n')
        self.program, self.log, self.process = program, pathlib.Path(folder) / 'collector.log', None

    def start(self):
        with open(self.log, 'a') as log:
            self.process = subprocess.Popen([self.program, str(self.ini)], stdout=log, stderr=log)
        return self

    def kill(self, how=signal.SIGKILL):
        self.process.send_signal(signal.SIGCONT)
        self.process.send_signal(how)
        return self.process.wait()

    def hang(self):
        self.process.send_signal(signal.SIGSTOP)

    def go_on(self):
        self.process.send_signal(signal.SIGCONT)
