#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the same HAL commands with LinuxCNC's halrun and ours, and compares answers, failing lines and status.

Fixed sequences cover every command; random ones mix valid and invalid calls. Not compared: column widths (they differ between
versions of LinuxCNC), addresses, process ids, ids of components, the component of halcmd (ours has none), texts of messages (ours
are longer), and the lines listed in DIFFERENCES.
"""
import argparse
import difflib
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

SETUP = """loadrt threads name1=fast period1=100000 name2=slow period2=1000000
loadrt and2 count=3
loadrt or2 names=left,right.one
loadrt siggen num_chan=2
loadrt conv_float_s32 count=2
loadrt conv_u32_bit
loadrt conv_s32_u32
loadrt edge count=2
"""

DUMP = """show pin
show sig
show param
show alias
show thread
list comp
list pin
list sig
list param
list funct
list thread
save all
save allu
save sig
save sigu
save link
save linka
save net
save neta
save netl
save netla
save netal
save alias
save comp
save param
save thread
save unconnectedinpins
status lock
"""

FIXED = {
    'setup': DUMP,
    'links': """net a and2.0.out => and2.1.in0
net a => and2.1.in1
net a <= and2.2.out
net b siggen.0.sine => siggen.1.offset
net b => and2.0.in0
net and2.0.in0 and2.0.out
net c and2.0.in0 and2.0.nosuch
net d
net
newsig e float
newsig e float
newsig f bit
newsig g s32
newsig h u32
newsig k port
newsig l bogus
newsig m
linkps and2.0.in0 => f
linkps and2.0.in0 f
linksp f <= left.in0
linksp f left.out
linksp f right.one.out
linkpp left.in1 => right.one.in1
linkpp left.in1 siggen.0.sine
linkpp nosuch left.in1
unlinkp and2.1.in0
unlinkp and2.1.in0
unlinkp nosuch
delsig a
delsig a
delsig nosuch
""" + DUMP,
    'values': """setp and2.0.in0 1
setp and2.0.in1 TRUE
setp and2.1.in0 true
setp and2.1.in1 True
setp and2.2.in0 yes
setp and2.2.in0 on
setp and2.2.in0 2
setp and2.2.in0 1.0
setp and2.0.out 1
setp and2.0.tmax 5
setp and2.0.tmax 0x10
setp and2.0.tmax -1
setp and2.0.tmax 1.5
setp and2.0.tmax abc
setp and2.0.tmax-increased 1
setp siggen.0.amplitude .15
setp siggen.0.frequency 4.2e1
setp siggen.0.offset 0x10
setp siggen.0.offset abc
setp siggen.1.amplitude -0
setp siggen.1.frequency 5.
setp conv-u32-bit.0.in 0xffffffff
setp conv-u32-bit.0.in 010
setp conv-s32-u32.0.in -2147483648
setp conv-s32-u32.0.in +7
setp conv-s32-u32.0.in 7x
setp nosuch 1
setp and2.0.in0
setp and2.0.in0 1 2
and2.0.in0 = 0
and2.0.in1=0
siggen.0.amplitude = 2.5
getp and2.0.in0
getp siggen.0.amplitude
getp siggen.0.frequency
getp and2.0.tmax
getp conv-u32-bit.0.in
getp nosuch
getp
ptype and2.0.in0
ptype siggen.0.amplitude
ptype and2.0.tmax
ptype conv-u32-bit.0.in
ptype nosuch
newsig f float
newsig b bit
newsig s s32
newsig u u32
sets f 1.5
sets f abc
sets b 1
sets b maybe
sets s -5
sets u 0xff
sets nosuch 1
sets f
gets f
gets b
gets s
gets u
gets nosuch
gets
stype f
stype b
stype nosuch
net w siggen.0.sine
sets w 1
net r siggen.0.offset
sets r 3.25
getp siggen.0.offset
setp siggen.0.offset 1
unlinkp siggen.0.offset
getp siggen.0.offset
""" + DUMP,
    'numbers': ''.join(f'setp siggen.0.amplitude {v}\ngetp siggen.0.amplitude\nshow pin siggen.0.amplitude\n'
                       for v in ('1e-7', '123456.789', '1234567.89', '1e15', '1e16', '-0.1', '3.14159265358979',
                                 '1e-300', '100000', '0.0001', '0.00001', '2e0', '1,5')),
    'threads': """addf and2.0 fast
