# SPDX-License-Identifier: GPL-2.0-or-later
"""Clients of the web server, of NML and of linuxcncrsh that send garbage, never read, disconnect, or request endless work; half of the web
clients belong to another user. None of them may stop a machine."""
import base64
import contextlib
import json
import os
import random
import socket
import struct

from attack_types import attack

NOBODY = 65534
OWN_CONNECTIONS = 8       # of 64: a user may use all connections of a machine that he has started
FOREIGN_CONNECTIONS = 40
# Commands that are rejected both by a machine that is cutting and by an idle machine in AUTO mode.
REJECTED = ('Null', 'JogContinuous', 'JogIncrement', 'JogAbsolute', 'LoadCompensation', 'RigidTapMove', 'OpenProgram', 'Mdi')


def become_other_user(rng):
    """Becomes another user in half of the cases; returns the number of connections that the user may have."""
    if os.geteuid() != 0 or rng.random() < 0.5:
        return OWN_CONNECTIONS
    os.setgroups([])
    os.setgid(NOBODY)
    os.setuid(NOBODY)
    return FOREIGN_CONNECTIONS


def connect(port):
    peer = socket.create_connection(('127.0.0.1', port), timeout=2)
    peer.settimeout(0.5)
    return peer


def send(peer, data):
    """Sends until the peer accepts no more."""
    with contextlib.suppress(OSError):
        peer.sendall(data)


def request(port, target, method='GET', headers='', body=b''):
    return (f'{method} {target} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {len(body)}\r\n{headers}\r\n').encode() + body


def hang_up(peer, rng):
    """Closes the connection in order, or as a pulled cable does."""
    with contextlib.suppress(OSError):
        if rng.random() < 0.5:
            peer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        peer.close()


def rubbish(rng, port):
    size = rng.choice((1, 20, 400, 20_000, 200_000))
    return rng.choice((
        lambda: rng.randbytes(size),
        lambda: b'GET / HTTP/1.1\r\n' + b'X: y\r\n' * size,
        lambda: b'GET /' + b'a' * size + b' HTTP/1.1\r\n\r\n',
        lambda: request(port, '/api/files/../../../etc/passwd'),
        lambda: request(port, '/api/hal/x', 'PUT', body=b'{' * size),
        lambda: request(port, '/api/preferences', 'PUT', body=b'[' * size),
        lambda: b'POST /api/login HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nContent-Length: 99999999999999999999\r\n\r\n' % port,
        lambda: b'POST /api/login HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n',
        lambda: b'\x16\x03\x01' + rng.randbytes(size)))()


@attack('web.rubbish')
def web_rubbish(scene, rng):
    count = become_other_user(rng)
    peers = []
    while scene.wait(rng.choice((0.0, 0.01, 0.05))) and len(peers) < 200:
        with contextlib.suppress(OSError):
            peers.append(connect(scene.ports['web']))
            send(peers[-1], rubbish(rng, scene.ports['web']))
        if len(peers) >= count:
            hang_up(peers.pop(0), rng)


@attack('web.unread')
def web_unread(scene, rng):
    """Requests large files and does not read the answers."""
    count = become_other_user(rng)
    peers = []
    for _ in range(count):
        with contextlib.suppress(OSError):
            peers.append(connect(scene.ports['web']))
            send(peers[-1], request(scene.ports['web'], rng.choice(('/api/files/large.ngc', '/api/schema', '/api/path?file=slow.ngc'))))
    scene.wait(2)


@attack('web.work')
def web_work(scene, rng):
    """Requests the paths and times of endless programs, and disconnects."""
    count = min(4, become_other_user(rng))
    peers = []
    while scene.wait(0.1):
        with contextlib.suppress(OSError):
            peers.append(connect(scene.ports['web']))
            send(peers[-1], request(scene.ports['web'], rng.choice(('/api/times?file=slow.ngc&feed=0.001', '/api/path?file=slow.ngc', '/api/times?file=slip.ngc'))))
        if len(peers) >= count:
            hang_up(peers.pop(rng.randrange(len(peers))), rng)


