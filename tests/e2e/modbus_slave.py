# SPDX-License-Identifier: GPL-2.0-or-later
"""A Modbus slave, written from the protocol specification, over TCP and RTU. The device supplies the answers: answer(slave,
request)."""
import os
import socket
import struct

FAILED = []


def expect(condition, what, *more):
    if not condition:
        FAILED.append(what)
        print('FAIL', what, *more)


def crc(data):
    value = 0xffff
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xa001 if value & 1 else 0)
    return struct.pack('<H', value)


def serve_tcp(device, listener):
    while True:
        try:
            peer, _ = listener.accept()
        except OSError:
            return
        with peer:
            while True:
                head = peer.recv(7, socket.MSG_WAITALL)
                if len(head) < 7:
                    break
                number, _, length, slave = struct.unpack('>HHHB', head)
                answer = device.answer(slave, peer.recv(length - 1, socket.MSG_WAITALL))
                if answer is not None:
                    peer.sendall(struct.pack('>HHHB', number, 0, len(answer) + 1, slave) + answer)


def serve_rtu(device, line):
    data = b''
    while True:
        try:
            data += os.read(line, 256)
        except OSError:
            return
        while len(data) >= 8:
            size = 9 + data[6] if data[1] in (15, 16) else 8
            if len(data) < size:
                break
            frame, data = data[:size], data[size:]
            assert crc(frame[:-2]) == frame[-2:], frame
            answer = device.answer(frame[0], frame[1:-2])
            if answer is not None:
                os.write(line, bytes([frame[0]]) + answer + crc(bytes([frame[0]]) + answer))
