#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs LinuxCNC's hm2_eth, unmodified, with simulated boards: of a 7I76E positions, counts, index, inputs, smart serial and
watchdog; of the other models the values of their modules.

usage: linuxcnc_board.py HM2_BOARD (as root)
Exit status: 0 all agree, 1 something differs, 77 skipped, with the reason. Board and driver run in separate network namespaces,
and the driver in a separate IPC namespace, so that it uses no other HAL of the computer. Timing is that of an ordinary process:
the period is 4 ms, and single packet errors do not count.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
HALRUN = '/usr/bin/halrun'
IP = '192.168.1.121'
# The driver makes a fixed ARP entry of the address that the EEPROM of the board names.
MAC = '00:60:1B:16:00:01'
PHYSICS = 'motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=x counts_per_rev=4000 index_rev=0.25\nswitch 17 motor=x above_rev=3\nremote 0 card=7i76\nremote 1 card=7i84\n'
HAL = '''
loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="num_encoders=1 num_stepgens=5 sserial_port_0=20xxxxxx"
loadrt threads name1=servo period1=4000000
addf hm2_7i76e.0.read servo
addf hm2_7i76e.0.write servo
setp hm2_7i76e.0.watchdog.timeout_ns 100000000
setp hm2_7i76e.0.packet-error-limit 1000
setp hm2_7i76e.0.stepgen.00.position-scale 200
setp hm2_7i76e.0.stepgen.00.maxvel 20
setp hm2_7i76e.0.stepgen.00.maxaccel 100
setp hm2_7i76e.0.stepgen.00.steplen 2000
setp hm2_7i76e.0.stepgen.00.stepspace 2000
setp hm2_7i76e.0.encoder.00.scale 4000
start
loadusr -w sleep 0.5
setp hm2_7i76e.0.stepgen.00.enable 1
setp hm2_7i76e.0.encoder.00.index-invert 1
setp hm2_7i76e.0.encoder.00.index-enable 1
setp hm2_7i76e.0.stepgen.00.position-cmd 3.1275
setp hm2_7i76e.0.7i76.0.0.output-03 1
setp hm2_7i76e.0.7i76.0.0.spinout 50
setp hm2_7i76e.0.7i76.0.0.spinena 1
setp hm2_7i76e.0.7i84.0.1.output-15 1
loadusr -w sleep 3
show pin hm2_7i76e.0
show param hm2_7i76e.0.io_error
stop
loadusr -w sleep 0.5
start
loadusr -w sleep 0.5
show pin hm2_7i76e.0.watchdog
'''

