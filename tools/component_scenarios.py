#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The inputs that compare_components.py feeds to components: rows from a seed, and the outputs to compare."""
import random


def bits(change=0.5):
    """A bit that changes to a random value with this probability."""
    return lambda r, last: last if last is not None and r.random() > change else r.randint(0, 1)


def uni(low, high):
    """A uniform float."""
    return lambda r, last: round(r.uniform(low, high), 4)


def ints(low, high, change=1.0):
    return lambda r, last: last if last is not None and r.random() > change else r.randint(low, high)


def pick(*choices, change=1.0):
    return lambda r, last: last if last is not None and r.random() > change else r.choice(choices)


def const(value):
    return lambda r, last: value


def walk(step):
    return lambda r, last: round((last or 0) + r.uniform(-step, step), 5)


def scenario(load, inputs, outputs, *, n=200, setp=None, add=None, prefix=None, seed=1, period=1000000, known=""):
    """`known`: the reason why ours differs on purpose; such differences are reported but are not failures."""
    name = load.split()[0]
    prefix = prefix or name.replace("_", "-") + ".0"
    random_source = random.Random(seed)
    rows = []
    last = [None] * len(inputs)
    for _ in range(n):
        last = [draw(random_source, value) for draw, value in zip(inputs.values(), last)]
        rows.append(tuple(last))
    return {"load": load, "add": add or [prefix], "ins": [prefix + "." + k for k in inputs],
            "outs": [prefix + "." + o for o in outputs.split()], "rows": rows, "period": period, "known": known,
            "setp": {prefix + "." + k: v for k, v in (setp or {}).items()}}


