#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the simulator configurations of an installed LinuxCNC with `millwright run`, in virtual time, and counts the results.

usage: compare_configs.py [--bin DIR] [--configs DIR] [--hallib DIR] [--only TEXT] [--timeout S] [--out FILE] [--start [--work]]

Each configuration runs in a temporary copy of the whole folder, with a small program for its axes: every axis moves slightly
within its limits. A configuration passes if the program ends with status 0.
With --start it is started by `linuxcnc -r` with a script as the display, which switches the machine on and ends it;
configurations without an [EMC] section are parts of others and are omitted. --work also homes, and runs a line of MDI and the
small program if joints are axes.
Nothing of that installation is started; MILLWRIGHT_HALLIB names its folder of HAL files.
"""
import argparse
import collections
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CONFIGS = "/usr/share/doc/linuxcnc/examples/sample-configs/sim"
HALLIB = "/usr/share/linuxcnc/hallib"
NO_MODULE = r"there is no module '([^']*)\.so'"

# The class of a failure, by the first error that matches.
REASONS = [
    (NO_MODULE, "no module {}"),
    (r"tool (\d+) is in the table twice", "tool twice"),
    (r"not a word of a tool table", "tool table form"),
    (r"section \[(AXIS|JOINT)_\w\] is missing", "missing section"),
    (r"no \$DISPLAY environment variable|cannot open display", "needs a display"),
    (r"RANDOM_TOOLCHANGER", "random tool changer"),
    (r"cannot open|cannot read", "missing file"),
    (r"is not found", "HAL file not found"),
    (r"no progress", "no progress"),
    (r"pin '([^']*)' does not exist|there is no pin '([^']*)'", "no pin {}"),
    (r"there is no", "missing thing"),
    (r"is missing", "missing key"),
]


def merged(ini, depth=0):
    """The lines of an INI file, including the files that it includes."""
    lines = []
    for line in ini.read_text(errors="replace").splitlines():
        include = re.match(r"#INCLUDE\s+(\S+)", line)
        if include and depth < 8 and (ini.parent / include[1]).is_file():
            lines += merged(ini.parent / include[1], depth + 1)
        else:
            lines.append(line)
    return lines


def values_of(ini):
    """{SECTION: {KEY: value}}, first value of each key."""
    sections = collections.defaultdict(dict)
    section = ""
    for line in merged(ini):
        line = line.strip()
        header = re.match(r"\[(\w+)\]", line)
        if header:
            section = header[1]
        elif "=" in line and not line.startswith(("#", ";")):
            key, value = line.split("=", 1)
            sections[section].setdefault(key.strip(), value.split("#")[0].strip())
    return sections


def number(text, otherwise):
    try:
        return float(text)
    except (TypeError, ValueError):
        return otherwise


def program_for(sections):
    """Moves by a twentieth of each axis's travel, at most 2, around its position after homing."""
    traj = sections["TRAJ"]
    letters = [c for c in "XYZABCUVW" if c in re.sub(r"[\s,]", "", traj.get("COORDINATES", "XYZ").upper())]
    inch = traj.get("LINEAR_UNITS", "mm").lower() in ("inch", "in", "imperial", "1.0")
    lines = ["G20" if inch else "G21", "G91 G17 G40 G94", "F%g" % (10 if inch else 200)]
    for letter in letters:
        axis = sections["AXIS_" + letter]
        low, high = number(axis.get("MIN_LIMIT"), -10), number(axis.get("MAX_LIMIT"), 10)
        home = number(axis.get("HOME"), 0.0)
        step = min(2.0, abs(high - low) / 20) * (1 if high - home >= home - low else -1)
        move = "G0" if "LOCKING_INDEXER_JOINT" in axis else "G1"  # a locked axis has no feed
        lines += ["%s %s%.4f" % (move, letter, step), "%s %s%.4f" % (move, letter, -step)]
    return "\n".join(lines + ["G90", "M2", ""])


def reason_of(text, status):
    errors = [line for line in text.splitlines() if not re.search(r"(^| )(note|warning): |^running as simulation", line)]
    for pattern, name in REASONS:
        for line in errors:
            found = re.search(pattern, line)
            if found:
                groups = [group for group in found.groups() if group]
                return name.format(groups[0] if groups else ""), line
    if status == 124:
        return "timeout", ""
    first = next((line for line in errors if "error" in line), errors[0] if errors else "")
    return "other", first


