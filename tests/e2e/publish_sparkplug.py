#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""`millwright publish` for a running mill, with mosquitto as broker and a decoder that protoc makes: births, values, rebirth, deaths,
a broker that hangs or ends, TLS with certificates of both sides, and a wrong section.

usage: publish_sparkplug.py MILLWRIGHT HALCMD ROOT
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

from mill_by_hand import Findings, Mill
from publish_shop import Broker, Host, free_port, make_decoder, wait_for

FOUND = Findings()
expect = FOUND.expect
TOPIC = 'spBv1.0/plant/{}/cell'
SECTION = """
[PUBLISH]
BROKER = 127.0.0.1:{port}
GROUP = plant
NODE = cell
DEVICE = Mill
STORE = store
INTERVAL = 0.05
KEEPALIVE = 5
"""


class Shop:
    """A mill, its broker and a host."""

    def __init__(self, millwright, halcmd, root, folder):
        self.millwright, self.folder = millwright, folder
        self.mill = Mill(millwright, halcmd, root, folder, 'publish')
        self.plain = self.mill.ini.read_text()
        self.decoder = make_decoder(root, folder)
        self.machine = self.publisher = None

    def configure(self, port, more=''):
        self.mill.ini.write_text(self.plain + SECTION.format(port=port) + more)

    def start_machine(self):
        self.machine = subprocess.Popen([self.millwright, 'start', '--no-display', str(self.mill.ini)], env=self.mill.env,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def end_machine(self):
        self.machine.send_signal(signal.SIGTERM)
        self.machine.wait(30)

    def start_publisher(self):
        log = open(self.folder / 'publisher.log', 'a')
        self.publisher = subprocess.Popen([self.millwright, 'publish', str(self.mill.ini)], env=self.mill.env, stdout=log, stderr=log)

    def end_publisher(self, how=signal.SIGTERM):
        self.publisher.send_signal(how)
        return self.publisher.wait(20)

    def switch_on(self):
        """Operates the machine through HAL, as a person at the panel does; it homes at once."""
        for pin in ('halui.estop.reset', 'halui.machine.on', 'halui.home-all'):
            self.mill.set_pin(pin, '1')
            time.sleep(0.3)
            self.mill.set_pin(pin, '0')
        wait_for(lambda: self.mill.pin('halui.machine.is-on') == 'TRUE', 'the machine is on')
        wait_for(lambda: all(self.mill.pin(f'halui.joint.{i}.is-homed') == 'TRUE' for i in range(3)), 'the machine is homed')


def check_births(shop, host):
    wait_for(lambda: host.count('DBIRTH') == 1, 'births')
    topics = [topic for topic, *_ in host.messages]
    expect(topics[:2] == [TOPIC.format('NBIRTH'), TOPIC.format('DBIRTH') + '/Mill'], 'births come first', topics)
    birth = {metric.name: metric for metric in host.messages[1][1].metrics}
    expect(len(birth) > 100, 'the birth has all metrics', len(birth))
    expect(birth['State'].string_value == 'ESTOP' and birth['State'].datatype == 12, 'the state')
    position = birth['Axes/X/Position']
    expect(position.datatype == 10 and list(position.properties.keys) == ['engUnit'] and
           position.properties.values[0].string_value == 'mm', 'the unit of a position', position)
    expect(abs(position.timestamp - time.time() * 1000) < 60000, 'times are UTC')


def check_values(shop, host):
    shop.switch_on()
    wait_for(lambda: host.has(State='ON'), 'the state ON is published')
    wait_for(lambda: host.newest.get('Joints/0/Homed') is True, 'the homed joint is published')
    shop.mill.set_pin('halui.mode.manual', '1')
    wait_for(lambda: shop.mill.pin('halui.mode.is-manual') == 'TRUE', 'manual mode')
    shop.mill.set_pin('halui.mode.teleop', '1')
    wait_for(lambda: shop.mill.pin('halui.mode.is-teleop') == 'TRUE', 'axes are jogged')
    shop.mill.set_pin('halui.mode.teleop', '0')
    shop.mill.set_pin('halui.axis.jog-speed', '600')
    shop.mill.set_pin('halui.axis.x.plus', '1')
    time.sleep(0.5)
    shop.mill.set_pin('halui.axis.x.plus', '0')
    wait_for(lambda: (host.newest.get('Axes/X/Position') or 0) > 1, 'the position is published')

    def is_same():
        return abs((host.newest.get('Axes/X/Position') or 0) - shop.mill.position()) < 0.01
    wait_for(is_same, 'the position of HAL and of the host are the same')


def check_rebirth(shop, host):
    before = host.count('DBIRTH')
    host.send_rebirth('plant', 'cell')
    wait_for(lambda: host.count('DBIRTH') == before + 1, 'a rebirth')


def check_hang(shop, host, broker):
    """A broker that hangs delays nothing on the machine: the machine continues, and its values are sent later."""
    broker.hang()
    start = shop.mill.position()
    shop.mill.set_pin('halui.axis.x.plus', '1')
    time.sleep(0.6)
    shop.mill.set_pin('halui.axis.x.plus', '0')
    moved = shop.mill.position() - start
    time.sleep(12.5)  # longer than the publisher waits for the answer
    expect(moved > 1, 'the machine moves while the broker hangs', moved)
    expect(shop.publisher.poll() is None, 'the publisher lives while the broker hangs')
    broker.go_on()

    def is_same():
        return abs((host.newest.get('Axes/X/Position') or 0) - shop.mill.position()) < 0.01
    wait_for(is_same, 'values of the time are there')
    with host.lock:
        history = [metric for _, payload, *_ in host.messages for metric in payload.metrics if metric.is_historical]
    expect(history, 'values that waited are marked as history')


def check_broker_loss(shop, host, broker):
    broker.kill()
    shop.mill.set_pin('halui.axis.x.minus', '1')
    time.sleep(0.5)
    shop.mill.set_pin('halui.axis.x.minus', '0')
    broker.start()
    before = host.count('NBIRTH')
    wait_for(lambda: host.count('NBIRTH') > before, 'a birth at the new broker')

    def is_same():
        return abs((host.newest.get('Axes/X/Position') or 0) - shop.mill.position()) < 0.01
    wait_for(is_same, 'the position after the loss of the broker')


def check_deaths(shop, host):
    shop.end_machine()
    wait_for(lambda: host.verbs()[-1] == 'DDEATH', 'the death of the machine')
    expect(host.count('NDEATH') == 0 or host.verbs()[-1] == 'DDEATH', 'the node lives')
    births = host.count('DBIRTH')
    shop.start_machine()
    wait_for(lambda: host.count('DBIRTH') == births + 1, 'the machine is back')
    deaths = host.count('NDEATH')
    expect(shop.end_publisher() == 0, 'the publisher ends in order')
    wait_for(lambda: host.count('NDEATH') == deaths + 1, 'the death of the node')
    time.sleep(0.5)
    expect(host.count('NDEATH') == deaths + 1, 'the broker does not send the will after an orderly end')
    shop.start_publisher()
    wait_for(lambda: host.count('DBIRTH') == births + 2, 'births after a start')
    shop.end_publisher(signal.SIGKILL)
    wait_for(lambda: host.count('NDEATH') == deaths + 2, 'the will of a killed node')
    with host.lock:
        numbers = {}
        for topic, payload, qos, retain in host.messages:
            verb = topic.split('/')[2]
            expect(not retain, f'{verb} is not retained')
            for metric in payload.metrics:
                if metric.name == 'bdSeq' and verb in ('NBIRTH', 'NDEATH'):
                    numbers.setdefault(verb, []).append(metric.long_value)
    births, ends = numbers['NBIRTH'], numbers['NDEATH']
    expect(births == sorted(births), 'bdSeq grows, over starts too', births)
    expect(ends[-1] == births[-1], 'the death has the number of its birth', births, ends)


def check_clean_session(broker):
    """In the log of the broker, p2 is MQTT 3.1.1 and c1 a clean session."""
    lines = [line for line in broker.log.read_text().splitlines() if 'as plant/cell' in line]
    expect(lines and all('(p2, c1, k5' in line for line in lines), 'the session is clean', lines)


def run(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def make_certificates(folder):
    run('openssl', 'req', '-x509', '-newkey', 'rsa:2048', '-nodes', '-days', '2', '-subj', '/CN=test authority', '-keyout',
        f'{folder}/ca.key', '-out', f'{folder}/ca.pem')
    (folder / 'names').write_text('subjectAltName=IP:127.0.0.1\n')
    for name in ('broker', 'mill'):
        run('openssl', 'req', '-newkey', 'rsa:2048', '-nodes', '-subj', f'/CN={name}', '-keyout', f'{folder}/{name}.key', '-out',
            f'{folder}/{name}.csr')
        run('openssl', 'x509', '-req', '-in', f'{folder}/{name}.csr', '-CA', f'{folder}/ca.pem', '-CAkey', f'{folder}/ca.key',
            '-CAcreateserial', '-days', '2', '-extfile', f'{folder}/names', '-out', f'{folder}/{name}.pem')
    for path in folder.iterdir():
        path.chmod(0o644)


def check_tls(shop):
    folder = shop.folder / 'tls'
    folder.mkdir()
    make_certificates(folder)
    run('mosquitto_passwd', '-b', '-c', str(folder / 'users'), 'mill', 'secret')
    os.chmod(folder / 'users', 0o644)
    os.chmod(shop.folder, 0o755)
    broker = Broker(shop.folder, free_port(), f'cafile {folder}/ca.pem', f'certfile {folder}/broker.pem', f'keyfile {folder}/broker.key',
                    'require_certificate true', 'allow_anonymous false', f'password_file {folder}/users').start()
    password = folder / 'password'
    password.write_text('secret\n')
    password.chmod(0o600)
    tls = f'TLS = yes\nCA_FILE = {folder}/ca.pem\nCERTIFICATE = {folder}/mill.pem\nKEY = {folder}/mill.key\nUSER = mill\nPASSWORD_FILE = {password}\n'
    host = Host(shop.decoder, broker.port, user='mill', password='secret', ca_certs=f'{folder}/ca.pem', certfile=f'{folder}/mill.pem',
                keyfile=f'{folder}/mill.key')
    shop.configure(broker.port, tls)
    shop.start_publisher()
    wait_for(lambda: host.count('DBIRTH') == 1, 'births by TLS')
    shop.end_publisher()
    # Another authority: the publisher does not talk to this broker.
    other = folder / 'other'
    other.mkdir()
    make_certificates(other)
    births = host.count('NBIRTH')
    shop.configure(broker.port, tls.replace(f'{folder}/ca.pem', f'{other}/ca.pem'))
    shop.start_publisher()
    wait_for(lambda: 'The connection to the broker is lost' in (shop.folder / 'publisher.log').read_text()
             or 'cannot connect' in (shop.folder / 'publisher.log').read_text(), 'a broker with a foreign certificate is reported')
    expect(host.count('NBIRTH') == births, 'nothing is sent to a broker with a foreign certificate')
    shop.end_publisher()
    password.write_text('wrong\n')
    shop.configure(broker.port, tls)
    shop.start_publisher()
    wait_for(lambda: 'The broker rejects the connection' in (shop.folder / 'publisher.log').read_text(), 'a wrong password is reported')
    shop.end_publisher()
    host.end()
    broker.kill()


def check_section(shop):
    def check(text):
        shop.mill.ini.write_text(shop.plain + text)
        done = subprocess.run([shop.millwright, 'publish', '--check', str(shop.mill.ini)], capture_output=True, text=True, check=False)
        return done.returncode, done.stderr
    line = len(shop.plain.splitlines())
    expect(check(SECTION.format(port=1883)) == (0, ''), 'a right section', check(SECTION.format(port=1883)))
    code, text = check('[PUBLISH]\nBROKER = a:b\n')
    expect(code == 1 and re.search(rf':{line + 2}:10: error: ', text), 'a wrong broker has its line and column', text)
    code, text = check('')
    expect(code == 1 and 'no section [PUBLISH]' in text, 'a missing section', text)


def main():
    millwright, halcmd, root = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shop = Shop(millwright, halcmd, root, folder)
        check_section(shop)
        broker = Broker(folder, free_port()).start()
        host = Host(shop.decoder, broker.port)
        shop.configure(broker.port)
        shop.start_publisher()
        try:
            wait_for(lambda: host.count('NBIRTH') == 1, 'the node is born without the machine')
            expect(host.count('DBIRTH') == 0, 'no machine, no birth of it')
            shop.start_machine()
            check_births(shop, host)
            check_values(shop, host)
            check_rebirth(shop, host)
            check_hang(shop, host, broker)
            check_broker_loss(shop, host, broker)
            check_deaths(shop, host)
            check_clean_session(broker)
            expect(not host.problems, 'sequence numbers, aliases and keys', host.problems[:10])
            host.end()
            check_tls(shop)
        finally:
            for process in (shop.publisher, shop.machine, broker.process):
                if process and process.poll() is None:
                    process.send_signal(signal.SIGCONT)
                    process.terminate()
                    process.wait(30)
        if FOUND.failures:
            print((folder / 'publisher.log').read_text())
    sys.exit(FOUND.status())


if __name__ == '__main__':
    main()