SCENARIOS = [
 scenario('abs', {'in': uni(-3,3)}, 'out sign is-positive is-negative'),
 scenario('abs_s32', {'in': ints(-3,3)}, 'out sign is-positive is-negative'),
 scenario('bin2gray', {'in': ints(0,2**31)}, 'out'),
 scenario('gray2bin', {'in': ints(0,2**31)}, 'out'),
 scenario('bitslice personality=3', {'in': ints(0,20)}, 'out-00 out-01 out-02'),
 scenario('bitwise', {'in0': ints(0,2**31),'in1': ints(0,2**31)}, 'out-and out-or out-xor out-nand out-nor out-xnor'),
 scenario('lut5', {'in-%d'%i: bits() for i in range(5)}, 'out', setp={'function':'0x5a3c9911'}),
 scenario('maj3', {'in1': bits(),'in2': bits(),'in3':bits()}, 'out'),
 scenario('maj3', {'in1': bits(),'in2': bits(),'in3':bits()}, 'out', setp={'invert':1}),
 scenario('match8', dict([('in',bits(.3))]+[('a%d'%i,bits()) for i in range(3)]+[('b%d'%i,bits()) for i in range(3)]),
          'out'),
 scenario('tristate_bit', {'in': bits(),'enable': bits()}, 'out'),
 scenario('tristate_float', {'in': uni(0,1),'enable': bits()}, 'out'),
 scenario('toggle2nist', {'in': bits(.1), 'is-on': bits(.05)}, 'on off',
          known="a press while another is under way is ignored, not kept"),
 scenario('demux personality=6', {'sel-u32': ints(0,8), 'sel-bit-00': bits(), 'sel-bit-02':bits(.2)},
          'out-00 out-01 out-02 out-05'),
 scenario('demux personality=6', {'sel-u32': ints(0,5)}, 'out-00 out-01 out-02 out-05', setp={'bargraph':1}),
 scenario('dbounce', {'in': bits(.4)}, 'out', setp={'delay':3},
          known="a delay of N is N periods, as the manual says, not N + 1"),
 scenario('debounce cfg=1', {'0.in': bits(.4)}, '0.out', setp={'delay':3}, prefix='debounce.0',
          known="a delay of N is N periods, as the manual says, not N + 1"),
 scenario('toggle', {'in': bits(.4)}, 'out'),
 scenario('toggle', {'in': bits(.3)}, 'out', setp={'debounce':4}),
 scenario('updown', {'countup': bits(),'countdown': bits(),'reset':bits(.05)}, 'count'),
 scenario('updown', {'countup': bits(), 'countdown': bits(.3), 'reset':bits(.05)}, 'count', setp={'clamp':1,
          'max':3, 'min':-2}),
 scenario('updown', {'countup': bits(), 'countdown': bits(.3), 'reset':bits(.05)}, 'count', setp={'wrap':1, 'max':3,
          'min':-2}),
 scenario('div2', {'in0': uni(-2,2),'in1': uni(-1,1)}, 'out', setp={'deadband':.3}),
 scenario('div2', {'in0': uni(-2,2),'in1': pick(0,1,2)}, 'out'),
 scenario('invert', {'in': uni(-1,1)}, 'out', setp={'deadband':.3}),
 scenario('invert', {'in': pick(0,1,-2)}, 'out'),
 scenario('integ', {'in': uni(-1,2),'gain': uni(1,2),'reset':bits(.03)}, 'out', setp={'max':.02,'min':-.01}),
 scenario('minmax', {'in': uni(-1,2),'reset':bits(.03)}, 'min max'),
 scenario('wcomp', {'in': uni(-1,2),'min':pick(0,.5,change=.1),'max':pick(1,1.5,change=.1)}, 'out under over'),
 scenario('blend', {'in1': uni(-1,2),'in2':uni(0,3),'select':uni(-.5,1.5)}, 'out'),
 scenario('blend', {'in1': uni(-1,2),'in2':uni(0,3),'select':uni(-.5,1.5)}, 'out', setp={'open':1}),
 scenario('deadzone', {'in': uni(-2,2)}, 'out', setp={'center':.4,'threshold':1.2}),
 scenario('clarke2', {'a': uni(-2,2),'b':uni(-2,2)}, 'x y'),
 scenario('clarke3', {'a': uni(-2,2),'b':uni(-2,2),'c':uni(-2,2)}, 'x y h'),
 scenario('clarkeinv', {'x': uni(-2,2),'y':uni(-2,2),'h':uni(-2,2),'theta':uni(-1,1)}, 'a b c'),
 scenario('scaled_s32_sums', {'in0': ints(-9,9), 'scale0':uni(-2,2), 'in3':ints(-9,9), 'scale2':uni(0,1),
          'in2':ints(-9,9)}, 'out-s out-f'),
 scenario('sample_hold', {'in': ints(-9,9),'hold':bits(.2)}, 'out'),
 scenario('lincurve personality=4', {'in': uni(-1,6)}, 'out out-io', setp={'x-val-00':0, 'x-val-01':1,
          'x-val-02':2.5, 'x-val-03':5, 'y-val-00':3, 'y-val-01':-1, 'y-val-02':7, 'y-val-03':7.5}),
 scenario('weighted_sum wsum_sizes=3', {'bit.0.in': bits(), 'bit.1.in':bits(), 'bit.2.in':bits(), 'hold':bits(.2)},
          'sum', setp={'offset':-3, 'bit.1.weight':20}, prefix='wsum.0', add=['process_wsums']),
 scenario('mux8', {'sel0': bits(),'sel1':bits(),'sel2':bits()}, 'out', setp={'in%d'%i:i*1.5 for i in range(8)}),
 scenario('mux16', {'sel0': bits(), 'sel1':bits(), 'sel2':bits(), 'sel3':bits(), 'suppress-no-input':bits(.1),
          'use-graycode':bits(.1)}, 'out-f out-s', setp={'in%02d'%i:i*1.5-7 for i in range(16)}),
 scenario('mux16', {'sel0': bits(.03)}, 'out-f out-s', setp={'in01':3,'debounce-time':.0045}),
 scenario('biquad', {'in': uni(-1,2),'enable':bits(.03)}, 'out valid s1 s2', setp={'f0':80,'type':1}),
 scenario('biquad', {'in': uni(-1,2),'enable':bits(.03)}, 'out valid', setp={'f0':80,'type':2,'Q':1.3}),
 scenario('biquad', {'in': uni(-1,2),'enable':bits(.03)}, 'out valid', setp={'f0':80,'type':2,'Q':2.3}),
 scenario('biquad', {'in': uni(-1,2),'enable':bits(.03)}, 'out valid', setp={'n0':.3,'n1':.1,'n2':.2,'d1':.3,'d2':-.1}),
 scenario('filter_kalman', {'zk': uni(-1,2), 'passthrough':bits(.03), 'reset':bits(.03)}, 'xk-out', setp={'Rk':.1,
          'Qk':.02}),
 scenario('filter_kalman', {'zk': uni(-1,2)}, 'xk-out'),
 scenario('multiclick', {'in': bits(.4)},
          'single-click single-click-only double-click double-click-only triple-click triple-click-only quadruple-click quadruple-click-only state',
          n=1500, setp={'max-hold-ns':3000000, 'max-space-ns':3000000, 'output-hold-ns':2000000}),
 scenario('multiclick', {'in': bits(.4)}, 'single-click single-click-only double-click double-click-only state',
          n=500, setp={'invert-input':1, 'max-hold-ns':3500000, 'max-space-ns':2500000, 'output-hold-ns':2500000}),
 scenario('ton', {'in': bits(.1)}, 'q et', setp={'pt':.0055}),
 scenario('tof', {'in': bits(.1)}, 'q et', setp={'pt':.0055}),
 scenario('time', {'start': bits(.02),'pause': bits(.02)}, 'seconds minutes hours', n=400, period=20000000),
 scenario('threadtest', {}, 'count', add=['threadtest.0.increment']) ,
 scenario('histobins', {'input': uni(-2,8), 'index':ints(-1,7)}, 'check binvalue pextra nextra input-error',
          setp={'nbins':6}, known="the first value is counted too"),
 scenario('joyhandle', {'in': uni(-1.2,1.2)}, 'out', setp={'power':1.7,'deadband':.15,'scale':2,'offset':.1}),
 scenario('joyhandle', {'in': uni(0,1.2)}, 'out', setp={'power':1.7,'deadband':.15,'scale':2,'offset':.1,'inverse':1}),
 scenario('knob2float', {'counts': ints(-9,9,.3),'enable':bits(.1)}, 'out', setp={'scale':.07}),
 scenario('multiswitch cfg=4', {'up': bits(),'down':bits(.3)}, 'bit-00 bit-01 bit-02 bit-03'),
 scenario('gearchange', {'sel': bits(.2), 'speed-in':uni(-500,900), 'dir-in':bits()}, 'speed-out dir-out',
          setp={'min1':20, 'max1':300, 'min2':50, 'max2':700, 'scale2':2.5, 'reverse':1}),
 scenario('feedcomp', {'in': uni(0,1),'vel':uni(-1,2),'enable':bits(.2)}, 'out', setp={'feed':2}),
 scenario('differential', {'roll-cmd': uni(0,1), 'pitch-cmd':uni(-1,2), 'motor0-fb':uni(0,9), 'motor1-fb':uni(0,9)},
          'roll-fb pitch-fb motor0-cmd motor1-cmd'),
 scenario('corexy_by_hal', {'alpha-fb': uni(0,1), 'beta-fb':uni(-1,2), 'j0-motor-pos-cmd':uni(0,9),
          'j1-motor-pos-cmd':uni(0,9)}, 'alpha-cmd beta-cmd j0-motor-pos-fb j1-motor-pos-fb'),
 scenario('sphereprobe', {'px': ints(-9,9), 'py':ints(-9,9), 'pz':ints(-9,9)}, 'probe-out', setp={'cx':2, 'cy':-1,
          'cz':-2, 'r':6}, known="below the middle plane is always a touch"),
 scenario('sim_matrix_kb', {'button.c00.r00': bits(.1), 'button.c01.r00':bits(.1), 'button.c03.r05':bits(.1),
          'button.c07.r07':bits(.1)}, 'out'),
]
SCENARIOS += [
 scenario('thc', {'enable':bits(.05), 'torch-on':bits(.05), 'arc-ok':bits(.05), 'current-vel':uni(9,10.5),
          'encoder-vel':uni(90,110), 'z-pos-in':walk(.01)}, 'vel-status volts z-fb-out', setp={'vel-scale':1.1,
          'scale-offset':3, 'velocity-tol':5, 'voltage-tol':1, 'correction-vel':.01, 'volts-requested':105,
          'requested-vel':10}, prefix='thc',
          known="vel-status is shown while thc is off too; the correction never jumps"),
 scenario('thc', {'current-vel':uni(9,10.5), 'encoder-vel':uni(90,110), 'z-pos-in':walk(.01)},
          'z-pos-out vel-status volts z-fb-out', setp={'enable':1, 'torch-on':1, 'arc-ok':1, 'vel-scale':1.1,
          'scale-offset':3, 'velocity-tol':5, 'voltage-tol':1, 'correction-vel':.01, 'volts-requested':105,
          'requested-vel':10}, prefix='thc',
          known="vel-status is shown while thc is off too; the correction never jumps"),
 scenario('thcud', {'torch-up':bits(.3), 'torch-down':bits(.3), 'current-vel':uni(9,10.5), 'z-pos-in':walk(.01)},
          'z-pos-out vel-status z-fb-out', setp={'enable':1, 'torch-on':1, 'arc-ok':1, 'velocity-tol':5,
          'correction-vel':.01, 'requested-vel':10}, prefix='thcud'),
 scenario('gantry personality=3', {'position-cmd':walk(.3), 'joint.00.home':bits(.05), 'joint.01.home':bits(.05),
          'joint.02.home':bits(.05), 'joint.00.pos-fb':uni(0,1), 'joint.01.pos-fb':uni(0,1)},
          'joint.00.pos-cmd joint.01.pos-cmd joint.02.pos-cmd joint.00.offset joint.02.offset home limit position-fb',
          setp={'search-vel':-1}, add=['gantry.0.read', 'gantry.0.write'],
          known="home only when all switches are made"),
 scenario('orient', {'enable':bits(.2),'mode':pick(0,1,2),'position':uni(-4,4),'angle':uni(0,359)}, 'command poserr'),
 scenario('ohmic', {'velocity-in':uni(0,35000)}, 'thcad-volts ohmic-volts arc-on', setp={'thcad-0-volt-freq':122900,
          'thcad-max-volt-freq':925700}),
 scenario('spindle_monitor', {'spindle-is-on':bits(.03), 'spindle-command':pick(10,20,change=.02),
          'spindle-feedback':uni(5,22)}, 'spindle-at-speed spindle-underspeed', setp={'threshold':5},
          known="at-speed ends with the spindle, not a period later"),
 scenario('eoffset_per_angle', {'is-on':bits(.02), 'enable-in':bits(.05), 'active':bits(.1), 'angle':walk(20)},
          'is-off enable-out clear kcounts kreciprocal eoffset-dbg state-dbg', n=600,
          known="follows its inputs in the same period"),
] + [scenario('eoffset_per_angle', {'is-on':const(1), 'enable-in':bits(.02), 'active':const(1), 'angle':walk(20)},
          'kcounts', n=300, setp={'fnum':f, 'fmult':5, 'start-angle':7, 'rfraction':.3, 'radius-ref':3},
          known="follows its inputs in the same period") for f in range(4)] + [
 scenario('spindle', {'commanded-speed':pick(100,-200,500,30,0,change=.02)}, 'output spindle-rpm at-speed limited',
          n=300, setp={'enable':1, 'simulate-encoder':1, 'max.0':400, 'min.0':50, 'accel.0':900, 'decel.0':1500,
          'offset.0':3, 'scale.0':.1}, period=10000000, known="the direction changes at speed 0"),
 scenario('spindle', {'commanded-speed':pick(100,300,500,30,change=.02), 'actual-speed':uni(0,5)},
          'output spindle-rpm at-speed limited', n=300, setp={'enable':1, 'max.0':400, 'min.0':50, 'accel.0':90,
          'decel.0':50, 'offset.0':3, 'scale.0':.1}, period=10000000, known="the direction changes at speed 0"),
 scenario('simple_tp', {'target-pos':pick(0,1,.5,-.2,change=.01), 'enable':const(1)}, 'current-pos', n=1000,
          setp={'maxvel':2, 'maxaccel':20}, add=['simple-tp.0.update'],
          known="stops exactly at the target, and as soon as the limits allow"),
 scenario('anglejog', {'enable-in':const(1), 'counts-in':ints(0,5,.02)}, 'coscounts sincounts enable-out', n=600,
          setp={'max-vel':2, 'max-accel':20, 'scale-in':.01, 'angle-degrees-in':30},
          known="the planner of simple_tp"),
 scenario('watchdog num_inputs=2', {'input-0':bits(.8), 'input-1':bits(.8), 'enable-in':const(1)}, 'ok-out', n=300,
          setp={'timeout-0':.004, 'timeout-1':.004}, prefix='watchdog', add=['watchdog.set-timeouts',
          'watchdog.process']),
 scenario('pwmgen output_type=1', {'enable':const(1), 'value':uni(-1.2,1.2)}, 'dir curr-dc', setp={},
          prefix='pwmgen.0', add=['pwmgen.update', 'pwmgen.make-pulses']),
 scenario('pwmgen output_type=2', {'enable':const(1), 'value':pick(.3,-.2,.7,change=.02)}, 'up down curr-dc',
          setp={}, prefix='pwmgen.0', add=['pwmgen.update', 'pwmgen.make-pulses'],
          known="the first pulse comes a period later there"),
]
SCENARIOS += [
 scenario('matrix_kb config=4x4', {'keycode':pick(0x40,0x80,0xc0,0xc5,0x85,0xc2,0x82,0xca,0x8a,0)},
          'key.r0c0 key.r1c1 key.r0c2 key.r2c2', prefix='matrix_kb.0',
          known="a key that is pressed twice counts once"),
 scenario('sim_parport names=pp', {'pin-02-out':bits(), 'pin-12-in-fake':bits()},
          'pin-02-out-fake pin-12-in pin-12-in-not', setp={'pin-02-out-invert':1}, prefix='pp', add=['pp.read',
          'pp.write']),
 scenario('sim_axis_hardware', {'Xcurrent-pos':uni(-12,12), 'Ycurrent-pos':uni(0,7), 'Xhoming':bits(.1),
          'Yhoming':bits(.1)},
          'Xhomesw-out Xmaxsw-out Xminsw-out Xbothsw-out Ymaxsw-homesw-out Yminsw-homesw-out Ybothsw-homesw-out homesw-all limitsw-all limitsw-homesw-all',
          n=500, setp={'Xmaxsw-upper':11, 'Xmaxsw-lower':9, 'Xminsw-upper':-9, 'Xminsw-lower':-11, 'Ymaxsw-lower':5,
          'Ymaxsw-upper':6, 'Yhomesw-hyst':2, 'Xhomesw-hyst':1, 'limit-offset':.5},
          add=['sim-axis-hardware.0.update']),
 scenario('bldc cfg=a', {'value':uni(-1,1), 'rev':bits(.1), 'rawcounts':ints(-600,600,.1)},
          'A-value B-value C-value phase-angle rotor-angle out out-dir out-abs', setp={'poles':6, 'scale':1000,
          'encoder-offset':77, 'lead-angle':80}, prefix='bldc.0', known="works from the first period on"),
 scenario('bldc cfg=aT', {'value':uni(-1,1), 'rawcounts':ints(-600,600)}, 'A-value B-value C-value',
          prefix='bldc.0', known="works from the first period on"),
 scenario('bldc cfg=aB6', {'value':uni(-1,1), 'rawcounts':ints(-600,600)},
          'A-high-on B-high-on C-high-on A-low-on B-low-on C-low-on', prefix='bldc.0',
          known="works from the first period on"),
 scenario('bldc cfg=aHF', {'value':uni(0,1), 'rawcounts':ints(-600,600)},
          'hall1-out hall2-out hall3-out C1-out C2-out C4-out C8-out', prefix='bldc.0', setp={'output-pattern':13},
          known="both codes are made"),
 scenario('bldc cfg=f', {'value':uni(-1,1), 'C1':bits(), 'C2':bits(), 'C4':bits(), 'C8':bits()},
          'A-value B-value C-value rotor-angle', prefix='bldc.0', known="works from the first period on"),
 scenario('bldc cfg=n', {'value':uni(0,1), 'frequency':uni(-100,100)}, 'A-value B-value C-value rotor-angle',
          prefix='bldc.0', known="works from the first period on"),
] + [scenario('bldc cfg=h6', {'value':uni(-1,1), 'hall1':bits(), 'hall2':bits(), 'hall3':bits()},
          'A-high B-high C-high A-low B-low C-low', prefix='bldc.0', setp={'pattern':q},
          known="works from the first period on") for q in (25,7,40)] + [
 scenario('lcd fmt_strings=a%+5.2f;%6d;%06d;%x;%4X;%o;%c;%3c|b%u', {'page_num':pick(0,1,change=.01)}, 'out', n=1500,
          prefix='lcd.00', add=['lcd'], setp={'page.00.arg.00':3.14159, 'page.00.arg.01':-42, 'page.00.arg.02':-42,
          'page.00.arg.03':255, 'page.00.arg.04':171, 'page.00.arg.05':8, 'page.00.arg.06':65, 'page.00.arg.07':66,
          'page.01.arg.00':12}, period=200000, known="no silent period behind a page"),
 scenario('lcd fmt_strings=%4.2f;%3d;%08.3f;%f', {'contrast':pick(0,.5,1,change=.003)}, 'out', n=1500,
          prefix='lcd.00', add=['lcd'], setp={'page.00.arg.00':-314.159, 'page.00.arg.01':-4200,
          'page.00.arg.02':-3.14159, 'page.00.arg.03':2.5}, period=200000, known="no silent period behind a page"),
]
