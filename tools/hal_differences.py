# SPDX-License-Identifier: GPL-2.0-or-later
"""Intended differences from LinuxCNC's components, for compare_hal.py.

Each entry names the pins that may differ and the row of docs/reference/compatibility.md that explains it. `avoid` contains inputs
or parameters with which the difference does not occur: most files use them, and then the entry does not apply.
"""
import dataclasses
import re

from hal_components import LateBit, SlowBit, uniform


@dataclasses.dataclass(frozen=True)
class Difference:
    component: str  # regular expression over the module's name
    pins: str       # regular expression over the outputs, without the prefix
    row: str        # beginning of the row in docs/reference/compatibility.md, without '| '
    load: str = ''  # regular expression over the load, if the difference depends on it
    shift: int = 0  # values may come this number of periods earlier or later
    first: int = 0  # in this number of periods the pins may still differ
    by: int = 0     # values may differ by this amount
    along: str = ''  # differs only within 2 periods of one in which this pin of the same instance differs
    avoid: dict = dataclasses.field(default_factory=dict, hash=False, compare=False)

    def covers(self, pin):
        return re.fullmatch(self.pins, pin) is not None


D = Difference
DIFFERENCES = [
    D('pid', 'output|saturated.*|error[DI]?|commandD+', 'pid: first period', first=4,
      avoid={'enable': LateBit(5)}),
    D('comp', 'out', 'comp: out with hyst 0', avoid={'hyst': 0.7}),
    D('tp', 'q|et', 'tp: an edge of in in the period after a pulse', avoid={'in': SlowBit(8)}),
    D('conv_.*', 'out-of-range', 'conv components'),
    D('conv_(float|s32)_u32', 'out', 'conv components', avoid={'clamp': 0}),
    D('d(e)?bounce', r'out|\d\.out', 'dbounce, debounce'),
    D('sphereprobe', 'probe-out', 'sphereprobe: below', avoid={'cz': -1000}),
    D('toggle2nist', 'on|off', 'toggle2nist'),
    D('spindle_monitor', 'spindle-at-speed', 'spindle_monitor: at-speed', avoid={'spindle-is-on': 1}),
    D('spindle_monitor', 'spindle-.*', 'spindle_monitor: underspeed', avoid={'spindle-command': uniform(1, 3)}),
    D('histobins', '.*', 'histobins'),
    D('eoffset_per_angle', '.*', 'eoffset_per_angle'),
    D('demux', 'out-.*', 'demux: bargraph', avoid={'bargraph': 0}),
    D('gantry', '.*', 'gantry with three'),
    D('thcd?|thcud', '.*', 'thc, thcud'),
    D('simple_tp|anglejog|steptest|moveoff', '.*', 'simple_tp, anglejog, steptest, moveoff'),
    D('limit3', '.*', 'limit3 |'),
    D('watchdog', 'ok-out', 'watchdog |', first=1, avoid={'enable-in': 1}),
    D('counter', 'velocity', 'counter, encoder: velocity'),
    D('counter', 'index-enable', 'counter: index-enable'),
    D('counter|encoder', '.*', 'counter, encoder: phase-Z', avoid={'phase-Z': LateBit(2)}),
    D('encoder', 'velocity.*|position-interpolated', 'counter, encoder: velocity'),
    D('sim_encoder', 'phase-.|rawcounts', 'sim_encoder: pulses'),
    D('pwmgen', 'pwm|up|down', 'pwmgen: first pulse'),
    D('pwmgen', '.*', 'pwmgen: scale', first=3, avoid={'scale': 1}),
    D('pwmgen', 'pwm-freq', 'pwmgen: pwm-freq'),
    D('pwmgen', '.*', 'pwmgen: min-dc', avoid={'min-dc': 0.0}),
    D('scaled_s32_sums', 'out-s', 'scaled_s32_sums, mux16 out of range'),
    D('orient', 'is-oriented', 'orient: is-oriented'),
    D('matrix_kb', 'key.*', 'matrix_kb: releases'),
    D('ohmic', 'ohmic-on', 'ohmic |'),
    D('mux16|mux_generic', 'out-.*', 'mux16, mux_generic: debouncing', avoid={'debounce-time': 0, 'debounce-us': 0}),
    D('sim_axis_hardware', 'A.*-homesw-out', 'sim_axis_hardware: axis A'),
    D('sim_spindle', 'index-enable', 'sim_spindle: index', avoid={'velocity-cmd': uniform(1, 3)}),
    D('knob2float', 'out', 'knob2float', avoid={'enable': LateBit(2)}),
    D('bldc', '.*', 'bldc: first period', first=2),
    D('stepgen', 'position-fb', 'stepgen: position control'),
    D('stepgen', 'step|dir|up|down|phase-.|counts|rawcounts', 'stepgen: position control', shift=2,
      load='.*ctrl_type=v'),
    D('stepgen', 'counts|rawcounts', 'stepgen: dirsetup', by=1, load='.*ctrl_type=v'),
    D('stepgen', 'step|dir|up|down|phase-.', 'stepgen: dirsetup', along='counts', load='.*ctrl_type=v'),
    D('stepgen', '.*', 'stepgen: position control', load='.*ctrl_type=p'),
    D('spindle', '.*', 'spindle: ramps'),
]


def rows_without_page(page):
    """The rows that docs/reference/compatibility.md does not have."""
    return sorted({d.row for d in DIFFERENCES if not re.search(r'^\| ' + re.escape(d.row), page, re.M)})


def of_component(name, load=''):
    return [d for d in DIFFERENCES if re.fullmatch(d.component, name) and re.fullmatch(d.load or '.*', load)]
