#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests HAL files in two passes and in Tcl, on a simulated machine.

usage: hal_files.py MILLWRIGHT SOURCE_FOLDER [tcl]    tcl: the Tcl part was built
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = 'G21 G90 G0 X10 Y5\nG1 X20 F600\nM2\n'
FILES = {
    # A module that core_sim.hal also loads: only two passes can merge the lines.
    'more.hal': 'loadrt ddt names=extra\naddf extra servo-thread\nnet extra-in joint.0.pos-fb => extra.in\n',
    'twice.hal': 'loadrt ddt names=extra\n',
    'wrong.hal': 'loadrt ddt names=more\nnet nothing more.oot\n',
    'script.tcl': 'loadrt near names=n0,n1,n2\n'
                  'for {set i 0} {$i < $::KINS(JOINTS)} {incr i} {\n'
                  '    addf n$i servo-thread\n'
                  '    net from-tcl-$i n$i.out\n'
                  '    setp n$i.difference [lindex $argv 0]*2\n'
                  '}\n'
                  'if {[hal --pass] == 0} { return }\n'
                  'if {[getp n2.difference] != 6} { error "difference is [getp n2.difference]" }\n'
                  'puts "script has run"\n',
    'program.hal': 'loadrt sampler depth=100 cfg=f\nsetp sampler.0.enable 0\nloadusr halsampler samples.txt\n',
    'broken.tcl': 'set x 1\nsetp joint.0.nosuch 1\n',
}


def main():
    millwright, source = sys.argv[1:3]
    has_tcl = 'tcl' in sys.argv[3:]
    failures = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        shutil.copytree(pathlib.Path(source) / 'configs', folder / 'configs', ignore=shutil.ignore_patterns('*.var', '*.journal*'))
        machine = folder / 'configs/sim'
        for name, text in FILES.items():
            (machine / name).write_text(text)
        (machine / 'part.ngc').write_text(PROGRAM)
        plain = (machine / 'mill_mm.ini').read_text()

        def run(what, hal_lines, status, texts, two_pass='', mode=()):
            ini = machine / 'case.ini'
            ini.write_text(plain.replace('[HAL]\n', '[HAL]\n' + two_pass).replace(
                'HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\n' + hal_lines))
            # Waits for the end of its output, which a remaining loadusr program would keep open.
            done = subprocess.run([millwright, 'run', str(ini), str(machine / 'part.ngc'), *mode], capture_output=True,
                                  env=dict(os.environ, MILLWRIGHT_INSTANCE=f'hal-files-{os.getpid()}'), cwd=folder,
                                  text=True, check=False, timeout=60)
            said = done.stdout + done.stderr
            missing = [text for text in texts if text not in said]
            if (done.returncode == 0) != (status == 0) or missing:
                failures.append(f'{what}: status {done.returncode}, missing {missing}:\n{said}')

        run('two passes merge', 'HALFILE = more.hal\n', 0, ['cycle time'], 'TWOPASS = on\n')
        run('one pass cannot', 'HALFILE = more.hal\n', 1, ['more.hal:1:8', 'loaded already'])
        run('a name twice', 'HALFILE = more.hal\nHALFILE = twice.hal\n', 1,
            ['twice.hal:1:12', "has the name 'extra' twice", 'more.hal:1:12'], 'TWOPASS = on\n')
        run('an error in the second pass', 'HALFILE = wrong.hal\n', 1,
            ['wrong.hal:2:13', "did you mean 'more.out'?"], 'TWOPASS = on\n')
        run('programs end with the machine', 'HALFILE = program.hal\n', 0, ['cycle time'], mode=['--realtime', '--yes'])
        if has_tcl:
            run('Tcl', 'HALFILE = script.tcl 3\n', 0, ['script has run', 'cycle time'], 'TWOPASS = on\n')
            run('an error in Tcl', 'HALFILE = broken.tcl\n', 1, ['broken.tcl:2', "'joint.0.nosuch' does not exist"])
    for failure in failures:
        print('FAILED', failure)
    print(f'{7 if has_tcl else 5} cases, {len(failures)} failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