addf and2.1 fast
addf and2.2 fast 1
addf left fast -1
addf right.one fast 2
addf siggen.0.update slow
addf siggen.1.update slow -2
addf edge.0 slow 5
addf edge.0 slow 0
addf edge.0 slow x
addf and2.0 fast
addf nosuch fast
addf and2.0 nosuch
addf and2.0
addf edge.0 slow -3
show thread
show thread fast
show thread f*
show thread nosuch
delf and2.0 fast
delf and2.0 fast
delf nosuch fast
delf and2.1 nosuch
delf and2.1
show thread
start
start
stop
stop
save thread
list thread
list thread f*
list funct and*
show funct nosuch
""",
    'alias': """alias pin and2.0.in0 one
alias pin and2.0.in0 two
alias pin one three
alias pin and2.0.in1 three
alias pin and2.1.in0 and2.1.in1
alias pin nosuch x
alias param and2.0.tmax slowest
alias param nosuch x
alias bogus and2.0.in0 x
alias pin and2.0.in0
setp two 1
setp three 1
getp and2.0.in0
getp three
net s three
show alias
show pin three
show pin and2.0.in0
show pin and2.0.*
list pin and2.0.*
list pin t*
save alias
unalias pin three
unalias pin and2.0.in0
unalias pin nosuch
unalias param slowest
unalias bogus x
show alias
""" + DUMP,
    'patterns': '\n'.join(f'{c} {k} {p}' for c in ('show', 'list')
                          for k in ('pin', 'param', 'sig', 'comp', 'funct', 'thread', 'alias', 'bogus')
                          for p in ('', 'and2', 'and2*', '*in?', '[as]*', 'and2.0.in0 left*', 'zz*', *(['-tbit', '-tfloat *s*'] if (c, k) == ('show', 'pin') else []))) + """
show
show all
show all and2*
show pin and2.1 siggen.0.s
show function
show parameter
show signal
list function
list parameter
list signal
list
save bogus
save all all.out
save pin
status
status all
status bogus
""",
    'lock': '\n'.join(f'{lock}\nstatus lock\nloadrt and2 names=n{i}\nnet n{i} and2.0.in0\nunlinkp and2.0.in0\n'
                      f'newsig q{i} bit\ndelsig q{i}\n'
                      f'addf and2.0 fast\ndelf and2.0 fast\nstart\nstop\nalias pin and2.0.in0 al{i}\n'
                      f'unalias pin al{i}\nunlock all\nloadrt or2 names=o{i}\nunloadrt or2'
                      for i, lock in enumerate(('lock', 'lock none', 'lock tune', 'lock all', 'lock bogus',
                                                'lock all\nunlock tune', 'lock tune\nunlock tune', 'lock\nunlock',
                                                'lock tune\nunlock all', 'unlock bogus', 'unlock none'))) + DUMP,
    'load': """loadrt and2 count=1
loadrt nosuch
loadrt not count=2
loadrt not
loadrt xor2 names=
loadrt abs names=a,b,c
loadrt lowpass count=x
loadrt hypot bogus=1
loadrt ddt names=p,q
list comp
unloadrt not
unloadrt not
unloadrt nosuch
unload abs
unload nosuch
unloadusr nosuch
waitusr nosuch
loadrt
unloadrt
unloadusr
unload
loadusr -w true
loadusr -w false
loadusr -iw false
loadusr -wi false
loadusr -w -i false
loadusr -Wn
loadusr -Wx true
list comp
save comp
unloadrt all
list comp
unloadusr all
unload all
""",
    'lines': """getp and2.0.in0 # comment
getp and2.0.in0# comment
 getp   and2.0.in0
