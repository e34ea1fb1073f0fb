# SPDX-License-Identifier: GPL-2.0-or-later
"""The components that compare_hal.py runs, and valid inputs and parameters.

Only differences from the defaults are listed: a bit changes occasionally, a float is uniform, whole or a random walk.
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


def once(*choices):
    """One of the values, for the whole file."""
    return pick(*choices, change=0)


def rare(chance):
    """A bit that is rarely TRUE."""
    return lambda r, last: int(r.random() < chance)


class LateBit:
    """A bit that is FALSE in the first periods."""

    def __init__(self, periods):
        self.periods = periods

    def __call__(self, r, last):
        return bits()(r, last)

    def column(self, r, rows):
        values = [0] * self.periods
        while len(values) < rows:
            values.append(bits(0.05)(r, values[-1]))
        return values


class SlowBit:
    """A bit that keeps its value for at least this number of periods."""

    def __init__(self, periods):
        self.periods = periods

    def __call__(self, r, last):
        return bits()(r, last)

    def column(self, r, rows):
        values = []
        while len(values) < rows:
            values += [1 - values[-1] if values else r.randint(0, 1)] * r.randint(self.periods, 2 * self.periods)
        return values[:rows]


def constant(value):
    return lambda r, last: value


def walk(step, start=0.0):
    return lambda r, last: round((start if last is None else last) + r.uniform(-step, step), 5)


def walk_whole(step):
    return lambda r, last: (last or 0) + r.randint(-step, step)


def quadrature(r, rows):
    """The two columns of an encoder with random movement."""
    states, at, step, columns = ((0, 0), (1, 0), (1, 1), (0, 1)), 0, r.choice((-1, 0, 1)), ([], [])
    for _ in range(rows):
        step = r.choice((-1, 0, 1)) if r.random() < 0.1 else step
        at += step if columns[0] and r.random() < 0.7 else 0
        for column, bit in zip(columns, states[at % 4]):
            column.append(bit)
    return columns


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
    hide: str = ''    # outputs that are not compared, because they contain times
    ordered: bool = False  # functions in the order of their names, backwards
    single: bool = False  # one instance and functions of the module
    count: str = 'count'
    pairs: list = dataclasses.field(default_factory=list)  # inputs that are the two phases of an encoder
    prefix: str = ''  # if it is not the module's name with a number

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
        """`function` is the name that the first instance exports."""
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
conv_bit_float conv_bit_s32 conv_bit_u32 conv_float_s32 conv_float_u32 conv_s32_bit conv_s32_float
conv_s32_u32 conv_u32_bit conv_u32_float conv_u32_s32 corexy_by_hal ddt deadzone differential div2 estop_latch
flipflop hypot invert joyhandle knob2float lowpass lut5 maj3 match8 minmax mult2 mux2 mux4 mux8
offset sample_hold scale scaled_s32_sums select8 sum2 toggle2nist
tristate_bit tristate_float wcomp edge constant dbounce time threadtest sim_parport millturn
eoffset_per_angle steptest simple_tp anglejog'''.split()}
LIMITS = {'min.?': uniform(-2, -0.2), 'max.?': uniform(0.2, 2), 'maxv': once(0.5, 10, 1000), 'maxa': once(10, 5000)}
DELAYS = once(0, 0.002, 0.0035)
COMPONENTS.update({
    'comp': C(values={'hyst': once(0, 0.5, 2)}),
    'near': C(values={'difference': once(0, 0.5, 1), 'scale': once(1, 1.1, 2)}),
    'filter_kalman': C(values={'[RQ]k': once(0.1, 0.5, 1)}),
    'gearchange': C(values={'min.': once(0, 0.2), 'max.': once(1, 3), 'scale2': once(0.5, 2)}),
    'integ': C(values=LIMITS), 'limit1': C(values=LIMITS), 'limit2': C(values=LIMITS), 'limit3': C(values=LIMITS),
    'oneshot': C(values={'width': DELAYS}), 'timedelay': C(values={'o.*-delay': DELAYS}),
    'ton': C(values={'pt': DELAYS}), 'tof': C(values={'pt': DELAYS}), 'tp': C(values={'pt': DELAYS}),
    'orient': C(values={'mode': whole(0, 2, 0.1), 'angle': uniform(0, 359)}),
    'sphereprobe': C(values={'r': once(3, 6), 'c[xyz]': once(-2, 0, 2)}),
    'biquad': C(values={'f0': once(50, 80, 120), 'Q': once(0.7, 1.3), 'type': once(0, 1, 2), 'enable': bits(0.02)}),
    'ohmic': C(values={'thcad-0-volt-freq': once(122900), 'thcad-max-volt-freq': once(925700),
                       'thcad-fullscale': once(5, 10), 'thcad-divide': once(1, 32), 'volt-divider': once(1, 5),
                       'velocity-in': uniform(0, 35000), 'ohmic-low': once(0.2, 1), 'ohmic-threshold': once(2, 5)}),
    'mux16': C(values={'debounce-time': once(0, 0.0025)}),
    'histobins': C(values={'pintype': once(0, 1, 2, 3), 'method': once(0, 1), 'nbins': once(5, 50),
                           'binsize': once(0.5, 2), 'minvalue': once(-3, 0), 'index': whole(-1, 7)}),
    'logic': C(['logic personality=' + p for p in ('0x102', '0x203', '0x404', '0x706', '0x1f03', '0x1708')]),
    'bitslice': C(['bitslice personality=4', 'bitslice personality=9']),
    'demux': C(['demux personality=6', 'demux personality=12']),
    'lincurve': C(['lincurve personality=4'], {'x-val-00': constant(0), 'x-val-01': constant(1),
                                               'x-val-02': constant(2.5), 'x-val-03': constant(5)}),
    'gantry': C(['gantry personality=3'], {'search-vel': once(-1, 1), 'joint.*home': bits(0.02)}),
    'spindle': C(['spindle'], {'commanded-speed': pick(100, -200, 500, 30, 0, change=0.02),
                               'actual-speed': uniform(0, 5), 'simulate-encoder': once(0, 1),
                               'select-gear': constant(0), 'max.*': once(0, 400),
                               'min.*': once(50), 'accel.*': once(900), 'decel.*': once(1500),
                               'scale.*': once(0.1, 1)}, single=True),
    'pid': C(['pid debug=1'], {'tune-.*': constant(0), 'max.*': once(0, 0.5, 3), 'command': walk(0.05),
                               'feedback': walk(0.05), '.gain': once(0, 0.1, 2), 'FF[01]': once(0, 0.1),
                               'FF[23]': once(0, 1e-5), 'enable': bits(0.05), 'deadband': once(0, 0.05),
                               'index-enable': bits(0.05)}, count='num_chan'),
    'siggen': C(values={'frequency': once(1, 17.5, 100)}, count='num_chan'),
    'debounce': C(['debounce cfg=3'], {'delay': whole(0, 5)}, prefix='debounce.0.', single=True),
    'charge_pump': C(prefix='charge-pump.', single=True),
    'supply': C(single=True),
    'thc': C(values={'vel-scale': once(1.1), 'scale-offset': once(3), 'velocity-tol': once(5),
                     'voltage-tol': once(1), 'correction-vel': once(0.01), 'volts-requested': once(105),
                     'requested-vel': once(10), 'current-vel': uniform(9, 10.5), 'encoder-vel': uniform(90, 110),
                     'z-pos-in': walk(0.01)}, prefix='thc.', single=True),
    'thcud': C(values={'velocity-tol': once(5), 'correction-vel': once(0.01), 'requested-vel': once(10),
                       'current-vel': uniform(9, 10.5), 'z-pos-in': walk(0.01)}, prefix='thcud.', single=True),
    'watchdog': C(['watchdog num_inputs=3'], {'timeout-.': once(0.003, 0.0055), 'input-.': bits(0.8)},
                  prefix='watchdog.', ordered=True, single=True),
    'weighted_sum': C(['weighted_sum wsum_sizes=4'], prefix='wsum.0.', single=True),
    'encoder': C(['encoder num_chan=1'], {'position-scale': once(1, 4, -10), 'counter-mode': constant(0),
                                          'x4-mode': once(0, 1), 'missing-teeth': constant(0),
                                          'min-speed-estimate': once(0, 1)},
                 pairs=[('phase-A', 'phase-B')], single=True),
    'counter': C(['counter num_chan=1'], {'position-scale': once(1, 4, -10)}, single=True),
    'encoder_ratio': C(['encoder_ratio num_chan=1'], {'.*teeth': once(1, 9, 5), '.*ppr': once(1, 4)},
                       pairs=[('master-A', 'master-B'), ('slave-A', 'slave-B')], single=True),
    'sim_encoder': C(['sim_encoder num_chan=1'], {'speed': pick(0, 1.3, -3.7, 9.1, change=0.02), 'ppr': once(4, 10)},
                     single=True),
    'stepgen': C([f'stepgen step_type={t} ctrl_type={c}' for t in (0, 1, 2, 5, 9) for c in 'pv'],
                 {'position-cmd': walk(0.02), 'velocity-cmd': pick(0, 30, -80, 60, change=0.05),
                  'enable': bits(0.02), 'position-scale': once(1, 4, -3), 'maxaccel': once(0, 500, 5000),
                  'maxvel': once(0, 50, 1000), '(step|dir).*': once(1, 1000000, 2000000)}, single=True),
    'pwmgen': C([f'pwmgen output_type={t}' for t in (0, 1, 2)],
                {'pwm-freq': once(0, 10, 100), 'value': pick(-1.2, -0.5, 0.0, 0.3, 0.8, 2.0, change=0.05),
                 'scale': once(1, 2), 'enable': bits(0.03), 'min-dc': once(0, 0.2), 'max-dc': once(0.7, 1),
                 'offset': once(0, 0.1)}, single=True),
    'multiswitch': C(['multiswitch cfg=4'], {'top-position': whole(1, 3), 'position': constant(0)}, single=True),
    'mux_generic': C(['mux_generic config=ff4', 'mux_generic config=bb5', 'mux_generic config=fs4',
                      'mux_generic config=ub3'], {'debounce-us': once(0, 2500), 'sel-int': whole(0, 4, 0.1)},
                     prefix='mux-gen.00.', single=True),
    'matrix_kb': C(['matrix_kb config=4x4'], {'keycode': pick(0x40, 0x80, 0xc0, 0xc5, 0x85, 0xc2, 0x82, 0)},
                   prefix='matrix_kb.0.', single=True),

    'sim_matrix_kb': C(values={'button.c03.r04': bits(0.1)}, skip='button.*(?<!c03.r04)'),
    'sim_home_switch': C(values={'index-delay-ms': once(1, 3.5, 10)}),
    'feedcomp': C(values={'feed': once(0.5, 2)}), 'spindle_monitor': C(skip='level'),
    'updown': C(values={'max': once(2, 5), 'min': once(-2, 0)}),
    'clarkeinv': C(values={'theta': uniform(-3, 3)}),
    'multiclick': C(values={'.*-ns': once(2000000, 3500000, 5500000)}),
    'toggle': C(values={'debounce': once(1, 2, 3)}), 'sim_spindle': C(values={'scale': once(1, 2)}),
    'ilowpass': C(values={'scale': once(1, 1024), 'gain': once(0.1, 0.5, 1)}),
    'sim_axis_hardware': C(values={'.*sw-upper': uniform(1.5, 3), '.*maxsw-lower': once(1.5),
                                   '.*minsw-lower': once(-3), '.*homesw-hyst': once(0.2), '.*homesw-pos': once(1)}),
    'bldc': C(['bldc cfg=' + c for c in ('a', 'aT', 'aB6', 'aHF', 'h', 'h6', 'f', 'n', 'qh')],
              {'value': pick(0.5, -0.3, 1.0, 0.0, change=0.1), 'rawcounts': walk_whole(30),
               'pattern': once(25, 7, 40), 'output-pattern': once(25, 13), 'rev': bits(0.02),
               'frequency': pick(0, 5, -20, change=0.1)}, single=True),
    'moveoff': C(['moveoff personality=2']),
})
