# SPDX-License-Identifier: GPL-2.0-or-later
"""Common parts of the checks of offers: a planner at the page of the shop, and an operator at the screen of a machine. Both use HTTP, and
calculate hashes by themselves."""
import hashlib
import json
import pathlib
import re
import signal
import subprocess
import urllib.error
import urllib.request
import uuid

from publish_shop import wait_for

SECTION = """
[PUBLISH]
BROKER = 127.0.0.1:{port}
GROUP = plant
NODE = {node}
DEVICE = Mill
PRIMARY_HOST = shop
STORE = store
KEEPALIVE = 5
OFFERS = yes
"""


def ask(url, method='GET', body=None):
    """Status and text of an answer; (0, reason) without one."""
    data = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data, method=method), timeout=20) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
    except OSError as error:
        return 0, str(error)


def hash_of(files):
    """As docs/integrator/shop.md describes it."""
    text = b''
    for one in files:
        content = one['text'].encode()
        text += one['name'].encode() + b'\0' + str(len(content)).encode() + b'\0' + content
    return hashlib.sha256(text).hexdigest()


def program(name, text='M2\n', **subroutines):
    return [{'name': name, 'text': text}] + [{'name': f'{key}.ngc', 'text': value} for key, value in subroutines.items()]


class Planner:
    """A person at the page of the shop."""

    def __init__(self, port):
        self.address = f'http://127.0.0.1:{port}'

    def offer(self, files, machines, request=None, **more):
        body = {'request': request or str(uuid.uuid4()), 'machines': machines, 'from': 'Eva', 'note': '', 'parts': 0, 'files': files, **more}
        return ask(f'{self.address}/offers', 'POST', body)

    def withdraw(self, number):
        return ask(f'{self.address}/offers/withdraw', 'POST', {'id': number, 'by': 'Eva'})

    def offers(self):
        """{id: offer}; None while the page does not answer."""
        status, text = ask(f'{self.address}/offers')
        return {one['id']: one for one in json.loads(text)['offers']} if status == 200 else None


class Machine:
    """`millwright publish` and `millwright ui` of a machine with the INI file of `mill`. Its programs are in the folder programs."""

    def __init__(self, mill, broker_port, node='cell'):
        self.mill, self.node, self.publisher, self.screen = mill, node, None, None
        self.programs = mill.ini.parent / 'programs'
        self.programs.mkdir()
        text = mill.ini.read_text()
        text = re.sub(r'(?m)^PROGRAM_PREFIX *=.*\n', '', text).replace('[DISPLAY]\n', '[DISPLAY]\nPROGRAM_PREFIX = programs\n')
        mill.ini.write_text(text + SECTION.format(port=broker_port, node=node))
        self.store = mill.ini.parent / 'store'
        self.log, self.screen_log = mill.folder / f'{node}-publisher.log', mill.folder / f'{node}-screen.log'

    def start_publisher(self):
        with open(self.log, 'a') as log:
            self.publisher = subprocess.Popen([self.mill.millwright, 'publish', str(self.mill.ini)], env=self.mill.env, stdout=log, stderr=log)

    def start_screen(self):
        with open(self.screen_log, 'w') as log:
            self.screen = subprocess.Popen([self.mill.millwright, 'ui', '--port', '0', str(self.mill.ini)], env=self.mill.env, stdout=log, stderr=log)
        found = []

        def has_started():
            found[:] = re.findall(r'http://127.0.0.1:(\d+)/', self.screen_log.read_text())
            return found
        wait_for(has_started, 'the screen starts')
        self.address = f'http://127.0.0.1:{found[0]}/api'

    @staticmethod
    def stop(process, how=signal.SIGKILL):
        if process is not None and process.poll() is None:
            process.send_signal(signal.SIGCONT)
            process.send_signal(how)
            process.wait(30)

    def end(self):
        self.stop(self.publisher)
        self.stop(self.screen)

    def offers(self):
        """{id: offer} of the screen; None while it does not answer."""
        status, text = ask(f'{self.address}/offers')
        return {one['id']: one for one in json.loads(text)['offers']} if status == 200 else None

    def decide(self, number, decision, **more):
        return ask(f'{self.address}/offers/{number}', 'POST', {'decision': decision, 'by': 'Jo', **more})

    def text(self, name):
        path = pathlib.Path(self.programs) / name
        return path.read_text() if path.exists() else None


def page_port(collector):
    found = []

    def has_started():
        found[:] = re.findall(r'Shop page: port (\d+)', collector.log.read_text())
        return found
    wait_for(has_started, 'the page starts')
    return int(found[-1])


def add_machine(database, node):
    """A machine that has been born once; returns its number."""
    database.ask(f"INSERT INTO machine (grp, node, device) VALUES ('plant', '{node}', 'Mill') ON CONFLICT DO NOTHING")
    return int(database.ask(f"SELECT id FROM machine WHERE node = '{node}' AND device = 'Mill'")[0][0])