\tgetp\tand2.0.in0\t
getp \\
and2.0.in0
ge\\
tp and2.0.in0
getp 'and2.0.in0
getp and2.0.in0 extra
net sig <=> and2.2.in0
net sig<=and2.2.in1
net sig2 => => and2.2.in1
net => and2.2.in1
linkps and2.2.in1 <=> sig
GETP and2.0.in0
getp AND2.0.in0
bogus
bogus 1 2
= 1
and2.0.in0 =
and2.0.in0 = 1 2
and2.0.in0 = = 1
show pin and2.0.in0;show pin
getp $(MY_PIN)
getp $MY_PIN
getp $(MY_PIN
getp and2.$(MY_NUMBER).in0
getp and2.$MY_NUMBER.in0
getp $NOT_SET_ANYWHERE
getp $
getp $()
getp [S]PIN
getp [S](PIN)
getp and2.[S](NUMBER).in0
getp and2.[S]NUMBER.in0
getp [S]NOSUCH
getp [T]PIN
getp [S]
getp [S
[S]COMMAND
[S](COMMAND)
loadrt [S]MODULE
list comp
setp siggen.0.amplitude [S]VALUE
getp siggen.0.amplitude
print hello
print
print "two words"
print two words
echo
getp and2.0.in0
unecho
getp and2.0.in0
echo 1
debug 1
debug 7
debug
debug 1 2
exit
getp and2.0.in0
""",
    'quit': 'getp and2.0.in0\nquit\ngetp and2.0.in0\n',
    'source': """source sourced.hal
source sourced.hal
source nosuch.hal
source
source a b
list sig
""",
    'noargs': '\n'.join(f'{c}\n{c} x\n{c} x y\n{c} x y z\n{c} x y z w' for c in (
        'addf alias delf delsig getp gets initf linkpp linkps linksp net newsig ptype setp sets stype unalias unlinkp '
        'start stop lock unlock source').split()) + '\nstop\nunlock all\n' + DUMP,
}

# Programs started by hand: statuses and answers.
SHELL = """r() { "$@" 2>/dev/null; echo "rc=$? $*"; }
r halcmd setp and2.0.in0 1
r halcmd getp and2.0.in0
r halcmd "setp and2.0.in1 1"
r halcmd setp and2.0.in0 = 0
r halcmd and2.0.in1 = 1
r halcmd getp and2.0.in1
r halcmd net foo and2.0.out '=>' and2.1.in0
r halcmd -s show sig
r halcmd show sig foo
r halcmd getp nosuch
r halcmd bogus
r halcmd -k getp nosuch
r halcmd source sourced.hal
r halcmd delsig from-source
r halcmd -f sourced.hal
r halcmd delsig from-source
r halcmd -f < sourced.hal
r halcmd list pin 'and2.0*'
r halcmd -q getp and2.0.in0
r halcmd loadrt not names=a,b
r halcmd addf a fast
r halcmd -s show thread
r halcmd start
r halcmd stop
r halcmd unloadrt not
r halcmd save netl
r halcmd save netl out.hal
cat out.hal
r halcmd sets foo 1
r halcmd setp and2.1.in1 '$HOME'
r halcmd setp and2.1.in1 '[S]PIN'
r halcmd -i case.ini setp and2.1.in1 '[S](NUMBER)'
r halcmd '#comment'
r halcmd getp and2.1.in1 '#comment'
r halcmd status lock
printf 'getp and2.0.in0\\n' | r halcmd -kf
printf 'bogus\\ngetp and2.0.in0\\n' | r halcmd -f
printf 'bogus\\ngetp and2.0.in0\\n' | r halcmd -k -f
printf 'getp and2.0.in0\\nexit\\ngetp and2.0.in1\\n' | r halcmd -f
"""

TWO_PASS_INI = """[HAL]
TWOPASS = on
HALFILE = one.hal
HALFILE = two.hal
[S]
VALUE = 1
"""
TWO_PASS_FILES = {
    'one.hal': 'loadrt threads name1=servo period1=1000000\nloadrt and2 names=aa\nloadrt or2 count=2\n'
               'loadrt logic names=l1 personality=0x102\naddf aa servo\nnet s1 aa.out => or2.0.in0\n'
               'setp aa.in0 1\nshow pin aa\nloadusr -w echo from a program\n',
    'two.hal': 'loadrt and2 names=bb,cc\nloadrt or2 count=1\naddf bb servo\naddf or2.2 servo\n'
               'setp bb.in0 [S]VALUE\nloadrt logic names=l2 personality=0x104\nlist pin\nshow thread\nsave netla\n',
}

TCL = """loadrt threads name1=servo period1=1000000
loadrt and2 count=2
loadrt siggen
puts "[llength [list 1 2]] [llength [hal list pin and2*]] [getp and2.0.in0]"
setp siggen.0.amplitude 6.28/2*3
setp siggen.0.frequency "1 + 2"
setp and2.1.in0 2>1
newsig f float
sets f 3*2
puts "[getp siggen.0.amplitude] [getp siggen.0.frequency] [getp and2.1.in0] [hal gets f] [stype f] [ptype and2.0.in0]"
net a and2.0.out => and2.1.in1
for {set i 0} {$i < 2} {incr i} { addf and2.$i servo }
puts "[catch {setp nosuch 1}] [catch {bogus 1}] [catch {hal bogus}] [catch {net}]"
puts "$::S(NUMBER) [lindex $::S(VALUE) 0] [llength $::S(PIN)]"
puts "[status lock]"
"""

NAMES = ['and2.0.in0', 'and2.0.in1', 'and2.0.out', 'and2.1.in0', 'and2.1.out', 'and2.2.in1', 'left.in0', 'left.out',
         'right.one.in1', 'siggen.0.sine', 'siggen.0.offset', 'siggen.1.amplitude', 'siggen.1.cosine',
         'conv-float-s32.0.in', 'conv-float-s32.0.out', 'conv-u32-bit.0.in', 'conv-s32-u32.0.in', 'conv-s32-u32.0.out',
         'edge.0.in', 'edge.1.out', 'edge.1.both', 'nosuch.pin', 'second']
SIGNALS = ['sa', 'sb', 'sc', 'sd', 'nosig']
PARAMS = ['and2.0.tmax', 'siggen.0.update.tmax', 'fast.tmax', 'and2.0.tmax-increased', 'edge.0.tmax']
FUNCTS = ['and2.0', 'and2.1', 'and2.2', 'left', 'right.one', 'siggen.0.update', 'edge.0', 'nofunct']
VALUES = ['0', '1', 'TRUE', 'false', '3', '2.5', '1e3', '0x20', '77', 'abc']
GLOBS = ['*', 'and2*', 'and2', '*.in?', 's*', '*out', 'left', '[ms]*.0.*']


def random_line(rng):
    name, signal, param = rng.choice(NAMES), rng.choice(SIGNALS), rng.choice(PARAMS)
    funct, value, glob = rng.choice(FUNCTS), rng.choice(VALUES), rng.choice(GLOBS)
    arrow = rng.choice(['', '=> ', '<= ', '<=> '])
    kind = rng.choice(['bit', 'float', 's32', 'u32'])
    thread = rng.choice(['fast', 'slow', 'slow', 'nothread'])
    return rng.choice([
        # One pin per line, because a net line that fails changes nothing here, but in LinuxCNC leaves its first pins
        # linked.
        f'net {signal} {arrow}{name}', f'net {signal} {arrow}{name}', f'net {signal} {name}', f'net {signal} {name}',
        f'newsig {signal} {kind}', f'delsig {signal}', f'unlinkp {name}', f'linkps {name} {arrow}{signal}',
        f'linksp {signal} {arrow}{name}', f'setp {name} {value}', f'setp {param} {value}', f'sets {signal} {value}',
        f'{name} = {value}', f'getp {name}', f'getp {param}', f'gets {signal}', f'ptype {name}', f'stype {signal}',
        f'addf {funct} {thread} {rng.choice(["", "1", "2", "-1", "-2", "9"])}', f'delf {funct} {thread}',
        f'alias pin {name} second', f'unalias pin {name}', 'unalias pin second', f'show pin {glob}', f'show sig {glob}',
        f'list pin {glob}', f'list sig {glob}', f'show funct {glob}', f'list funct {glob}', 'save netla',
        f'show pin -t{kind} {glob}', f'show thread {thread}',
    ])


# Intended differences: (pattern for a line of LinuxCNC or ours). The reasons are in
# docs/reference/compatibility.md.
DIFFERENCES = [
    r'used/total shared memory:',
    r'active/recycled ',
]


# Commands that LinuxCNC accepts silently and Millwright rejects.
REFUSED_BY_US = [
    r'^delsig ', r'^(un)?lock (bogus|none|x)', r'^unalias (bogus|x)', r'^list \w+ -tbogus', r'^loadusr nosuchprogram', r'^loadusr$', r'^unloadusr nosuch', r'^debug x', r'^help nosuch',
    r'^setp \S+ (nan|inf|1e400|99999999999|4294967296|2147483648|4000000000|-\d+)$',
]


def normalised(text, script):
    lines = []
    for line in text.splitlines():
        line = re.sub(r'\bhalcmd\d+\s', '', line)
        if re.match(r'^ *\d+ +User +\d+ ready$', line) or any(re.search(d, line) for d in DIFFERENCES):
            continue
        # Ids of components, addresses.
        line = re.sub(r'^ *\d+  ', ' ID  ', line)
        line = re.sub(r'\b[0-9a-f]{10,12}\b', 'ADDRESS', line)
        line = re.sub(r'ADDRESS (YES|NO) ', 'ADDRESS FP ', re.sub(r'\s+', ' ', line).rstrip())
        # A pin that version 2.9 lacks.
        if line.endswith('.threadbeat'):
            continue
        line = re.sub(r'\w+\.threadbeat ', '', line + ' ').rstrip()
        lines.append(line)
    return lines


def marked(text):
    """The commands, each followed by a print of its line number, and the assignment of lines."""
    lines, isContinued = [], False
    for number, line in enumerate(text.splitlines(), 1):
        lines.append(line)
        isContinued = line.endswith('\\')
        if not isContinued:
            lines.append(f'print @{number}')
    return '\n'.join(lines) + '\n'


def failures(stderr):
    """The messages before each mark: line number -> texts; warnings do not count."""
    found, pending = {}, []
    for line in stderr.splitlines():
        m = re.search(r'HALCMD MSG: @(\d+)', line)
        if m:
            if pending:
                found[int(m.group(1))] = pending
            pending = []
        elif not re.search(r'[Ww]arning|^Note: |HALCMD MSG|<echo>|deprecated', line) and line.strip():
            pending.append(line)
    return found


class Side:
    def __init__(self, name, path, user):
        self.name, self.path, self.user = name, path, user

    def run(self, folder, options, timeout=20):
        environment = {'PATH': f'{self.path}:/usr/bin:/bin:/usr/sbin:/sbin', 'HOME': str(folder), 'LC_ALL': 'C',
                       'MY_PIN': 'and2.0.in0', 'MY_NUMBER': '0', 'MILLWRIGHT_INSTANCE': 'compare'}
        command = [f'{self.path}/halrun', *options]
        if self.user:
            # A separate name space, because LinuxCNC has one shared memory for the machine.
            command = ['unshare', '--ipc', '--pid', '--fork', '--mount-proc', '--kill-child', 'runuser', '-u', self.user, '--', 'env', f'HOME={folder}', *command]
        done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, errors='replace', timeout=timeout)
        return done.returncode, done.stdout, done.stderr


def compare(name, text, sides, options, verbose, arguments=('-i', 'case.ini', '-f', 'case.hal')):
    results = []
    for side in sides:
        # Not tested: loadusr of a program that does not exist (LinuxCNC's child process continues with the HAL file).
        with tempfile.TemporaryDirectory(prefix='compare-') as work:
            folder = pathlib.Path(work)
            os.chmod(folder, 0o777)
            (folder / 'case.hal').write_text(marked(text))
            (folder / 'sourced.hal').write_text('newsig from-source bit\n')
            (folder / 'case.ini').write_text('[S]\nPIN = and2.0.in0\nNUMBER = 0\nCOMMAND = getp and2.0.in0\n'
                                             'MODULE = not names=n1,n2\nVALUE = 4.5\n')
            try:
                for file, lines in (*TWO_PASS_FILES.items(), ('two.ini', TWO_PASS_INI), ('case.tcl', TCL),
                                    ('cmds.sh', SHELL)):
                    (folder / file).write_text(lines)
                results.append(side.run(folder, [*options, *arguments]))
            except subprocess.TimeoutExpired:
                print(f'differs {name} {" ".join(options)}: {side.name} does not end')
                return False
    (status, out, err), (our_status, our_out, our_err) = results
    script = '-s' in options
    problems = []
    if status != our_status:
        problems.append(f'status {status}, ours {our_status}')
    theirs, ours = failures(err), failures(our_err)
    for number in sorted(theirs.keys() ^ ours.keys()):
        who = 'only LinuxCNC' if number in theirs else 'only ours'
        line = text.splitlines()[number - 1]
        if not any(re.search(d, line) for d in REFUSED_BY_US if number in ours):
            problems.append(f'{who} rejects: {line}\n    ' + '\n    '.join(theirs.get(number, []) + ours.get(number, [])))
    diff = list(difflib.unified_diff(normalised(out, script), normalised(our_out, script), 'reference', 'ours',
                                     lineterm='', n=1))
    if diff:
        problems.append('\n'.join(diff[:60 if verbose else 15]))
    print(f'{"differs" if problems else "same   "} {name} {" ".join(options)}')
    for problem in problems:
        print('  ' + problem.replace('\n', '\n  '))
    return not problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--reference', default='/usr/bin', help='folder of LinuxCNC\'s programs')
    parser.add_argument('--bin', default=str(ROOT / 'build/dev/bin'), help='folder of our programs')
    parser.add_argument('--user', default='nobody', help='user for LinuxCNC when run by root')
    parser.add_argument('--seeds', type=int, default=20, help='how many random sequences')
    parser.add_argument('--first-seed', type=int, default=1)
    parser.add_argument('--lines', type=int, default=60, help='commands in a random sequence')
    parser.add_argument('--only', default='', help='only fixed sequences with this in their name')
    parser.add_argument('--verbose', action='store_true')
    o = parser.parse_args()
    if not shutil.which('halrun', path=o.reference):
        sys.exit('compare: no reference: halrun is not in ' + o.reference)
    user = o.user if os.geteuid() == 0 else None
    sides = [Side('reference', o.reference, user), Side('ours', o.bin, None)]
    same = total = 0
    for name, text in FIXED.items():
        if o.only in name:
            for options in (['-k'], ['-k', '-s'], []):
                total += 1
                same += compare(name, SETUP + text, sides, options, o.verbose)
    for name, text, arguments in (('shell', SETUP + 'loadusr -w sh cmds.sh\n', ('-i', 'case.ini', '-f', 'case.hal')),
                                  ('two passes', '', ('two.ini',)), ('Tcl', '', ('-i', 'case.ini', 'case.tcl'))):
        if o.only in name:
            total += 1
            same += compare(name, text, sides, [], o.verbose, arguments)
    for seed in range(o.first_seed, o.first_seed + (0 if o.only else o.seeds)):
        rng = random.Random(seed)
        text = SETUP + '\n'.join(random_line(rng) for _ in range(o.lines)) + '\n' + DUMP
        total += 1
        same += compare(f'seed {seed}', text, sides, ['-k', '-s'] if seed % 2 else ['-k'], o.verbose)
    print(f'{same} of {total} the same')
    return 0 if same == total else 1


if __name__ == '__main__':
    sys.exit(main())