def run(options, ini, folder, place):
    """(class, line of the error); class "" if the program ran to its end."""
    with tempfile.TemporaryDirectory(dir=place) as place:
        # Links, because our programs never write into an existing file.
        copy = pathlib.Path(place) / "sample-configs" / "sim"
        shutil.copytree(folder, copy, symlinks=True, copy_function=os.link)
        mine = copy / ini.relative_to(folder)
        program = pathlib.Path(place) / "small.ngc"
        program.write_text(program_for(values_of(mine)))
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        environment.update(MILLWRIGHT_HALLIB=options.hallib, HOME=place)
        try:
            done = subprocess.run(
                [options.bin + "/millwright", "run", str(mine), str(program), "--no-estimate"],
                cwd=mine.parent, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, text=True, errors="replace", timeout=options.timeout)
            status, text = done.returncode, done.stdout
        except subprocess.TimeoutExpired as late:
            status, text = 124, (late.stdout or b"").decode(errors="replace")
        if status == 0:
            return "", ""
        return reason_of(text, status)


# : Exit status of WORK if joints are not axes.
NOT_IDENTITY = 3

SCREEN = """#!/usr/bin/env python3
import sys, time
import linuxcnc
s, c = linuxcnc.stat(), linuxcnc.command()
c.state(linuxcnc.STATE_ESTOP_RESET)
c.wait_complete()
c.state(linuxcnc.STATE_ON)
c.wait_complete()
s.poll()
if s.task_state != linuxcnc.STATE_ON:
    sys.exit("error: it does not switch on")
"""


# : With --work, appended to SCREEN: homes, runs a line of MDI and a program, and checks whether it has returned to its
# start.
WORK = """
def fail(text):
    while True:
        told = errors.poll()
        if told is None:
            sys.exit("error: " + text)
        text += "; " + told[1].strip()
def until(what, holds, seconds):
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            fail(what)
        time.sleep(0.02)
        s.poll()
errors = linuxcnc.error_channel()
if s.kinematics_type != linuxcnc.KINEMATICS_IDENTITY:
    sys.exit(IDENTITY_NOT)
homed = lambda: all(s.homed[:s.joints - s.num_extrajoints])
if not homed():
    c.mode(linuxcnc.MODE_MANUAL)
    c.wait_complete()
    c.teleop_enable(0)
    c.wait_complete()
    c.home(-1)
    until("it does not home", homed, 60)
    until("it does not rest after homing", lambda: s.inpos and s.state == linuxcnc.RCS_DONE, 20)
c.mode(linuxcnc.MODE_MDI)
if c.wait_complete() != linuxcnc.RCS_DONE:
    fail("no MDI mode")
program = open(sys.argv[-1]).read().split()
line = next(word for word in program if word[0] in "XYZABCUVW")
c.mdi("G91 G0 " + line)
if c.wait_complete(60) != linuxcnc.RCS_DONE:
    fail("a line of MDI fails")
c.mdi("G90")
c.wait_complete()
s.poll()
began = s.position
c.mode(linuxcnc.MODE_AUTO)
c.wait_complete()
c.program_open(sys.argv[-1])
c.auto(linuxcnc.AUTO_RUN, 0)
if c.wait_complete(120) != linuxcnc.RCS_DONE:
    fail("the program fails")
until("it does not come back", lambda: max(abs(a - b) for a, b in zip(began, s.position)) < 1e-4, 10)
""".replace("IDENTITY_NOT", "3")


