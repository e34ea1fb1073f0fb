#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares our trajectories with those of an installed LinuxCNC with the same G-code, limits and P.

The twelve types of programs of bench/traj run on both complete systems: ours with `millwright run --trace` in virtual time,
LinuxCNC without a screen in real time, with its `sampler` recording its joint positions in every servo cycle (as an ordinary user
in separate namespaces). tools/trajcheck.py judges both. Run it on an idle computer, because LinuxCNC's task feeds its planner in
real time. usage: script/compare traj [--only WORD] [--repeat N] [--keep FOLDER]
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    sys.exit("compare traj: python3-numpy is missing; script/bootstrap installs it")
import trajcheck

ROOT = pathlib.Path(__file__).resolve().parent.parent
RELEASE = ROOT / "build" / "release"
LETTERS = "XYZAB"
REST_SAMPLES = 200  # a standstill of this many cycles separates the approach from the program
PRINTED = 1e-6  # halsampler prints six decimals

# A machine of `letters` whose motors follow at once; `lines` are added after the motion functions.
def hal_text(sampler_cfg, letters, lines=""):
    return f"""loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
loadrt sampler depth=100000 cfg={sampler_cfg}
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net tool-prep-loop iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net tool-change-loop iocontrol.0.tool-change => iocontrol.0.tool-changed
""" + "".join(f"net joint-{i} joint.{i}.motor-pos-cmd => joint.{i}.motor-pos-fb\n" for i in range(len(letters))) + lines


HAL = hal_text("f" * len(LETTERS), LETTERS, "".join(f"net joint-{i} sampler.0.pin.{i}\n" for i in range(len(LETTERS))))

# LinuxCNC's screen: homes, runs the program, and samples at the same time.
DRIVER = """#!/usr/bin/python3
import subprocess, sys, time
import linuxcnc
command, status = linuxcnc.command(), linuxcnc.stat()
def wait(what, seconds=20.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        status.poll()
        if what():
            return
        time.sleep(0.01)
    sys.exit("timeout")
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: status.task_state == linuxcnc.STATE_ESTOP_RESET)
command.state(linuxcnc.STATE_ON)
wait(lambda: status.task_state == linuxcnc.STATE_ON)
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
command.home(-1)
wait(lambda: all(status.homed[:5]))
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open("program.ngc")
command.wait_complete()
with open("samples.txt", "w") as file:
    sampler = subprocess.Popen(["halsampler"], stdout=file)
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait(lambda: status.interp_state != linuxcnc.INTERP_IDLE)
    wait(lambda: status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.queue == 0, 120.0)
    time.sleep(0.3)
    sampler.terminate()
    sampler.wait()
"""


def ini_text(geometry, with_jerk, letters=LETTERS, period_ns=1000000):
    def axis(name, i, number_of_limits):
        lines = [f"[{name}]"] + ([f"TYPE = {'ANGULAR' if letters[i] in 'ABC' else 'LINEAR'}", "HOME = 0",
                                  "HOME_OFFSET = 0", "HOME_SEARCH_VEL = 0", "HOME_LATCH_VEL = 0", "HOME_SEQUENCE = 0",
                                  "FERROR = 100", "MIN_FERROR = 100"] if number_of_limits else [])
        at = "XYZABCUVW".index(letters[i])
        lines += [f"MAX_VELOCITY = {geometry['max_velocity'][at]:g}",
                  f"MAX_ACCELERATION = {geometry['max_acceleration'][at]:g}", "MIN_LIMIT = -9999", "MAX_LIMIT = 9999"]
        if with_jerk:
            lines.append(f"MAX_JERK = {geometry['max_jerk'][at]:g}")
        return "\n".join(lines) + "\n"

    wide = 2 * max(geometry["max_velocity"][:3]), 2 * max(geometry["max_acceleration"][:3])
    planner = f"PLANNER_TYPE = 1\nMAX_LINEAR_JERK = {2 * max(geometry['max_jerk'][:3]):g}\n" if with_jerk else ""
    text = f"""[EMC]
VERSION = 1.1
MACHINE = compare
[DISPLAY]
DISPLAY = ./driver.py
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = compare.var
[EMCMOT]
EMCMOT = motmod
SERVO_PERIOD = {period_ns}
BASE_PERIOD = 0
COMM_TIMEOUT = 1.0
[EMCIO]
TOOL_TABLE = compare.tbl
EMCIO = io
CYCLE_TIME = 0.1
[HAL]
HALFILE = compare.hal
[TRAJ]
COORDINATES = {' '.join(letters)}
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 50
MAX_LINEAR_VELOCITY = {wide[0]:g}
MAX_LINEAR_ACCELERATION = {wide[1]:g}
{planner}[KINS]
KINEMATICS = trivkins coordinates={letters}
JOINTS = {len(letters)}
"""
    for i, letter in enumerate(letters):
        text += axis(f"AXIS_{letter}", i, False) + axis(f"JOINT_{i}", i, True)
    return text


