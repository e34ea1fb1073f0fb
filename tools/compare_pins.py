#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Compares the pins and parameters of motion and of the INI settings with those of an installed LinuxCNC, as black boxes.

usage: compare_pins.py [--bin DIR] [--timeout S]

Both start a configuration of three joints, with a display that only lists HAL. A pin of LinuxCNC that ours lacks, or has with
another type or direction, must have a reason in REASONS below. An underscore and a hyphen are equal, as in our HAL. If run as
root, LinuxCNC runs as nobody in separate namespaces.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = r"(motion|joint|axis|spindle|ini)[.-]"
# (pattern of the whole name, reason why ours lacks it or differs)
REASONS = [
    (r"motion\.debug-(bit|float|s32)-\d", "values for those who write the reference's motion"),
]
HAL = """loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net a joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net b joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net c joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net e iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
"""
INI = """[EMC]
VERSION = 1.1
MACHINE = pins
[DISPLAY]
DISPLAY = {folder}/list
[TASK]
TASK = milltask
CYCLE_TIME = 0.005
[RS274NGC]
PARAMETER_FILE = {folder}/pins.var
[EMCMOT]
EMCMOT = motmod
SERVO_PERIOD = 1000000
[HAL]
HALFILE = pins.hal
[TRAJ]
COORDINATES = XYZ
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = 100
[EMCIO]
EMCIO = io
TOOL_TABLE = tool.tbl
[KINS]
KINEMATICS = trivkins
JOINTS = 3
"""
SECTION = """MAX_VELOCITY = 50
MAX_ACCELERATION = 500
MIN_LIMIT = -100
MAX_LIMIT = 100
"""


def configuration(folder):
    text = INI.format(folder=folder)
    for number, letter in enumerate("XYZ"):
        text += f"[AXIS_{letter}]\n{SECTION}[JOINT_{number}]\nTYPE = LINEAR\n{SECTION}"
    (folder / "pins.ini").write_text(text)
    (folder / "pins.hal").write_text(HAL)
    (folder / "tool.tbl").write_text("T1 P1 D0.1\n")
    lister = folder / "list"
    lister.write_text("#!/bin/sh\n# The pins of the settings come last.\n"
                      "for n in $(seq 100); do halcmd getp ini.traj_max_velocity > /dev/null 2>&1 && break; sleep 0.1; done\n"
                      f"halcmd show pin > {folder}/pin.txt\nhalcmd show param > {folder}/param.txt\n")
    lister.chmod(0o755)
    folder.chmod(0o777)


def listed(folder, kind):
    """{name: (type, direction)} of `halcmd show`; links are left out."""
    rows = {}
    path = folder / f"{kind}.txt"
    for line in path.read_text().splitlines() if path.is_file() else []:
        row = re.match(r"\s*\d+\s+(bit|float|s32|u32|s64|u64|port)\s+(IN|OUT|I/O|RO|RW)\s+\S+\s+(\S+)", line)
        if row:
            rows[row[3].replace("_", "-")] = (row[1], row[2])
    return rows


def bring_up(words, folder, environment, timeout):
    done = subprocess.run(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout, check=False)
    pins = listed(folder, "pin")
    if not pins:
        sys.exit(f"{' '.join(words)} has listed no pins:\n{done.stdout[-2000:]}")
    return pins | listed(folder, "param")


def of_reference(options, folder):
    configuration(folder)
    words = ["/usr/bin/linuxcnc", str(folder / "pins.ini")]
    if os.geteuid() == 0:
        inner = f"ip link set lo up; mount -t tmpfs none /dev/shm; exec setpriv --reuid=65534 --regid=65534 --clear-groups {' '.join(words)}"
        words = ["unshare", "--ipc", "--net", "--mount", "--pid", "--fork", "--mount-proc", "--kill-child", "bash", "-c", inner]
    environment = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "HOME": str(folder)}
    return bring_up(words, folder, environment, options.timeout)


def of_ours(options, folder):
    configuration(folder)
    environment = dict(os.environ, PATH=f"{options.bin}:{os.environ['PATH']}", HOME=str(folder))
    return bring_up([f"{options.bin}/millwright", "start", str(folder / "pins.ini")], folder, environment, options.timeout)


def reason_for(name):
    return next((why for pattern, why in REASONS if re.fullmatch(pattern, name)), None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", default=str(ROOT / "build/release/bin"))
    parser.add_argument("--timeout", type=float, default=60)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as theirs, tempfile.TemporaryDirectory() as mine:
        reference = of_reference(options, pathlib.Path(theirs))
        ours = of_ours(options, pathlib.Path(mine))
    wanted = {name: what for name, what in reference.items() if re.match(PARTS, name)}
    failures, excused = [], []
    for name, what in sorted(wanted.items()):
        if ours.get(name) == what:
            continue
        found = f"ours {ours[name][0]} {ours[name][1]}" if name in ours else "ours has none"
        line = f"{name}: {what[0]} {what[1]}, {found}"
        why = reason_for(name)
        (failures if why is None else excused).append(line if why is None else f"{line}: {why}")
    more = sorted(name for name in ours if re.match(PARTS, name) and name not in wanted)
    print("\n".join(excused))
    print("only ours:", " ".join(more))
    print("\n".join(f"FAILED {line}" for line in failures))
    print(f"{len(wanted)} pins and parameters of the reference: {len(wanted) - len(failures) - len(excused)} the same, "
          f"{len(excused)} with a reason, {len(failures)} missing or other")
    return 1 if failures or len(wanted) < 250 else 0


if __name__ == "__main__":
    sys.exit(main())