def start(options, ini, folder, place):
    """(class, line of the error); class "" if it has started, was switched on and has ended with status 0."""
    with tempfile.TemporaryDirectory(dir=place) as place:
        copy = pathlib.Path(place) / "configs"
        shutil.copytree(folder, copy, symlinks=True, copy_function=os.link)
        mine = copy / ini.relative_to(folder)
        screen = mine.parent / "mw_screen.py"
        program = pathlib.Path(place) / "small.ngc"
        program.write_text(program_for(values_of(mine)))
        screen.write_text(SCREEN + (WORK if options.work else ""))
        screen.chmod(0o755)
        lines = [re.sub(r"^\s*DISPLAY\s*=.*", "DISPLAY = ./mw_screen.py %s" % program, line) for line in merged(mine)]
        mine.unlink()
        mine.write_text("\n".join(lines) + "\n")
        instance = "configs-%d" % os.getpid()
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        environment.update(MILLWRIGHT_HALLIB=options.hallib, HOME=place, MILLWRIGHT_INSTANCE=instance)
        # Written to a file, because programs that outlive the launcher would keep a pipe open.
        said = pathlib.Path(place) / "said.txt"
        with open(said, "wb") as out, subprocess.Popen(
                [options.bin + "/linuxcnc", "-r", str(mine)], cwd=mine.parent, env=environment, stdin=subprocess.DEVNULL,
                stdout=out, stderr=subprocess.STDOUT) as process:
            try:
                status = process.wait(timeout=options.timeout)
            except subprocess.TimeoutExpired:
                status = 124
                end(process)
        left = kill_left(instance)
        text = said.read_text(errors="replace")
        if status == NOT_IDENTITY and options.work:
            return "not identity", ""
        if status != 0:
            return reason_of(text, status)
        return ("left behind", left[0]) if left else ("", "")


def end(process):
    process.terminate()
    try:
        process.wait(timeout=20)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def kill_left(instance):
    """Kills the remaining processes of this instance; returns their command lines."""
    mark = ("MILLWRIGHT_INSTANCE=" + instance).encode()
    for _ in range(20):  # programs that are ending have a second for it
        left = [folder for folder in pathlib.Path("/proc").iterdir() if folder.name.isdigit() and has(folder, mark)]
        if not left:
            return []
        time.sleep(0.05)
    lines = []
    for folder in left:
        try:
            lines.append((folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
            os.kill(int(folder.name), signal.SIGKILL)
        except OSError:
            continue  # it has ended meanwhile
    return lines


def has(folder, mark):
    try:
        return folder.name != str(os.getpid()) and mark in (folder / "environ").read_bytes().split(b"\0")
    except OSError:
        return False  # it has ended, or belongs to another user


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", default=str(ROOT / "build/release/bin"))
    parser.add_argument("--configs", default=CONFIGS)
    parser.add_argument("--hallib", default=HALLIB)
    parser.add_argument("--only", default="", help="only configurations whose path contains this")
    parser.add_argument("--timeout", type=float, help="30; with --work 120")
    parser.add_argument("--out", default="", help="a table: configuration, class, first error")
    parser.add_argument("--least", type=int, default=0, help="fail when fewer run")
    parser.add_argument("--work", action="store_true",
                        help="with --start: where joints are axes, home, run a line of MDI and a program")
    parser.add_argument("--start", action="store_true", help="bring each up with a script as its display")
    options = parser.parse_args()
    options.bin = str(pathlib.Path(options.bin).resolve())
    options.timeout = options.timeout or (120.0 if options.work else 30.0)
    folder = pathlib.Path(options.configs)
    judge = start if options.start else run
    inis = sorted(ini for ini in folder.rglob("*.ini") if options.only in str(ini.relative_to(folder)))
    if options.start:
        inis = [ini for ini in inis if re.search(r"^\[EMC\]", ini.read_text(errors="replace"), re.M)]
    if not inis:
        sys.exit("no configuration in " + options.configs)
    out = open(options.out, "w") if options.out else None
    classes = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="mw_configs_") as place:
        whole = pathlib.Path(place) / "whole"
        shutil.copytree(folder, whole, symlinks=True)
        for ini in inis:
            name, line = judge(options, whole / ini.relative_to(folder), whole, place)
            classes[name] += 1
            row = "%s\t%s\t%s" % (ini.relative_to(folder), name or "run", line.replace(place, ""))
            print(row if name else row.rstrip(), flush=True)
            if out:
                out.write(row + "\n")
                out.flush()
    print()
    for name, count in classes.most_common():
        if name:
            print("%4d  %s" % (count, name))
    print("%d of %d run" % (classes[""], len(inis)))
    sys.exit(0 if classes[""] >= options.least else 1)


if __name__ == "__main__":
    main()