def prepare(folder, program, geometry, with_jerk):
    folder.mkdir()
    (folder / "compare.ini").write_text(ini_text(geometry, with_jerk))
    (folder / "compare.hal").write_text(HAL)
    (folder / "compare.tbl").write_text("")
    (folder / "compare.var").write_text("")
    (folder / "driver.py").write_text(DRIVER)
    (folder / "driver.py").chmod(0o755)
    shutil.copy(program, folder / "program.ngc")


def from_start(rows, geometry):
    """The rows of the program itself: those after the last long rest at its start."""
    start = np.array(geometry["start"], float)
    moving = np.flatnonzero(np.any(np.abs(np.diff(rows, axis=0)) > 0, axis=1))
    if len(moving) == 0:
        raise ValueError("nothing moved")
    first = moving[0]
    for gap in np.flatnonzero(np.diff(moving) > REST_SAMPLES):
        if np.max(np.abs(rows[moving[gap + 1]] - start)) <= 2 * PRINTED:
            first = moving[gap + 1]
    return rows[max(0, first - 3):moving[-1] + 2]


def ours(folder):
    done = subprocess.run([RELEASE / "bin" / "millwright", "run", "compare.ini", "program.ngc", "--trace", "trace.csv"],
                          cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(f"millwright run: {done.stdout[-500:]}")
    return folder / "trace.csv"


def read_ours(path, geometry):
    with open(path, encoding="ascii") as file:
        names = file.readline().lstrip("# ").strip().split(",")
    table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    rows = np.zeros((len(table), 9))
    for i, letter in enumerate("xyzabcuvw"):
        if f"axis.{letter}" in names:
            rows[:, i] = table[:, names.index(f"axis.{letter}")]
    return from_start(rows, geometry)


def run_reference(folder):
    """Starts LinuxCNC on compare.ini, as an ordinary user, until its driver ends; returns its output."""
    folder.chmod(0o777)
    command = ["linuxcnc", "compare.ini"]
    if os.geteuid() == 0:
        subprocess.run(["chown", "-R", "65534:65534", str(folder)], check=True)
        command = ["unshare", "--ipc", "--pid", "--fork", "--mount-proc", "setpriv", "--reuid=65534", "--regid=65534",
                   "--clear-groups", *command]
    log = folder / "log.txt"
    with open(log, "w", encoding="utf-8") as file:
        subprocess.run(["timeout", "180", *command], cwd=folder, env={**os.environ, "HOME": str(folder), "DISPLAY": ""},
                       stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, check=False)
    return log.read_text(encoding="utf-8", errors="replace")


def read_samples(folder, log, columns):
    """The rows that halsampler wrote; a line that the end of the run has truncated is omitted."""
    samples = folder / "samples.txt"
    if not samples.exists() or samples.stat().st_size == 0:
        raise ValueError("no samples: " + log[-800:])
    lines = samples.read_text().splitlines()
    if "overrun" in lines:
        raise ValueError("the sampler ran over")
    return np.array([[float(word) for word in line.split()] for line in lines[:-1] if len(line.split()) == columns])


def reference(folder, geometry):
    table = read_samples(folder, run_reference(folder), len(LETTERS))
    rows = np.zeros((len(table), 9))
    rows[:, :len(LETTERS)] = table
    return from_start(rows, geometry)


def figures(verdict):
    worst = verdict["worst"]
    deviation = verdict["deviation"]
    return {"time_s": verdict["cycle_time_s"], "v": worst["velocity"][0], "a": worst["acceleration"][0],
            "j": worst.get("jerk", (math.nan,))[0], "deviation": math.inf if deviation is None else deviation,
            "ok": verdict["ok"]}


def compare(stem, programs, work, repeat):
    geometry = trajcheck.read_geometry(programs / f"{stem}.json")
    result = {"kind": geometry["name"], "P": geometry["tolerance"]}
    for name, with_jerk in (("ours", False), ("jerk", True)):
        folder = work / f"{stem}-{name}"
        prepare(folder, programs / f"{stem}.ngc", geometry, with_jerk)
        rows = read_ours(ours(folder), geometry)
        result[name] = figures(trajcheck.judge(geometry, 0.001, rows, rounding=1e-7, with_jerk=with_jerk))
    for attempt in range(repeat):
        folder = work / f"{stem}-reference-{attempt}"
        prepare(folder, programs / f"{stem}.ngc", geometry, False)
        found = figures(trajcheck.judge(geometry, 0.001, reference(folder, geometry), rounding=PRINTED))
        if "reference" not in result or found["time_s"] < result["reference"]["time_s"]:
            result["reference"] = found
    return result


def row_text(result):
    ref, mine, jerk = result["reference"], result["ours"], result["jerk"]
    return (f"| {result['kind']} | {ref['time_s']:.3f} | {ref['v']:.2f} {ref['a']:.2f} | {ref['deviation']:.4f} | "
            f"{mine['time_s']:.3f} | {mine['v']:.2f} {mine['a']:.2f} | {mine['deviation']:.4f} | "
            f"{ref['time_s'] / mine['time_s']:.3f} | {jerk['time_s']:.3f} {'' if jerk['ok'] else 'OVER LIMIT'} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="kinds whose name has this word")
    parser.add_argument("--repeat", type=int, default=1, help="runs of LinuxCNC; the fastest counts")
    parser.add_argument("--keep", help="folder for everything that was made")
    options = parser.parse_args()
    if shutil.which("linuxcnc") is None:
        sys.exit("compare traj: there is no linuxcnc; apt-get install --no-install-recommends linuxcnc-uspace")
    made = tempfile.TemporaryDirectory()
    work = pathlib.Path(options.keep or made.name)
    work.mkdir(exist_ok=True)
    work.chmod(0o755)
    programs = work / "programs"
    programs.mkdir(exist_ok=True)
    subprocess.run([RELEASE / "bench" / "traj_programs", programs], check=True)
    print("| kind | reference [s] | its v a over limit | its deviation | ours [s] | v a over limit | deviation | ratio |"
          " ours, jerk-limited [s] |\n|---|---|---|---|---|---|---|---|---|")
    results, failed = [], 0
    for path in sorted(programs.glob("*.json")):
        if options.only.replace(" ", "_") not in path.stem:
            continue
        try:
            results.append(compare(path.stem, programs, work, options.repeat))
            print(row_text(results[-1]), flush=True)
        except ValueError as error:
            failed += 1
            print(f"{path.stem}: {error}", file=sys.stderr)
    (work / "results.json").write_text(json.dumps(results, indent=1))
    bad = [r["kind"] for r in results if not r["ours"]["ok"] or not r["jerk"]["ok"]]
    slower = [r["kind"] for r in results if r["ours"]["time_s"] > r["reference"]["time_s"] + 0.0015]
    print(f"\nours over a limit: {', '.join(bad) or 'none'}; longer than LinuxCNC: {', '.join(slower) or 'none'}")
    return 1 if failed or bad or slower else 0


if __name__ == "__main__":
    sys.exit(main())
