# SPDX-License-Identifier: GPL-2.0-or-later
"""The components that compare_hal.py runs, and the inputs and parameters that are in their range.

Only what differs from the defaults is listed: a bit changes now and then, a float is uniform, whole or a random walk.
"""
import dataclasses
import re

LETTERS = {'bit': 'b', 'float': 'f', 's32': 's', 'u32': 'u'}


def bits(change=0.3):
    return lambda r, last: last if last is not None and r.random() > change else r.randint(0, 1)


def uniform(low, high):
    return lambda r, last: round(r.uniform(low, high), 4)


def whole(low, high, change=1.0):
    return lambda r, last: last if last is not None and r.random() > change else r.randint(low, high)


def pick(*choices, change=1.0):
    return lambda r, last: last if last is not None and r.random() > change else r.choice(choices)


def constant(value):
    return lambda r, last: value


def walk(step, start=0.0):
    return lambda r, last: round((start if last is None else last) + r.uniform(-step, step), 5)


def walk_whole(step):
    return lambda r, last: (last or 0) + r.randint(-step, step)


def default_generator(kind, r):
    if kind == 'bit':
        return bits(r.choice((0.5, 0.2, 0.05)))
    if kind == 'float':
        return r.choice((uniform(-3, 3), uniform(0, 1), walk(0.1), pick(-1.0, 0.0, 0.5, 1.0, 2.0),
                         pick(-2.0, 1.0, 3.0, change=0.1)))
    if kind == 's32':
        return r.choice((whole(-9, 9), whole(-9, 9, 0.1), walk_whole(2)))
    return r.choice((whole(0, 9), whole(0, 9, 0.1)))


@dataclasses.dataclass
class Component:
    loads: list = dataclasses.field(default_factory=list)
    values: dict = dataclasses.field(default_factory=dict)  # {regular expression over a pin or parameter: generator}
    skip: str = ''    # inputs and parameters that keep their value
    hide: str = ''    # outputs that are not compared: they show times of the computer
    single: bool = False  # one instance and functions of the module
    count: str = 'count'
    prefix: str = ''  # where it is not the module's name with a number

    def is_skipped(self, pin):
        return bool(self.skip and re.fullmatch(self.skip, pin))

    def is_hidden(self, pin):
        return bool(self.hide and re.fullmatch(self.hide, pin))

    def has_generator(self, pin):
        return any(re.fullmatch(pattern, pin) for pattern in self.values)

    def prefix_of(self, name, number):
        if self.prefix:
            return self.prefix
        return f'{name.replace("_", "-")}.{number}.'

    def load_text(self, load, count):
        words = load.split()
        each = [f'{word},' * (count - 1) + word if word.startswith('personality=') else word for word in words]
        return ' '.join(each).replace(',personality=', ',') + f' {self.count}={count}'

    def function_name(self, name, number, function):
        """`function` is the name as exported by the first instance."""
        first = f'{name.replace("_", "-")}.0'
        if not self.single and (function == first or function.startswith(first + '.')):
            return f'{name.replace("_", "-")}.{number}{function[len(first):]}'
        return function


def generator_of(spec, forced, pin, kind, r):
    if pin in forced:
        value = forced[pin]
        return value if callable(value) else constant(value)
    for pattern, draw in spec.values.items():
        if re.fullmatch(pattern, pin):
            return draw
    return default_generator(kind, r)


