#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A 7I80 whose registers are plain memory, with a firmware that has every small module, with LBP16 over UDP.

usage: memory_board.py ADDRESS LOG
The log has a line "ADDRESS VALUE" for each register whose value changes. A write to an odd address sets the value that the driver
reads at the even address below it, so that a HAL file can simulate the board by raw access. Registers in READ_ONLY keep their
other values.
"""
import socket
import struct
import sys

PORT = 27181
PINS, PORT_WIDTH = 72, 24
# gtag, version, clock (1 low, 2 high), instances, base address, registers, strides, registers that exist once for each instance
MODULES = [
    (26, 0, 1, 1, 0x7000, 7, 0, 0), (2, 0, 1, 1, 0x0C00, 3, 0, 0), (3, 0, 1, 3, 0x1000, 5, 0, 0x1F), (30, 0, 1, 1, 0x8000, 5, 0, 0x1F),
    (35, 0, 1, 1, 0x8500, 5, 0, 0x1F), (19, 0, 2, 2, 0x4600, 4, 0, 3), (44, 0, 1, 2, 0x9D00, 2, 0, 1), (192, 0, 1, 1, 0x3C00, 5, 0, 0x1F),
    (5, 0xC2, 1, 2, 0x2000, 10, 0, 0x1FF), (8, 0, 1, 1, 0x6900, 4, 0, 3), (24, 0, 2, 1, 0x4A00, 4, 0, 7), (25, 0, 1, 1, 0x1500, 3, 0, 0x1F),
    (43, 0, 1, 1, 0x9200, 11, 0, 0x1FF), (199, 0, 1, 1, 0xB100, 6, 0, 0x3F), (14, 0, 1, 1, 0x5500, 3, 0x10, 7), (128, 0, 1, 1, 0x0200, 1, 0, 0)]
# First pin, module, instance, and functions of the following pins.
FUNCTIONS = [
    (0, 30, 0, [0x81, 0x82, 0x83, 0x84, 0x85, 1]), (6, 35, 0, [1, 2, 3, 4, 5, 6, 7, 8]),
    (14, 19, 0, [0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 8]), (22, 44, 0, [0x81]), (23, 44, 1, [0x81]),
    (24, 192, 0, [0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 9, 10]), (34, 5, 0, [0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 1, 2]),
    (42, 5, 1, [0x81, 0x82, 1, 2]), (46, 8, 0, [0x81, 0x82, 3]), (49, 24, 0, [0x81, 0x82, 3]), (52, 25, 0, [0x81, 0x82, 3]),
    (55, 43, 0, [0x81, 0x82, 0x83, 0x84, 5]), (60, 199, 0, [1, 2, 0x81, 0x82]), (65, 14, 0, [0x81, 0x82, 0x83, 4])]
SHOWN = {0x7300: 42, 0x8000: 0x1F, 0x8500: 7}
READ_ONLY = {0x0D00, 0x3C00, 0x3D00, 0x4700, 0x4704, 0xB600, 0x8400, 0x8900, 0x2200, 0x2204, 0x9400, 0x9500, 0x9600, 0x9700, 0x9800, 0x6C00, 0x4D00,
             0x1A00, 0x1500, 0x1600, 0x1700, 0x2100, 0x2104, 0x4A00, 0x6900, 0x6A00}


def firmware():
    """The registers that describe the firmware."""
    registers = {}

    def put(address, words):
        for number, word in enumerate(words):
            registers[address + 4 * number] = word

    put(0x100, [0x55AACAFE, 0x54534F48, 0x32544F4D, 0x400])
    put(0x400, [3, 0x40, 0x1C0, 0x4153454D, 0x30384937, 0, 0, PINS // PORT_WIDTH, PINS, PORT_WIDTH, 100_000_000, 200_000_000, 4, 0x40, 0x100, 0x100])
    for number, (gtag, version, clock, instances, base, count, strides, once) in enumerate(MODULES):
        put(0x440 + 12 * number, [gtag | version << 8 | clock << 16 | instances << 24, base | count << 16 | strides << 24, once])
    pins = [3 << 24] * PINS
    for first, gtag, instance, functions in FUNCTIONS:
        for number, function in enumerate(functions):
            pins[first + number] |= instance << 16 | gtag << 8 | function
    put(0x5C0, pins)
    return registers


class Board:
    def __init__(self, log):
        self.registers = {**firmware(), **SHOWN}
        self.written, self.log = {}, log
        self.spaces = {number: bytearray(1 << 16) for number in range(8)}
        self.spaces[7][0:16] = b'7I80HD-16'.ljust(16, b'\0')
        struct.pack_into('<HHH', self.spaces[7], 0x10, 3, 15, 0)
        struct.pack_into('<HHH', self.spaces[2], 2, 0x0001, 0x1B16, 0x0060)

    def write(self, space, address, data):
        if space != 0:
            self.spaces[space][address:address + len(data)] = data
            return
        value = int.from_bytes(data, 'little')
        if self.written.get(address) != value:
            self.log.write(f'{address:04X} {value:08X}\n')
            self.log.flush()
        self.written[address] = value
        if address & 3:
            self.registers[address & ~3] = value
        elif address not in READ_ONLY:
            self.registers[address] = value

    def read(self, space, address, size):
        if space == 0:
            return self.registers.get(address & ~3, 0).to_bytes(4, 'little')[:size]
        return bytes(self.spaces[space][address:address + size])

    def answer(self, packet):
        """Executes the commands of a packet; returns the data that they read."""
        data, at, pointers = bytearray(), 0, [0] * 8
        while at + 2 <= len(packet):
            (command,) = struct.unpack_from('<H', packet, at)
            at += 2
            space, size = command >> 10 & 7, 1 << (command >> 8 & 3)
            if command >> 14 & 1:
                (pointers[space],) = struct.unpack_from('<H', packet, at)
                at += 2
            for _ in range(command & 0x7F):
                if command >> 15:
                    self.write(space, pointers[space], packet[at:at + size])
                    at += size
                elif command >> 13 & 1:
                    data += bytes(size)
                else:
                    data += self.read(space, pointers[space], size)
                pointers[space] += size if command >> 7 & 1 else 0
        return bytes(data)


def main():
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind((sys.argv[1], PORT))
    with open(sys.argv[2], 'w', encoding='ascii') as log:
        board = Board(log)
        print('ready', flush=True)
        while True:
            packet, sender = link.recvfrom(2048)
            data = board.answer(packet)
            if data:
                link.sendto(data, sender)


if __name__ == '__main__':
    main()
