#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Each sample machine with a Mesa board passes doctor, homes to its switches and cuts, in virtual time.
usage: mesa_samples.py MILLWRIGHT SOURCE_FOLDER"""
import pathlib
import subprocess
import sys
import tempfile

millwright, source = sys.argv[1:3]
PROGRAM = 'G21 G90 G64 P0.01\nF1200\nG0 X20 Y15 Z-1\nG1 X30 Y10\nG1 X5 Y25 Z-5\nG2 X5 Y5 J-10\nM2\n'
failed = []
with tempfile.TemporaryDirectory() as name:
    program = pathlib.Path(name) / 'part.ngc'
    program.write_text(PROGRAM)
    samples = sorted((pathlib.Path(source) / 'configs/mesa').glob('*.ini'))
    for sample in samples:
        doctor = subprocess.run([millwright, 'doctor', str(sample), '--latency', '0', '--no-system'], capture_output=True, text=True, timeout=120)
        findings = [line for line in doctor.stdout.splitlines()]
        if doctor.returncode != 0 or findings:
            failed.append(f'{sample.name}: {findings}')
            continue
        run = subprocess.run([millwright, 'run', str(sample), str(program)], capture_output=True, text=True, timeout=120)
        if run.returncode != 0 or 'blocks              7' not in run.stdout:
            failed.append(f'{sample.name}: {run.stdout[-500:]}{run.stderr[-500:]}')
if not samples:
    failed.append('there are no samples')
print('\n'.join(failed) or f'{len(samples)} samples: ok')
sys.exit(1 if failed else 0)
