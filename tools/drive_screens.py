#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs unmodified screens of an installed LinuxCNC with Millwright. Each screen is started under Xvfb with a sample
configuration, and a second client homes, runs and aborts programs and checks the result. The tests do not use this program.

usage: script/screens --check [SCREEN ...] [--pictures DIR]
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

#: Screen: (sample configuration, seconds until its picture is complete)
SCREENS = {
    "axis": ("sim/axis/axis_mm.ini", 4),
    "tklinuxcnc": ("sim/tklinuxcnc/tklinuxcnc.ini", 3),
    "touchy": ("sim/touchy/touchy.ini", 6),
    "gmoccapy": ("sim/gmoccapy/gmoccapy.ini", 10),
    "gscreen": ("sim/gscreen/gscreen_mm.ini", 10),
    "qtdragon": ("sim/qtdragon/qtdragon_xyz/qtdragon_metric.ini", 14),
    "qtaxis": ("sim/qtvcp_screens/qtaxis.ini", 14),
    "pyvcp": ("sim/pyvcp_demo/pyvcp_demo1.ini", 5),
    "gladevcp": ("sim/axis/gladevcp/gladevcp_panel.ini", 8),
}
PROGRAM = """G21 G90 F1500
G0 X0 Y0 Z0
G1 X20
G2 X30 Y10 I0 J10
G1 Y20
G1 X0
G1 Y0
M2
"""
#: Errors of the screens that are independent of the machine.
OWN = {"gscreen": "'Statusbar' object has no attribute 'remove_message'"}
#: Output of a screen that has failed contains one of these.
BAD = ("Traceback (most recent call last)", "Segmentation fault", "terminate called", "died: its process")


class Failed(Exception):
    pass


def until(what, holds, timeout=15.0):
    end = time.monotonic() + timeout
    while not holds():
        if time.monotonic() > end:
            raise Failed(what)
        time.sleep(0.02)


class Machine:
    """A second client besides the screen."""

    def __init__(self):
        import linuxcnc
        self.lc, self.s, self.c = linuxcnc, linuxcnc.stat(), linuxcnc.command()

    def see(self):
        self.s.poll()
        return self.s

    def ask(self, name, *words):
        getattr(self.c, name)(*words)
        self.c.wait_complete(10)

    def isIdle(self):
        s = self.see()
        return s.interp_state == self.lc.INTERP_IDLE and s.inpos and s.queue == 0

    def switch_on(self):
        # Buttons of screens depend on the state that they have seen, so each state is given time to be seen.
        self.ask("state", self.lc.STATE_ESTOP_RESET)
        time.sleep(1)
        self.ask("state", self.lc.STATE_ON)
        time.sleep(1)
        until("it is on", lambda: self.see().task_state == self.lc.STATE_ON)

    def home(self):
        self.ask("mode", self.lc.MODE_MANUAL)
        self.ask("teleop_enable", 0)
        joints = self.see().joints
        self.c.home(-1)
        time.sleep(1)
        s = self.see()
        if not any(s.homed[:joints]) and not any(s.joint[j]["homing"] for j in range(joints)):
            for joint in range(joints):  # without HOME_SEQUENCE each joint is homed separately
                self.c.home(joint)
                until("joint %d is homed" % joint, lambda j=joint: self.see().homed[j], 30)
        until("all joints are homed", lambda: all(self.see().homed[:joints]), 30)

    def run(self, program):
        self.ask("program_open", program)
        until("the program is open", lambda: self.see().file == program)
        time.sleep(2)  # screens draw the path, and some then set their own mode
        self.ask("mode", self.lc.MODE_AUTO)
        self.c.auto(self.lc.AUTO_RUN, 0)
        until("the program runs", lambda: self.see().interp_state != self.lc.INTERP_IDLE)

    def drive(self, program, look):
        self.switch_on()
        self.home()
        self.ask("mode", self.lc.MODE_MDI)
        self.ask("mdi", "G0 X1 Y1")
        until("the line of MDI has moved it", lambda: abs(self.see().position[0]) > 0.5)
        self.run(program)
        until("the program has ended", self.isIdle, 60)
        until("it is stopped at the end", lambda: max(map(abs, self.see().position[:3])) < 1e-3)
        time.sleep(1)
        look()
        self.run(program)
        time.sleep(0.7)
        self.ask("abort")
        until("it is aborted", self.isIdle)
        self.ask("mode", self.lc.MODE_MANUAL)
        self.ask("state", self.lc.STATE_ESTOP)
        until("it is in emergency stop", lambda: self.see().task_state == self.lc.STATE_ESTOP)


