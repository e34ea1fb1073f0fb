#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our hm2_spi, hm2_7i90, hm2_7i43 and hm2_pci with LinuxCNC's: pins, parameters, and the data sent per cycle.

usage: linuxcnc_buses.py HALRUN MODELS_FOLDER (as root)
Exit status: 0 all agree, 1 something differs, 77 skipped, with the reason. bus_shim.c simulates ports and devices; a folder
mounted over /sys/bus/pci in a separate namespace contains the cards. Both drivers get the same registers. LEFT_OUT lists features
of newer versions of LinuxCNC, and features that ours adds or lacks.
"""
import difflib
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

SKIPPED = 77
THEIRS = '/usr/bin/halrun'
SOURCE = pathlib.Path(__file__).with_name('bus_shim.c')
GTAGS = {'watchdog': 2, 'ioport': 3, 'encoder': 4, 'stepgen': 5, 'pwm': 6, 'led': 128}
ROW = re.compile(r'^\s+\d+\s+(bit|float|s32|u32)\s+(IN|OUT|I/O|RW|RO)\s+\S+\s+(hm2\S+)', re.M)
LEFT_OUT = re.compile(r'\.tmax|\.time$|no_clear_on_index|position-interpolated|\.bus-error|table-data')
# module, its parameters, board, model
BUSES = [('hm2_spi', 'spidev_path=/dev/spidev1.0 spidev_rate=24000 config=""', 'hm2_7i90.0', '7i90'),
         ('hm2_7i90', 'ioaddr=0x378 ioaddr_hi=0x778', 'hm2_7i90.0', '7i90'),
         ('hm2_7i90', 'ioaddr=0x378 epp_wide=0', 'hm2_7i90.0', '7i90'),
         ('hm2_7i43', 'ioaddr=0x378', 'hm2_7i43.0', '7i43')]
# card, its numbers, ports, width of a port
CARDS = [('5i20', '10b5:9030:10b5:3131', 3, 24), ('4i65', '10b5:9030:10b5:3132', 3, 24), ('4i68', '10b5:9054:10b5:3133', 3, 24),
         ('4i68', '10b5:9054:10b5:3311', 3, 24), ('5i21', '10b5:9054:10b5:3312', 2, 32), ('5i22', '10b5:9054:10b5:3313', 4, 24),
         ('5i22', '10b5:9054:10b5:3314', 4, 24), ('5i23', '10b5:9054:10b5:3315', 3, 24), ('4i69', '10b5:9054:10b5:3472', 3, 24),
         ('4i69', '10b5:9054:10b5:3473', 3, 24), ('3x20', '10b5:9056:10b5:3427', 6, 24), ('3x20', '10b5:9056:10b5:3428', 6, 24),
         ('3x20', '10b5:9056:10b5:3429', 6, 24), ('5i24', '2718:5124:2718:5124', 3, 24), ('5i25', '2718:5125:2718:5125', 2, 17),
         ('6i25', '2718:6125:2718:6125', 2, 17)]
SHOW = 'show pin BOARD\nshow param BOARD\n'
CYCLES = '''
loadrt threads name1=servo period1=4000000
addf BOARD.read servo
addf BOARD.write servo
setp BOARD.watchdog.timeout_ns 100000000
start
loadusr -w sleep 0.2
'''


def values_of(line):
    return {key: int(value, 0) for key, value in re.findall(r'(\w+)=(0x\w+|\d+)(?:\s|$)', line)}


def registers_of(text):
    """64 KiB with the description of a model."""
    image = bytearray(0x10000)

    def put(address, *words):
        struct.pack_into(f'<{len(words)}I', image, address, *(word & 0xFFFFFFFF for word in words))
    line = re.search(r'^board.*', text, re.M)[0]
    board, name = values_of(line), re.search(r' name=(\S{8})', line)[1].encode()
    pins = board['ports'] * board['port_width']
    is_old = board.get('idrom_type', 3) == 2
    put(0x100, 0x55AACAFE, *struct.unpack('<2I', b'HOSTMOT2'), 0x400)
    put(0x400, 2 if is_old else 3, 0x40, 0x200 if is_old else 0x1C0, *struct.unpack('<2I', name), 9, 144, board['ports'], pins,
        board['port_width'], board['clock_low_hz'], board['clock_high_hz'], 4, 0x40, 0x100, 0x100)
    for i, (module, rest) in enumerate(re.findall(r'^module (\S+)(.*)', text, re.M)):
        value, clock = values_of(rest), 2 if 'clock=high' in rest else 1
        put(0x440 + 12 * i, GTAGS[module] | value.get('version', 0) << 8 | clock << 16 | value.get('instances', 1) << 24,
            value['base'] | value['registers'] << 16, value.get('per_instance', 0))
    first = 0x600 if is_old else 0x5C0
    put(first, *[3 << 24] * pins)
    for number, module, unit, function in re.findall(r'^pin\s+(\d+) module=(\S+) unit=(\d+) function=(\S+)', text, re.M):
        put(first + 4 * int(number), int(function, 16) | GTAGS[module] << 8 | int(unit) << 16 | 3 << 24)
    return bytes(image)


def rows_of(output):
    return {(match[3], match[1], match[2]) for match in ROW.finditer(output) if not LEFT_OUT.search(match[3])}


class Bench:
    """Runs HAL files with one of the two drivers."""

    def __init__(self, folder, halrun):
        self.folder, self.ours = folder, halrun
        self.shim = folder / 'bus_shim.so'
        subprocess.run(['cc', '-shared', '-fPIC', '-O1', '-o', self.shim, SOURCE, '-ldl'], check=True)

    def run(self, is_ours, hal, before='true', **more):
        (self.folder / 'test.hal').write_text(hal)
        environment = dict(os.environ, RTAPI_UID='65534', RTAPI_FIFO_PATH=str(self.folder / 'fifo'), SYSTEMD_DEVICE_VERIFY_SYSFS='0',
                           MILLWRIGHT_INSTANCE=f'buses{os.getpid()}', BUS_SHIM_REGISTERS=str(self.folder / 'registers'),
                           BUS_SHIM_LOG=str(self.folder / 'log'), **more)
        (self.folder / 'log').unlink(missing_ok=True)
        program = self.ours if is_ours else THEIRS
        command = f'{before} && LD_PRELOAD={self.shim} exec {program} -f {self.folder}/test.hal'
        done = subprocess.run(['unshare', '-i', '-m', '-p', '--fork', '--kill-child', '--mount-proc', '--', 'sh', '-c', command], env=environment, capture_output=True, text=True, timeout=60)
        log = self.folder / 'log'
        return done.stdout + done.stderr, log.read_text().splitlines() if log.exists() else []


def spi_accesses(line):
    """Each command of a transfer with its data."""
    words = line.split(':')[1].split()
    while words:
        count = 1 + (int(words[0], 16) >> 4 & 0x7F)
        yield ' '.join(words[:count])
        words = words[count:]


def cycle_of(lines):
    """The accesses of one cycle, sorted, because the order of the reads may differ. Omits the cookie, which only ours reads in
    each cycle, and EPP accesses without data."""
    text = '\n'.join(lines)
    spi = [re.findall(rf'^spi \d+: (?:0100a810 0{{8}} )?1000{access}8.*', text, re.M) for access in 'ab']
    if all(spi):
        accesses = [access for lines in spi for access in spi_accesses(lines[-1])]
    else:
        # From one read of the ports to the next; the status is read after each access.
        starts = [match.start() for match in re.finditer(r'out8 37b 0\nout8 37b 90\nin', text)]
        accesses = text[starts[-2]:starts[-1]].split('in8 379\n') if len(starts) > 1 else []
        accesses = [access.replace('\n', '; ') for access in accesses if '37c' in access]
    cookie = ('0100a810', 'out8 37b 0; out8 37b 81')
    return sorted(access for access in accesses if not access.startswith(cookie))


def differences(what, theirs, ours):
    """Differences between two sets of rows; an empty set is a difference, too."""
    if not theirs or not ours:
        return [f'{what}: LinuxCNC has {len(theirs)} pins and parameters, ours {len(ours)}']
    return [f'{what}: only {whose}: {" ".join(row)}' for whose, rows in (('LinuxCNC', theirs - ours), ('ours', ours - theirs))
            for row in sorted(rows)]


def check_bus(bench, models, bus):
    module, parameters, board, model = bus
    (bench.folder / 'registers').write_bytes(registers_of((models / f'{model}.txt').read_text()))
    hal = f'loadrt hostmot2\nloadrt {module} {parameters}\n' + (CYCLES + SHOW).replace('BOARD', board)
    theirs, their_log = bench.run(False, hal)
    ours, our_log = bench.run(True, hal)
    what = f'{module} {parameters}'
    problems = differences(what, rows_of(theirs), rows_of(ours))
    if not cycle_of(our_log) or cycle_of(their_log) != cycle_of(our_log):
        problems += difflib.unified_diff(cycle_of(their_log), cycle_of(our_log), f'{what}: LinuxCNC', 'ours', lineterm='')
    return problems


def add_card(folder, numbers, image):
    """A card with registers in each region, in folders that are mounted over the folders of the kernel."""
    name, names = '0000:00:00.0', ('vendor', 'device', 'subsystem_vendor', 'subsystem_device')
    pci, devices = folder / 'pci', folder / 'devices'
    for old in (pci, devices):
        shutil.rmtree(old, ignore_errors=True)
    card = devices / name
    card.mkdir(parents=True)
    (pci / 'devices').mkdir(parents=True)
    (pci / 'devices' / name).symlink_to(f'../../../devices/platform/{name}')
    (card / 'subsystem').symlink_to('../../../bus/pci')
    for file, number in zip(names, numbers.split(':')):
        (card / file).write_text(f'0x{number}\n')
    vendor, device, *subsystem = (number.upper() for number in numbers.split(':'))
    (card / 'uevent').write_text(f'PCI_CLASS=118000\nPCI_ID={vendor}:{device}\nPCI_SUBSYS_ID={":".join(subsystem)}\nPCI_SLOT_NAME={name}\n')
    for file, text in (('class', '0x118000'), ('irq', '0'), ('enable', '0'), ('revision', '0x00')):
        (card / file).write_text(f'{text}\n')
    regions = ''
    for region in range(13):
        used = region in (0, 1, 3, 5)
        regions += f'0xf{region:x}000000 0xf{region:x}00ffff 0x40200\n' if used else '0x0 0x0 0x0\n'
        if used:
            (card / f'resource{region}').write_bytes(image)
    (card / 'resource').write_text(regions)
    for root in (folder / 'sys/bus/pci',):
        root.mkdir(parents=True, exist_ok=True)
        (root / 'devices').unlink(missing_ok=True)
        (root / 'devices').symlink_to(devices)


def check_card(bench, text, card):
    name, numbers, ports, width = card
    model = re.sub(r'ports=\d+ port_width=\d+', f'ports={ports} port_width={width}', text)
    model = re.sub(r'(module ioport +instances=)\d+', rf'\g<1>{ports}', re.sub(r'^pin.*\n', '', model, flags=re.M))
    image = registers_of(model)
    (bench.folder / 'registers').write_bytes(image)
    hal = 'loadrt hostmot2\nloadrt hm2_pci\n' + SHOW.replace('BOARD', f'hm2_{name}.0')
    folder = bench.folder
    add_card(folder, numbers, image)
    mount = f'mount --bind {folder}/pci /sys/bus/pci && mount --bind {folder}/devices /sys/devices/platform'
    theirs, _ = bench.run(False, hal, before=mount)
    add_card(folder, numbers, image)
    ours, _ = bench.run(True, hal, MILLWRIGHT_SYSFS=str(folder / 'sys'))
    return differences(f'{name} {numbers}', rows_of(theirs), rows_of(ours))


def main():
    missing = [program for program in ('unshare', 'cc', THEIRS) if shutil.which(program) is None]
    if os.geteuid() != 0 or missing or os.uname().machine != 'x86_64':
        print(f'skipped: needs root, x86_64 and these programs: {", ".join(missing)}')
        return SKIPPED
    halrun, models = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o777)  # the driver of LinuxCNC runs as another user
        bench = Bench(folder, halrun)
        problems = [problem for bus in BUSES for problem in check_bus(bench, models, bus)]
        text = (models / '5i20.txt').read_text()
        problems += [problem for card in CARDS for problem in check_card(bench, text, card)]
    print('\n'.join(problems) or f'{len(BUSES)} ports and buses and {len(CARDS)} PCI cards: pins and cycles are those of LinuxCNC')
    return 1 if problems else 0


if __name__ == '__main__':
    sys.exit(main())
