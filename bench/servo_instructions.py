#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Counts the instructions of motion in a servo cycle, with those of an installed LinuxCNC for comparison.

Machines of 3, 6 and 9 joints run the same program of arcs and short lines with valgrind's callgrind, which counts instructions
and does not depend on time. Counts the instructions of the servo thread in motion's functions and in all functions that they
call. For Millwright, in virtual time, a short run is subtracted from a longer one, so that switching on and homing do not count.
For LinuxCNC, the counts are read twice while the program runs.
usage: script/bench servo_instructions, or after it bench/servo_instructions.py [--joints 3,6,9] [--cycles 2000]
"""
import argparse
import collections
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import compare_traj

LETTERS = "XYZABCUVW"
LIMITS = {"max_velocity": [200] * 9, "max_acceleration": [1000] * 9, "max_jerk": [50000] * 9}
PERIOD_NS = 1000000
REALTIME = pathlib.Path("/usr/bin/rtapi_app")  # of LinuxCNC
MOST = 0.7  # of what LinuxCNC takes
# Functions of Millwright that only the servo thread calls.
OURS = re.compile(r"^\(anonymous namespace\)::(handle_commands|control)\(")

# LinuxCNC's screen: homes, runs the program, and reads the counts twice during the run.
LOOK = """
import os
command.auto(linuxcnc.AUTO_RUN, 0)
wait(lambda: status.interp_state != linuxcnc.INTERP_IDLE)
wait(lambda: status.motion_line > 20 and status.current_vel > 1.0, 120.0)
pid = subprocess.run(["pgrep", "-f", "callgrind.*rtapi_app"], stdout=subprocess.PIPE, text=True).stdout.split()[0]
subprocess.run(["callgrind_control", "-z", pid], check=True)
time.sleep(LOOK_S)
status.poll()
if status.current_vel < 1.0:
    sys.exit("it stands")