def keys(*names):
    subprocess.run(["xdotool", "key", "--clearmodifiers", *names], check=True)
    time.sleep(0.3)


def drive_axis(machine, place):
    """The actions of a person at the keyboard of AXIS."""
    lc, see = machine.lc, machine.see
    program = str(place / "keys.ngc")
    pathlib.Path(program).write_text(PROGRAM)
    subprocess.run(["xdotool", "mousemove", "300", "300"], check=True)
    keys("F1")
    until("F1 leaves emergency stop", lambda: see().task_state == lc.STATE_ESTOP_RESET)
    keys("F2")
    until("F2 switches on", lambda: see().task_state == lc.STATE_ON)
    keys("ctrl+Home")
    until("ctrl-Home homes", lambda: all(see().homed[:see().joints]), 30)
    subprocess.run(["xdotool", "keydown", "Right"], check=True)
    time.sleep(0.6)
    subprocess.run(["xdotool", "keyup", "Right"], check=True)
    until("the arrow jogs", lambda: see().position[0] > 1 and see().inpos)
    subprocess.run(["axis-remote", "--mdi", "G0 X0 Y0 Z0"], check=True)
    until("axis-remote --mdi moves", lambda: machine.isIdle() and abs(see().position[0]) < 1e-6)
    subprocess.run(["axis-remote", program], check=True)
    until("axis-remote opens", lambda: see().file == program)
    keys("F3", "r")
    until("r runs", lambda: see().interp_state != lc.INTERP_IDLE)
    keys("p")
    until("p pauses", lambda: see().paused)
    keys("s")
    until("s resumes", lambda: not see().paused)
    until("the program ends", machine.isIdle, 60)
    keys("r")
    until("r runs again", lambda: see().interp_state != lc.INTERP_IDLE)
    keys("Escape")
    until("Escape aborts", machine.isIdle)
    keys("F3")
    subprocess.run(["xdotool", "keydown", "Left"], check=True)
    time.sleep(0.4)
    subprocess.run(["xdotool", "keyup", "Left"], check=True)
    until("a jog after a program has stopped", lambda: see().inpos)
    if see().task_mode != lc.MODE_MANUAL:
        raise Failed("the page of manual controls leads into manual mode")
    keys("F1")
    until("F1 stops", lambda: see().task_state == lc.STATE_ESTOP)


def picture(path):
    subprocess.run(["import", "-window", "root", "-depth", "8", str(path)], check=True)


def colours(path):
    """The number of colours in a picture; an empty screen has one."""
    seen = subprocess.run(["identify", "-format", "%k", str(path)], capture_output=True, text=True, check=True)
    return int(seen.stdout)


def start_display(place):
    """An Xvfb on a free number: (process, ":N")."""
    read, write = os.pipe()
    process = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1024x24", "-nolisten", "tcp"],
                               pass_fds=[write], stdout=subprocess.DEVNULL, stderr=open(place / "xvfb.txt", "wb"))
    os.close(write)
    with os.fdopen(read) as number:
        return process, ":" + number.readline().strip()


