# SPDX-License-Identifier: GPL-2.0-or-later
"""Common parts of the checks of `millwright publish`: a broker (mosquitto), a Sparkplug host application with a decoder that
protoc generates from the declaration, and a store whose key is the metric and its time."""
import importlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

import paho.mqtt.client as mqtt

LIMIT_S = 40
# The program is not in the path of ordinary users.
BROKER = shutil.which('mosquitto', path=os.environ.get('PATH', '') + os.pathsep + '/usr/sbin') or 'mosquitto'


def free_port():
    with socket.socket() as place:
        place.bind(('127.0.0.1', 0))
        return place.getsockname()[1]


def wait_for(condition, what, limit_s=LIMIT_S):
    """Waits until the condition holds; raises an error if it never does."""
    end = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(what)
        time.sleep(0.02)


def make_decoder(root, folder):
    """The module of payloads."""
    proto = pathlib.Path(root) / 'src/clients/publish/sparkplug/sparkplug_b.proto'
    subprocess.run(['protoc', f'--proto_path={proto.parent}', f'--python_out={folder}', proto.name], check=True)
    sys.path.insert(0, str(folder))
    return importlib.import_module('sparkplug_b_pb2')


class Broker:
    def __init__(self, folder, port, *lines):
        self.port, self.process = port, None
        self.log = pathlib.Path(folder) / f'broker-{port}.log'
        self.config = pathlib.Path(folder) / f'broker-{port}.conf'
        self.config.write_text('\n'.join([f'listener {port} 127.0.0.1', *(lines or ['allow_anonymous true'])]) + '\n')

    def start(self):
        with open(self.log, 'a') as log:
            self.process = subprocess.Popen([BROKER, '-v', '-c', str(self.config)], stdout=log, stderr=log)

        def is_there():
            try:
                socket.create_connection(('127.0.0.1', self.port), 1).close()
                return True
            except OSError:
                return False
        wait_for(is_there, 'the broker starts')
        return self

    def kill(self, how=signal.SIGKILL):
        self.process.send_signal(signal.SIGCONT)
        self.process.send_signal(how)
        self.process.wait()

    def hang(self):
        self.process.send_signal(signal.SIGSTOP)

    def go_on(self):
        self.process.send_signal(signal.SIGCONT)


def value_of(metric):
    return None if metric.is_null else getattr(metric, metric.WhichOneof('value'))


class Host:
    """A host application: learns aliases from births, and stores values by (device, metric, time)."""

    def __init__(self, decoder, port, name='', **tls):
        self.decoder, self.name = decoder, name
        self.at = int(time.time() * 1000)  # the will and the birth of a host have the same time
        self.lock = threading.Lock()
        self.messages = []       # (topic, payload, qos, retain)
        self.stored = {}         # (topic of the device, metric, time): value
        self.aliases = {}        # topic of the node or device: {alias: name}
        self.newest = {}         # metric: value, not of history
        self.problems, self.seq = [], {}
        self.client = mqtt.Client(client_id=f'host-{name or id(self)}', clean_session=True)
        if name:
            self.client.will_set(f'spBv1.0/STATE/{name}', self.state(False), 1, True)
        if tls:
            self.client.username_pw_set(tls.pop('user'), tls.pop('password'))
            self.client.tls_set(**tls)
        self.client.on_connect = self.connected
        self.client.on_message = self.take
        self.client.reconnect_delay_set(1, 1)
        self.client.connect_async('127.0.0.1', port, 5)
        self.client.loop_start()

    def state(self, is_online):
        return '{"online":%s,"timestamp":%d}' % (str(is_online).lower(), self.at)

    def connected(self, client, *_):
        client.subscribe('spBv1.0/#', 1)
        with self.lock:
            known = list(self.seq)
            self.seq.clear()
        for group, node in known:  # messages sent in between are not known
            self.send_rebirth(group, node)
        if self.name:
            client.publish(f'spBv1.0/STATE/{self.name}', self.state(True), 1, True)

    def end(self):
        self.client.loop_stop()
        self.client.disconnect()

    def send_rebirth(self, group, node):
        payload = self.decoder.Payload(timestamp=int(time.time() * 1000))
        payload.metrics.add(name='Node Control/Rebirth', datatype=11, boolean_value=True)
        self.client.publish(f'spBv1.0/{group}/NCMD/{node}', payload.SerializeToString(), 0, False)

    def verbs(self):
        with self.lock:
            return [topic.split('/')[2] for topic, *_ in self.messages]

    def count(self, verb):
        return self.verbs().count(verb)

    def take(self, _client, _data, message):
        parts = message.topic.split('/')
        if parts[1] == 'STATE' or parts[2] in ('NCMD', 'DCMD'):
            return
        payload = self.decoder.Payload.FromString(message.payload)
        with self.lock:
            self.messages.append((message.topic, payload, message.qos, message.retain))
            self.check(parts, payload)
            self.store(parts, payload)

    def check(self, parts, payload):
        node, verb = (parts[1], parts[3]), parts[2]
        if verb == 'NBIRTH':
            self.seq[node] = 0
        elif verb == 'NDEATH':
            return
        elif node not in self.seq:
            return self.send_rebirth(*node)  # the node was born before the host started
        else:
            self.seq[node] = (self.seq[node] + 1) % 256
        if payload.seq != self.seq[node]:
            self.problems.append(f'{verb} has seq {payload.seq}, not {self.seq[node]}')
            self.seq[node] = payload.seq

    def store(self, parts, payload):
        device = '/'.join([parts[1], *parts[3:]])
        if parts[2] in ('NBIRTH', 'DBIRTH'):
            self.aliases[device] = {metric.alias: metric.name for metric in payload.metrics}
        if parts[2] not in ('DBIRTH', 'DDATA', 'NBIRTH', 'NDATA'):
            return
        for metric in payload.metrics:
            name = self.aliases.get(device, {}).get(metric.alias)
            if device not in self.aliases:
                # the node was born before the host started: a rebirth is requested, and the value is sent again
                continue
            if name is None:
                self.problems.append(f'{parts[2]} has the unknown alias {metric.alias}')
                continue
            key, value = (device, name, metric.timestamp), value_of(metric)
            if self.stored.setdefault(key, value) != value and not name.startswith(('bdSeq', 'Node Control', 'Store')):
                self.problems.append(f'{key} has two values: {self.stored[key]} and {value}')
            if not metric.is_historical:
                self.newest[name] = value

    def has(self, **values):
        """The newest values, as a dict; blanks and / in names are replaced by _."""
        with self.lock:
            return all(self.newest.get(name) == value for name, value in values.items())
