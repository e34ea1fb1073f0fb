#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests the access list of docs/integrator/shop.md with a mosquitto broker: the receivers of messages that each user publishes.

usage: shop_access.py ROOT
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import paho.mqtt.client as mqtt

from publish_shop import Broker, free_port, wait_for

USERS = ('shop', 'cell', 'other')
BIRTH, DATA, COMMAND = 'spBv1.0/g/NBIRTH/cell', 'spBv1.0/g/DDATA/cell/Mill', 'spBv1.0/g/NCMD/cell'
REPORT, COPY, OFFER = 'millwright/report/shop/g/cell/Mill', 'millwright/copy/shop/g/cell/Mill', 'millwright/offer/shop/g/cell/Mill'
STATE, RECEIPT, DEVICE_COMMAND = 'spBv1.0/STATE/shop', 'millwright/stored/shop/g/cell', 'spBv1.0/g/DCMD/cell/Mill'
# The messages that a user receives: (topic, publisher). Each user publishes to each topic.
RECEIVED = {
    'shop': {(BIRTH, 'cell'), (DATA, 'cell'), (COMMAND, 'cell'), (COMMAND, 'shop'), (STATE, 'shop'), (DEVICE_COMMAND, 'cell'), (REPORT, 'cell'), (COPY, 'cell')},
    'cell': {(COMMAND, 'cell'), (COMMAND, 'shop'), (STATE, 'shop'), (RECEIPT, 'shop'), (OFFER, 'shop')},
    'other': {(STATE, 'shop')},
}


def connect(user, port, received):
    client = mqtt.Client(client_id=user)
    client.username_pw_set(user, 'secret')
    client.on_message = lambda _client, _data, message: received.add((message.topic, message.payload.decode()))
    client.connect('127.0.0.1', port)
    client.subscribe('#', 1)
    client.loop_start()
    return client


def main():
    page = (pathlib.Path(sys.argv[1]) / 'docs/integrator/shop.md').read_text()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # the broker drops root privileges
        access, passwords = folder / 'access', folder / 'passwords'
        access.write_text(re.search(r'```\n(user shop.*?)```', page, re.S).group(1))
        passwords.touch()
        program = shutil.which('mosquitto_passwd') or '/usr/bin/mosquitto_passwd'
        for user in USERS:
            subprocess.run([program, '-b', str(passwords), user, 'secret'], check=True)
        passwords.chmod(0o644)
        broker = Broker(folder, free_port(), 'allow_anonymous false', f'password_file {passwords}', f'acl_file {access}').start()
        received = {user: set() for user in USERS}
        clients = {user: connect(user, broker.port, received[user]) for user in USERS}
        try:
            wait_for(lambda: all(client.is_connected() for client in clients.values()), 'all are connected')
            time.sleep(0.3)
            for user, client in clients.items():
                for topic in (BIRTH, DATA, COMMAND, DEVICE_COMMAND, RECEIPT, REPORT, COPY, OFFER, STATE):
                    client.publish(topic, user, 1)
            # A broker delivers in order: after the last state, no more messages of that user arrive.
            wait_for(lambda: all((STATE, 'shop') in each for each in received.values()), 'the state is received')
            time.sleep(0.3)
        finally:
            for client in clients.values():
                client.loop_stop()
            broker.kill()
    wrong = [user for user in USERS if received[user] != RECEIVED[user]]
    for user in wrong:
        print(f'{user}: too much {received[user] - RECEIVED[user]}, missing {RECEIVED[user] - received[user]}')
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