def prepare(share, place):
    configs = place / "configs"
    shutil.copytree(share / "doc/linuxcnc/examples/sample-configs", configs, symlinks=True)
    (place / "linuxcnc/nc_files").mkdir(parents=True)  # touchy needs this
    os.environ.update(HOME=str(place), LIBGL_ALWAYS_SOFTWARE="1", DBUS_SESSION_BUS_ADDRESS="disabled:",
                      NO_AT_BRIDGE="1", MILLWRIGHT_INSTANCE="screens-%d" % os.getpid())
    return configs


#: These are shown by AXIS.
IN_AXIS = ("axis", "pyvcp", "gladevcp")


def close(name, process):
    if name in IN_AXIS:
        subprocess.run(["axis-remote", "--quit"], check=True)
    else:
        process.terminate()
    try:
        status = process.wait(timeout=30)
    except subprocess.TimeoutExpired as late:
        process.kill()
        raise Failed("it ends within 30 s") from late
    if status != 0:
        raise Failed("the launcher ends with 0, not %d" % status)


def check(name, configs, place, pictures):
    ini, patience = SCREENS[name]
    path, said = configs / ini, pictures / (name + ".txt")
    program = place / (name + ".ngc")
    program.write_text(PROGRAM)
    with open(said, "wb") as out:
        process = subprocess.Popen(["linuxcnc", "-r", str(path)], cwd=path.parent, stdout=out, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL)
    try:
        machine = Machine()
        def isUp():
            if process.poll() is not None:
                raise Failed("the screen keeps running")
            try:
                return machine.see().joints > 0
            except machine.lc.error:
                return False
        until("the machine runs", isUp, 30)
        time.sleep(patience)
        isUp()
        picture(pictures / (name + ".png"))
        if colours(pictures / (name + ".png")) < 16:
            raise Failed("there is a picture")
        if name == "axis":
            drive_axis(machine, place)
        machine.drive(str(program), lambda: picture(pictures / (name + ".png")))
        isUp()
        close(name, process)
        # The reaction of the toolkit's event loop to a signal is not checked.
        text = said.read_text(errors="replace").split("note: stopped by")[0]
        if name in OWN:
            text = re.sub(r"Traceback \(most recent call last\):(?:\n[ ]+.*)+\n.*%s.*" % re.escape(OWN[name]), "", text)
        for bad in BAD:
            if bad in text:
                raise Failed("nothing like '%s' is said" % bad)
        return None
    except (Failed, subprocess.CalledProcessError) as failure:
        return str(failure)
    finally:
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(timeout=15)
            except subprocess.TimeoutExpired:
                process.kill()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--share", default="/usr/share")
    parser.add_argument("--pictures", default="", help="keep a picture of each screen, and what it has said, there")
    parser.add_argument("screens", nargs="*", metavar="SCREEN", help=", ".join(SCREENS))
    options = parser.parse_args()
    unknown = [name for name in options.screens if name not in SCREENS]
    if unknown:
        parser.error("no screen '%s'; there are: %s" % (unknown[0], ", ".join(SCREENS)))
    missing = [tool for tool in ("Xvfb", "xdotool", "import", "identify") if shutil.which(tool) is None]
    if missing:
        sys.exit("error: %s is not installed (Debian's xvfb, xdotool, imagemagick)" % missing[0])
    failures = 0
    with tempfile.TemporaryDirectory(prefix="mw_screens_") as folder:
        place = pathlib.Path(folder)
        pictures = pathlib.Path(options.pictures or folder).resolve()
        pictures.mkdir(parents=True, exist_ok=True)
        configs = prepare(pathlib.Path(options.share), place)
        for name in options.screens or SCREENS:
            # fresh: no window of the previous screen is left
            display, os.environ["DISPLAY"] = start_display(place)
            try:
                failure = check(name, configs, place, pictures)
            finally:
                display.terminate()
                display.wait()
            print("%-12s %s" % (name, "passed" if failure is None else "FAILED: not so: " + failure), flush=True)
            if failure is not None:
                failures += 1
                print("    " + "\n    ".join((pictures / (name + ".txt")).read_text(errors="replace").splitlines()[-12:]))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
