#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures the functions of motion in the servo thread, with those of an installed LinuxCNC for comparison.

Three or more joints run the same program of arcs and short lines in real time. In every servo cycle the component sampler reads
motion-controller.time and motion-command-handler.time. Runs alternate; the first second of each is omitted. Prints median, 99th
and 99.9th percentile and maximum of their sum [ns]; LinuxCNC counts ticks of the time stamp counter, which are converted with
/proc/cpuinfo. If the speed of the host changes between runs, --together runs both at the same time with their threads on the same
processor, so that their cycles alternate. Then read the ratios of pairs.
usage: script/bench servo, or after it bench/servo.py [--joints 3] [--runs 5] [--cycles 200000] [--period 200000] [--together]
"""
import argparse
import concurrent.futures
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
try:
    import numpy as np
except ImportError:
    sys.exit("servo: python3-numpy is missing; script/bootstrap installs it")
import compare_traj
import servo_instructions

LIMITS = {"max_velocity": [200] * 9, "max_acceleration": [1000] * 9, "max_jerk": [50000] * 9}

TIMES = """net controller-time motion-controller.time => sampler.0.pin.0
net handler-time motion-command-handler.time => sampler.0.pin.1
"""


def prepare(folder, options):
    folder.mkdir()
    seconds = options.cycles * options.period * 1e-9 + 3
    letters = servo_instructions.LETTERS[:options.joints]
    (folder / "compare.ini").write_text(compare_traj.ini_text(LIMITS, options.jerk, letters, options.period))
    (folder / "compare.hal").write_text(compare_traj.hal_text("ss", letters, TIMES))
    (folder / "compare.tbl").write_text("")
    (folder / "compare.var").write_text("")
    (folder / "driver.py").write_text(compare_traj.DRIVER.replace("homed[:5]", f"homed[:{options.joints}]"))
    (folder / "driver.py").chmod(0o755)
    (folder / "program.ngc").write_text(servo_instructions.program(letters, seconds))


def run_ours(folder):
    hal = (folder / "compare.hal").read_text()
    (folder / "compare.hal").write_text(hal + "loadusr halsampler samples.txt\n")
    command = [compare_traj.RELEASE / "bin" / "millwright", "run", "--realtime", "--yes", "compare.ini", "program.ngc"]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stdout[-800:])
    return done.stdout


def ticks_per_ns():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("cpu MHz"):
            return float(line.split(":")[1]) * 1e-3
    return 1.0


def figures(folder, log, options, unit):
    table = compare_traj.read_samples(folder, log, 2)
    first = round(1e9 / options.period)
    total = np.sum(table, axis=1)[first:first + options.cycles] * unit
    if len(total) < options.cycles:
        raise ValueError(f"{len(total)} cycles instead of {options.cycles}")
    return *np.percentile(total, (50, 99, 99.9)), np.max(total)


def one_run(folder, options, isOurs):
    """Median, 99th and 99.9th percentile and maximum of one run [ns]."""
    if isOurs:
        prepare(folder, options)
        return figures(folder, run_ours(folder), options, 1.0)
    prepare(folder, argparse.Namespace(**{**vars(options), "jerk": False}))
    return figures(folder, compare_traj.run_reference(folder), options, 1.0 / ticks_per_ns())


def runs(work, options, has_reference):
    """Figures of Millwright and LinuxCNC for each pair, alternately or at the same time."""
    with concurrent.futures.ThreadPoolExecutor(2 if options.together else 1) as pool:
        for run in range(options.runs):
            ours = pool.submit(one_run, work / f"ours-{run}", options, True)
            theirs = pool.submit(one_run, work / f"reference-{run}", options, False) if has_reference else None
            yield ours.result(), theirs.result() if theirs else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--joints", type=int, choices=range(3, 10), default=3)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--cycles", type=int, default=200000)
    parser.add_argument("--period", type=int, default=200000, help="servo period [ns]")
    parser.add_argument("--jerk", action="store_true", help="ours with jerk limits")
    parser.add_argument("--together", action="store_true", help="both of a pair at the same time")
    options = parser.parse_args()
    has_reference = shutil.which("linuxcnc") is not None
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        work.chmod(0o755)
        for mine, other in runs(work, options, has_reference):
            for who, row, all_rows in (("ours", mine, ours), ("reference", other, theirs)):
                if row:
                    all_rows.append(row)
                    print("{:10} median {:7.0f}  99 % {:7.0f}  99.9 % {:7.0f}  worst {:9.0f} ns".format(who, *row), flush=True)
    mine = np.median(np.array(ours), axis=0)
    print("\nmedian of the runs: ours {:.0f}, {:.0f}, {:.0f}; worst of all {:.0f} ns".format(*mine[:3], np.max(np.array(ours)[:, 3])))
    if not theirs:
        return 0
    other = np.median(np.array(theirs), axis=0)
    print("reference {:.0f}, {:.0f}, {:.0f}; worst of all {:.0f} ns\nratio: median {:.2f}, 99 % {:.2f}, 99.9 % {:.2f}".format(
        *other[:3], np.max(np.array(theirs)[:, 3]), *(mine[:3] / other[:3])))
    pairs = np.array(ours)[:, 0] / np.array(theirs)[:, 0]
    print("medians of each pair: {}; median of these ratios {:.2f}".format(" ".join(f"{r:.2f}" for r in pairs), np.median(pairs)))
    return 0 if mine[0] <= other[0] and mine[1] <= other[1] else 1


if __name__ == "__main__":
    sys.exit(main())