# Other models: connected cards, parameters of hm2_eth, further HAL lines, and pins (without the name of the
# board) with their values. A number may differ by a hundredth.
CASES = {
    '7i80hd-3pwm': ('', 'num_leds=4', """
setp BOARD.3pwmgen.00.enable 1
setp BOARD.3pwmgen.00.A-value 0.5
""", {'3pwmgen.00.fault': 'FALSE', '3pwmgen.05.enable': 'FALSE'}),
    '7i80hd-resolver': ('motor s pwm=0 full_rev_s=10 start_rev=0.25\nresolver 0 motor=s\nresolver 1 motor=s cycles_per_rev=3\n',
                        'sserial_port_0=xxxxxxxx', 'setp BOARD.resolver.excitation-khz 10', {'resolver.00.angle': 0.25, 'resolver.01.angle': 0.75, 'resolver.00.velocity': 0, 'resolver.00.error': 'FALSE',
      'resolver.02.error': 'TRUE'}),
    '7i92-latch': ('motor x stepgen=0 steps_per_rev=200\nswitch 5 motor=x above_rev=1\n', '', """
setp BOARD.stepgen.00.position-scale 200
setp BOARD.stepgen.00.maxvel 10
setp BOARD.stepgen.00.maxaccel 100
setp BOARD.stepgen.00.steplen 2000
setp BOARD.stepgen.00.stepspace 2000
setp BOARD.stepgen.00.probe-invert 1
setp BOARD.stepgen.00.probe-enable 1
setp BOARD.stepgen.00.position-cmd 2
setp BOARD.stepgen.00.enable 1
loadusr -w sleep 1
""", {'stepgen.00.position-fb': 2, 'stepgen.00.position-latch': 1.005, 'stepgen.00.probe-enable': 'FALSE', 'inmux.00.input-31': 'FALSE'}),
    '7i92-uart': ('', '', """
setp BOARD.rcpwmgen.00.width 1.5
loadrt mesa_uart names=BOARD.uart.1
addf BOARD.uart.1.receive servo
addf BOARD.uart.1.send servo
setp BOARD.uart.1.tx-data-00 17
setp BOARD.uart.1.tx-data-04 85
setp BOARD.uart.1.tx-bytes 5
""", {'rcpwmgen.rate': 50, 'uart.1.rx-data-00': '0x00000011', 'uart.1.rx-data-04': '0x00000055'}),
    '7i80': ('remote 0 card=7i77\nremote 2 card=7i73\n', 'sserial_port_0=0020xxxx', """
setp BOARD.7i77.0.1.analogena 1
setp BOARD.7i77.0.1.analogout3 5
""", {'7i77.0.0.input-31': 'FALSE', '7i77.0.1.analogout3': 5, '7i73.0.2.input-23': 'FALSE', 'sserial.port-0.port_state': '0x00000003'}),
}
CASE_HAL = """
loadrt hostmot2
loadrt hm2_eth board_ip=192.168.1.121 config="CONFIG"
loadrt threads name1=servo period1=4000000
addf BOARD.read servo
addf BOARD.write servo
setp BOARD.watchdog.timeout_ns 100000000
setp BOARD.packet-error-limit 1000
start
loadusr -w sleep 0.5
LINES
loadusr -w sleep 1
show pin BOARD
show param BOARD.io_error
"""
# Messages of the driver about faults.
COMPLAINT = re.compile(r'(?i)\b(error|warning|fail(?:ed|ure)?|unknown|unsupported|not supported|inconsistent)\b')


# LinuxCNC reads these registers with extra packets and prints a message about it.
OF_LINUXCNC = 'used llio->read in realtime task'


def reason_to_skip():
    if os.geteuid() != 0:
        return 'network namespaces need root'
    missing = [program for program in ('ip', 'unshare', 'iptables', HALRUN) if shutil.which(program) is None]
    return f'{", ".join(missing)}: not installed' if missing else None


def ip(*words):
    subprocess.run(['ip', *words], check=True)


class Network:
    """Two namespaces connected by a virtual cable."""

    def __init__(self):
        tag = f'b{os.getpid() % 100000}'
        self.host, self.board = f'{tag}h', f'{tag}b'

    def __enter__(self):
        for name in (self.host, self.board):
            ip('netns', 'add', name)
        ip('link', 'add', self.host, 'netns', self.host, 'type', 'veth', 'peer', 'name', self.board, 'netns', self.board)
        ip('-n', self.board, 'link', 'set', self.board, 'address', MAC)
        for name, address in ((self.host, '192.168.1.1'), (self.board, IP)):
            ip('-n', name, 'addr', 'add', f'{address}/24', 'dev', name)
            ip('-n', name, 'link', 'set', name, 'up')
            ip('-n', name, 'link', 'set', 'lo', 'up')
        return self

    def __exit__(self, *_):
        for name in (self.host, self.board):
            subprocess.run(['ip', 'netns', 'del', name], check=False)


def run(program, folder, model, physics, hal):
    """Output of halrun, and the log of the board."""
    (folder / 'physics.txt').write_text(physics)
    (folder / 'test.hal').write_text(hal)
    (folder / 'log').unlink(missing_ok=True)
    with Network() as network:
        command = ['ip', 'netns', 'exec', network.board, program, '--listen', IP, '--model', model, '--physics', str(folder / 'physics.txt'),
                   '--log', str(folder / 'log')]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as board:
            board.stdout.readline()
            environment = dict(os.environ, RTAPI_UID='65534', RTAPI_FIFO_PATH=str(folder / 'fifo'))
            done = subprocess.run(['ip', 'netns', 'exec', network.host, 'unshare', '-i', '--', HALRUN, '-f', str(folder / 'test.hal')],
                                  env=environment, capture_output=True, text=True, timeout=120)
            time.sleep(0.2)
            board.terminate()
    return done.stdout + done.stderr, (folder / 'log').read_text()