def open_socket(port):
    peer = connect(port)
    key = base64.b64encode(os.urandom(16)).decode()
    peer.sendall(request(port, '/api/socket', headers='Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n'
                         f'Sec-WebSocket-Key: {key}\r\nOrigin: http://127.0.0.1:{port}\r\n'))
    peer.recv(4096)
    return peer


def frame(text, rng, head=0x81):
    mask = rng.randbytes(4)
    size = bytes([0x80 | len(text)]) if len(text) < 126 else b'\xfe' + struct.pack('>H', len(text))
    return bytes([head]) + size + mask + bytes(c ^ mask[i % 4] for i, c in enumerate(text))


@attack('web.sockets')
def web_sockets(scene, rng):
    """Web sockets with broken frames, texts that are not requests, and clients that do not read."""
    become_other_user(rng)
    peers = []
    for _ in range(3):
        with contextlib.suppress(OSError):
            peers.append(open_socket(scene.ports['web']))
    while peers and scene.wait(rng.choice((0.0, 0.002, 0.02))):
        peer = rng.choice(peers)
        kind = rng.randrange(6)
        if kind == 0:
            send(peer, frame(rng.randbytes(rng.randrange(100)), rng, rng.randrange(256)))
        elif kind == 1:
            send(peer, frame(b'[' * rng.randrange(60_000), rng))
        elif kind == 2:
            send(peer, frame(json.dumps({'watch': [f'joint.{i}.pos-cmd' for i in range(rng.randrange(400))]}).encode(), rng))
        else:
            value = rng.choice((None, -1, 1e308, 'x' * 500, [], {}, True))
            send(peer, frame(json.dumps({'id': value, 'command': {'message': rng.choice(('Mdi', 'JogContinuous', '', 5)), 'line': value}}).encode(), rng))


def commands_of(scene):
    """Sends the requests of REJECTED with their fields."""
    peer = connect(scene.ports['web'])
    send(peer, request(scene.ports['web'], '/api/schema', headers='Connection: close\r\n'))
    body = b''
    with contextlib.suppress(OSError):
        while more := peer.recv(1 << 16):
            body += more
    schema = json.loads(body.partition(b'\r\n\r\n')[2] or b'{}')
    return [command for command in schema.get('commands', []) if command['name'] in REJECTED]


def random_value(rng, field):
    kind = str(field.get('type', ''))
    if 'bool' in kind:
        return rng.random() < 0.5
    if 'text' in kind:
        return rng.choice(('', 'G0 X5', '/dev/zero', '/dev/ptmx', 'x' * 200, '#1=[' + '1+' * 2000 + '1]', '(LOGOPEN,/dev/ptmx)', ';py,1'))
    return rng.choice((0, 1, -1, 2, 9, 1e9, -1e-9, 4294967295))


@attack('web.commands')
def web_commands(scene, rng):
    """Sends commands that a machine rejects while it is cutting."""
    commands = commands_of(scene)
    become_other_user(rng)
    peer = open_socket(scene.ports['web'])
    number = 0
    while commands and scene.wait(rng.choice((0.005, 0.02))):
        command = rng.choice(commands)
        number += 1
        fields = {field['name']: random_value(rng, field) for field in command.get('fields', []) if rng.random() < 0.9}
        send(peer, frame(json.dumps({'id': number, 'command': {'message': command['name'], **fields}}).encode()[:60_000], rng))


@attack('web.upload')
def web_upload(scene, rng):
    """Uploads that end before they are complete."""
    name = f'part{rng.randrange(1000)}.ngc'
    while scene.wait(0.05):
        with contextlib.suppress(OSError):
            peer = connect(scene.ports['web'])
            body = b'G0 X1\n' * rng.choice((1, 100, 10_000))
            data = request(scene.ports['web'], f'/api/files/{name}?offset=0&size={len(body) * 2}', 'PUT', body=body)
            send(peer, data[:rng.randrange(len(data))] if rng.random() < 0.5 else data)
            hang_up(peer, rng)