subprocess.run(["callgrind_control", "--dump=look", pid], check=True)
command.abort()
time.sleep(0.5)
"""


def program(letters, seconds):
    """Arcs and lines of 0.2 mm at 20 mm/s in all letters, for at least this time."""
    lines, length, x = ["G21 G17 G90 G64 P0.01 F1200"], 0.0, 0.0
    while length < 20.0 * seconds:
        lines += [f"G3 X{x + 4:.4f} Y0 I2 J0", f"G2 X{x + 8:.4f} Y0 I2 J0"]
        x += 8
        length += 4 * math.pi
        for i in range(1, 41):
            words = [f"X{x - i * 0.2:.4f}", f"Y{0.5 * math.sin(i * math.pi / 20):.4f}", f"Z{0.3 * math.sin(i * 0.3):.4f}"]
            words += [f"{letter}{0.2 * math.sin(i * 0.2 + k):.4f}" for k, letter in enumerate(letters[3:])]
            lines.append("G1 " + " ".join(words))
        x -= 8
        lines.append(f"G1 X{x:.4f} Y0 Z0")
        length += 9
    return "\n".join(lines + ["M2", ""])


def prepare(folder, letters, seconds):
    folder.mkdir(parents=True)
    (folder / "compare.ini").write_text(compare_traj.ini_text(LIMITS, False, letters, PERIOD_NS))
    hal = compare_traj.hal_text("s", letters)
    (folder / "compare.hal").write_text("\n".join(line for line in hal.splitlines() if "sampler" not in line) + "\n")
    (folder / "compare.tbl").write_text("")
    (folder / "compare.var").write_text("")
    (folder / "program.ngc").write_text(program(letters, seconds))


def calls_into(text, isCaller, isCallee):
    """Calls and inclusive instructions by callee, for calls from another library into motion."""
    names = {}

    def name(word):
        found = re.match(r"(\(\d+\))(?: (.*))?$", word)
        if found is None:
            return word
        if found.group(2) is not None:
            names[kind + found.group(1)] = found.group(2)
        return names.get(kind + found.group(1), "")

    total = collections.defaultdict(lambda: [0, 0])
    here = callee_object = callee = ""
    lines = iter(text.splitlines())
    for line in lines:
        key, _, value = line.partition("=")
        if key == "ob":
            kind = "ob"
            here = name(value)
        elif key == "cob":
            kind = "ob"
            callee_object = name(value)
        elif key in ("fn", "cfn"):
            kind = "fn"
            called = name(value)
            if key == "fn":
                callee_object = ""
            else:
                callee = called
        elif key == "calls":
            cost = int(next(lines).split()[1])
            into = callee_object or here
            if into.endswith("motmod.so") and here != into and isCaller(here) and isCallee(callee):
                total[callee][0] += int(value.split()[0])
                total[callee][1] += cost
            callee_object = ""
    return total


def valgrind(out):
    return ["valgrind", "--tool=callgrind", "--compress-pos=no", f"--callgrind-out-file={out}"]


def count_run(folder, letters, seconds):
    """Cycles and instructions of a whole run of Millwright."""
    prepare(folder, letters, seconds)
    command = [*valgrind("callgrind.out"), compare_traj.RELEASE / "bench" / "servo_run", "compare.ini", "program.ngc"]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise ValueError(done.stdout[-800:])
    found = calls_into((folder / "callgrind.out").read_text(), lambda _place: True, OURS.search)
    if len(found) != 2:
        raise ValueError(f"functions of the servo thread: {dict(found)}")
    return max(calls for calls, _ in found.values()), sum(cost for _, cost in found.values())


def ours(folder, letters, cycles):
    short = count_run(folder / "short", letters, 1.0)
    longer = count_run(folder / "long", letters, 1.0 + cycles * PERIOD_NS * 1e-9)
    return (longer[1] - short[1]) / (longer[0] - short[0])


def reference(folder, letters, cycles):
    """LinuxCNC's realtime program is started with its full path; callgrind replaces it in a separate mount namespace."""
    prepare(folder, letters, 60.0 + 20 * cycles * PERIOD_NS * 1e-9)
    homed = compare_traj.DRIVER.replace("homed[:5]", f"homed[:{len(letters)}]").split("with open")[0]
    look = LOOK.replace("LOOK_S", f"{3 * cycles * PERIOD_NS * 1e-9:.3f}")
    (folder / "driver.py").write_text(homed.replace("20.0", "120.0") + look)
    shutil.copy(REALTIME, folder / "rtapi_app")
    (folder / "stand_in").write_text("#!/bin/sh\nexec " + " ".join(valgrind(folder / "callgrind.out")) + f' {folder}/rtapi_app "$@"\n')
    for name in ("driver.py", "stand_in", "rtapi_app"):
        (folder / name).chmod(0o755)
    subprocess.run(["chown", "-R", "65534:65534", str(folder)], check=True)
    inner = (f"mount --bind {folder}/stand_in {REALTIME} && exec setpriv --reuid=65534 --regid=65534 --clear-groups "
             "/usr/bin/linuxcnc compare.ini")
    log = folder / "log.txt"
    with open(log, "w", encoding="utf-8") as file:
        subprocess.run(["timeout", "400", "unshare", "--ipc", "--mount", "--pid", "--fork", "--mount-proc", "sh", "-c", inner], cwd=folder,
                       env={**os.environ, "HOME": str(folder), "DISPLAY": "", "PATH": "/usr/bin:/bin"}, stdin=subprocess.DEVNULL,
                       stdout=file, stderr=subprocess.STDOUT, check=False)
    total, cycles_seen = 0, 0
    for path in folder.glob("callgrind.out*"):
        text = path.read_text()
        if "look" in text[:2000]:
            found = calls_into(text, lambda place: place.endswith("hal_lib.so"), lambda _function: True)
            cycles_seen += max((calls for calls, _ in found.values()), default=0)
            total += sum(cost for _, cost in found.values())
    if cycles_seen < 100:
        raise ValueError(f"{cycles_seen} cycles seen: " + log.read_text(errors="replace")[-1500:])
    return total / cycles_seen


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--joints", default="3,6,9")
    parser.add_argument("--cycles", type=int, default=2000)
    parser.add_argument("--keep", help="folder for what is made")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        sys.exit("servo_instructions: valgrind is missing; script/bootstrap --all installs it")
    if os.geteuid() != 0:
        sys.exit("servo_instructions: only root can create the name spaces in which callgrind replaces the realtime programs")
    has_reference = REALTIME.exists()
    made = tempfile.TemporaryDirectory()
    work = pathlib.Path(options.keep or made.name)
    work.mkdir(exist_ok=True)
    work.chmod(0o755)
    print("| joints | ours | LinuxCNC | ratio |\n|---|---|---|---|")
    worst = 0.0
    for joints in [int(word) for word in options.joints.split(",")]:
        letters = LETTERS[:joints]
        mine = ours(work / f"ours-{joints}", letters, options.cycles)
        theirs = reference(work / f"reference-{joints}", letters, options.cycles) if has_reference else math.nan
        worst = max(worst, mine / theirs) if has_reference else worst
        print(f"| {joints} | {mine:.0f} | {theirs:.0f} | {mine / theirs:.2f} |", flush=True)
    return 0 if worst <= MOST else 1


if __name__ == "__main__":
    sys.exit(main())