def agrees(found, wanted):
    if found is None or isinstance(wanted, str):
        return found == wanted
    return abs(float(found) - wanted) <= 0.01


def check_case(program, folder, model):
    """The differences of one model of CASES."""
    physics, config, lines, pins = CASES[model]
    board = f'hm2_{model.split("-")[0].removesuffix("hd")}.0'
    hal = CASE_HAL.replace('LINES', lines).replace('CONFIG', config).replace('BOARD', board)
    output, _ = run(program, folder, model, physics, hal)
    problems = [f'{model}: {line}' for line in output.splitlines() if COMPLAINT.search(line) and board + '.' not in line and
                OF_LINUXCNC not in line]
    for name, wanted in pins.items():
        found = re.findall(rf'\s(\S+)\s+{re.escape(board)}\.{re.escape(name)}(?:\s|$)', output, re.M)
        if not agrees(found[0] if found else None, wanted):
            problems.append(f'{model}: {name} is {found[:1]}, not {wanted}')
    return problems


def check(output, log):
    def value(name):
        found = re.findall(rf'\s(\S+)\s+hm2_7i76e\.0\.{re.escape(name)}$', output, re.M)
        return found[0] if found else None

    steps, wanted = 625, 3.1275
    problems = []
    if value('stepgen.00.counts') is None:
        return ['the driver has not loaded:\n' + output[-3000:]]
    if abs(float(value('stepgen.00.position-fb')) - wanted) > 0.005:
        problems.append(f'position-fb is {value("stepgen.00.position-fb")}, not {wanted}')
    # The motor has moved the whole steps of the accumulator, each of 20 counts.
    accumulators = re.findall(r'R0 0x2100 5x32 (\w{8})', log)
    raw = int(value('encoder.00.rawcounts'))
    if raw % 20 != 0 or abs(raw // 20 - steps) > 1:
        problems.append(f'the encoder reads {raw}, not the counts of about {steps} steps')
    moved = next((int(a, 16) >> 16 for a in reversed(accumulators)), 0)
    if moved * 20 != raw:
        problems.append(f'accumulator {moved} steps, encoder {raw} counts')
    if value('encoder.00.index-enable') != 'FALSE':
        problems.append('index-enable has not been cleared')
    # The index is at 1000 counts, where the position becomes 0.
    if int(value('encoder.00.count')) != raw - 1000:
        problems.append(f'count is {value("encoder.00.count")} after the index, not {raw - 1000}')
    if value('gpio.017.in') != 'TRUE':
        problems.append('the switch at 3 revolutions is not seen')
    # Output 3 and half of the speed in the first word, the enable in the second one.
    sent = {register: re.findall(rf'W0 0x{register} 1x32 (\w{{8}})', log) for register in ('5D00', '5E00', '5D04')}
    if not ('7FFF0008' in sent['5D00'] and '00000001' in sent['5E00'] and '00008000' in sent['5D04']):
        problems.append('the outputs of the smart serial cards are not sent')
    # Exchanges that the operating system delays are single faults; after 200 the port would stop.
    if value('sserial.port-0.port_state') != '0x00000003' or int(value('sserial.port-0.fault-count'), 16) >= 200:
        problems.append('smart serial does not run')
    if value('io_error') != 'FALSE':
        problems.append('io_error')
    bites = re.findall(r'^\s+\d+\s+bit\s+I/O\s+(\S+)\s+hm2_7i76e\.0\.watchdog\.has_bit', output, re.M)
    if bites != ['FALSE', 'TRUE']:
        problems.append(f'watchdog.has_bit is {bites}: FALSE while the thread runs, TRUE after a pause of 0.5 s')
    return problems


def main():
    reason = reason_to_skip()
    if reason is not None:
        print(f'skipped: {reason}')
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        program, path = os.path.abspath(sys.argv[1]), pathlib.Path(folder)
        problems = check(*run(program, path, '7i76e', PHYSICS, HAL))
        for model in CASES:
            problems += check_case(program, path, model)
    print('\n'.join(problems) or f'LinuxCNC drives the simulated 7I76E and {len(CASES)} further models: all values agree')
    return 1 if problems else 0


if __name__ == '__main__':
    sys.exit(main())