@attack('web.tokens')
def web_tokens(scene, rng):
    become_other_user(rng)
    while scene.wait(0.02):
        with contextlib.suppress(OSError):
            peer = connect(scene.ports['web'])
            send(peer, request(scene.ports['web'], '/api/login', 'POST', body=json.dumps({'token': rng.randbytes(30).hex()}).encode()))
            hang_up(peer, rng)


@attack('nml.rubbish')
def nml_rubbish(scene, rng):
    """Requests that are truncated, too large, or not requests."""
    peers = []
    while scene.wait(rng.choice((0.0, 0.01))):
        with contextlib.suppress(OSError):
            peers.append(connect(scene.ports['nml']))
            size = rng.choice((0, 10, 60_000, 0x7fffffff))
            head = struct.pack('>3sBBBHIIQiI', b'MWN', 1, rng.randrange(8), 0, 0, rng.randrange(6), 1, rng.getrandbits(60), rng.choice((-1, 0, 1000)), size)
            send(peers[-1], rng.choice((rng.randbytes(100), head, head[:rng.randrange(32)], head + rng.randbytes(min(size, 60_000)))))
        if len(peers) > 20:
            hang_up(peers.pop(rng.randrange(len(peers))), rng)


@attack('nml.unread')
def nml_unread(scene, rng):
    """Clients request the status of the machine endlessly and never read it."""
    peers = [connect(scene.ports['nml']) for _ in range(rng.randrange(1, 12))]
    data = b''.join(struct.pack('>3sBBBHIIQiI', b'MWN', 1, 4, 0, 0, 2, number, 0, 0, 0) for number in range(200))
    while scene.wait(0.02):
        peer = rng.choice(peers)
        peer.setblocking(False)
        send(peer, data)


@attack('nml.commands')
def nml_commands(scene, rng):
    """Lines of MDI, programs and jogs while a program runs."""
    peer = connect(scene.ports['nml'])
    while scene.wait(rng.choice((0.002, 0.02))):
        text = rng.choice(('EMC_TASK_PLAN_EXECUTE_TYPE 509\nserial_number=0\nline="G0 X5"\n', 'EMC_NULL_TYPE 21\nserial_number=0\n',
                           'EMC_TASK_PLAN_OPEN_TYPE 506\nserial_number=0\npath="/dev/zero"\n',
                           'EMC_JOG_CONT_TYPE 124\nserial_number=0\nis_joint=1\nindex=0\nvelocity=5\nlease_ms=0\nis_renewal=0\n',
                           'EMC_TASK_PLAN_EXECUTE_TYPE 509\nserial_number=0\nline="#1=[' + '1+' * 400 + '1]"\n')).encode()
        send(peer, struct.pack('>3sBBBHIIQiI', b'MWN', 1, 2, 0, 0, 1, 1, 0, 1000, len(text)) + text)
        with contextlib.suppress(OSError):
            peer.recv(65536)


@attack('rsh.rubbish')
def rsh_rubbish(scene, rng):
    peers = []
    while scene.wait(rng.choice((0.0, 0.01))):
        with contextlib.suppress(OSError):
            peers.append(connect(scene.ports['rsh']))
            if rng.random() < 0.5:
                send(peers[-1], b'hello EMC x 1.0\r\nset enable EMCTOO\r\n')
            send(peers[-1], rng.choice((rng.randbytes(1000), b'get ' * 20_000, b'a' * 200_000, b'set mdi ' + b'[' * 5000 + b'\r\n',
                                        b'set open /dev/zero\r\nset open /dev/ptmx\r\n', b'\r\n' * 1000, b'set jog 0 5\r\nset mdi G0 X5\r\n')))
        if len(peers) > 15:
            hang_up(peers.pop(rng.randrange(len(peers))), rng)


@attack('rsh.unread')
def rsh_unread(scene, rng):
    peers = [connect(scene.ports['rsh']) for _ in range(rng.randrange(1, 10))]
    data = b'hello EMC x 1.0\r\nset enable EMCTOO\r\nset verbose on\r\n' + b'get abs_cmd_pos\r\nget error\r\nhelp\r\n' * 50
    while scene.wait(0.02):
        peer = rng.choice(peers)
        peer.setblocking(False)
        send(peer, data)
    random.shuffle(peers)