C = Component
COMPONENTS = {name: C() for name in '''abs abs_s32 and2 or2 xor2 not bin2gray gray2bin bitwise blend clarke2 clarke3
clarkeinv comp conv_bit_float conv_bit_s32 conv_bit_u32 conv_float_s32 conv_float_u32 conv_s32_bit conv_s32_float
conv_s32_u32 conv_u32_bit conv_u32_float conv_u32_s32 corexy_by_hal ddt deadzone differential div2 estop_latch feedcomp
filter_kalman flipflop gearchange hypot ilowpass integ invert joyhandle knob2float limit1 limit2 limit3 lowpass lut5
maj3 match8 minmax modmath mult2 mux2 mux4 mux8 near offset oneshot orient sample_hold scale scaled_s32_sums select8
sim_home_switch sim_spindle sphereprobe spindle_monitor sum2 supply timedelay tof ton tp toggle toggle2nist tristate_bit
tristate_float updown wcomp xor2 edge biquad constant dbounce multiclick ohmic time threadtest mux16 histobins
eoffset_per_angle'''.split()}
COMPONENTS.update({
    'logic': C(['logic personality=' + p for p in ('0x102', '0x203', '0x404', '0x706', '0x1f03', '0x1708')]),
    'bitslice': C(['bitslice personality=4', 'bitslice personality=9']),
    'demux': C(['demux personality=6', 'demux personality=12']),
    'lincurve': C(['lincurve personality=4'], {'x-val-00': constant(0), 'x-val-01': constant(1),
                                               'x-val-02': constant(2.5), 'x-val-03': constant(5)}),
    'gantry': C(['gantry personality=3']),
    'spindle': C(['spindle numgears=1'], single=True),
    'pid': C(['pid debug=1'], {'tune-mode': constant(0), 'tune-start': constant(0), 'max.*': pick(0, 0.5, 3),
                               'command': walk(0.05), 'feedback': walk(0.05), '.gain': pick(0, 0.1, 2),
                               'FF.': pick(0, 1e-3, 0.1)}, count='num_chan'),
    'siggen': C(values={'frequency': pick(0, 1, 17.5, change=0.02)}, count='num_chan'),
    'debounce': C(['debounce cfg=3'], {'delay': whole(0, 5)}, prefix='debounce.0.', single=True),
    'charge_pump': C(prefix='charge-pump.', single=True),
    'thc': C(prefix='thc.', single=True), 'thcud': C(prefix='thcud.', single=True),
    'watchdog': C(['watchdog num_inputs=3'], {'timeout-.': pick(0.003, 0.0055)}, prefix='watchdog.', single=True),
    'weighted_sum': C(['weighted_sum wsum_sizes=4'], prefix='wsum.0.', single=True),
    'encoder': C(['encoder num_chan=1'], {'phase-.': bits(0.3), 'position-scale': pick(1, 4, -10)}, single=True),
    'counter': C(['counter num_chan=1'], {'position-scale': pick(1, 4, -10)}, single=True),
    'encoder_ratio': C(['encoder_ratio num_chan=1'], {'.*teeth': whole(1, 9), '.*ppr': whole(1, 4)}, single=True),
    'sim_encoder': C(['sim_encoder num_chan=1'], {'speed': pick(0, 1, -3, 20, change=0.02), 'ppr': pick(4, 10)},
                     single=True),
    'stepgen': C([f'stepgen step_type={t} ctrl_type={c}' for t in (0, 1, 2, 5, 9) for c in 'pv'],
                 {'position-cmd': walk(0.3), 'velocity-cmd': pick(0, 30, -80, 200, change=0.05),
                  'enable': bits(0.02), 'position-scale': pick(1, 4, -3), 'maxaccel': pick(0, 500, 5000),
                  'maxvel': pick(0, 50, 1000), '(step|dir).*': pick(1, 1000000, 2000000)}, single=True),
    'pwmgen': C([f'pwmgen output_type={t}' for t in (0, 1, 2)],
                {'pwm-freq': pick(0, 10, 100), 'value': pick(-1.2, -0.5, 0.0, 0.3, 0.8, 2.0, change=0.05),
                 'scale': pick(1, 2), 'enable': bits(0.03)}, single=True),
    'multiswitch': C(['multiswitch cfg=4'], single=True),
    'mux_generic': C(['mux_generic config=ff4', 'mux_generic config=bb5', 'mux_generic config=fs4',
                      'mux_generic config=ub3'], {'debounce-us': pick(0, 2500)}, single=True),
    'sim_matrix_kb': C(),
    'sim_parport': C(),
    'sim_axis_hardware': C(),
    'bldc': C(['bldc cfg=' + c for c in ('a', 'aT', 'aB6', 'aHF', 'h', 'h6', 'f', 'n', 'qh')],
              {'value': pick(0.5, -0.3, 1.0, 0.0, change=0.1), 'rawcounts': walk_whole(30),
               'pattern': pick(25, 7, 40), 'output-pattern': pick(25, 13), 'rev': bits(0.02),
               'frequency': pick(0, 5, -20, change=0.1)}, single=True),
    'steptest': C(), 'simple_tp': C(), 'anglejog': C(), 'moveoff': C(['moveoff personality=2']), 'millturn': C(),
    'carousel': C(['carousel pockets=8'], single=True),
    'max31855': C(),
})
