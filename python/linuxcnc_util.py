# SPDX-License-Identifier: GPL-2.0-or-later
"""Functions that wait for states of a machine, for scripts that operate it.

    import linuxcnc_util
    machine = linuxcnc_util.LinuxCNC()
    machine.wait_for_linuxcnc_startup()

Each wait raises LinuxCNC_Exception with the awaited state if its time expires.
"""
import time

import linuxcnc

_LETTERS = "xyzabcuvw"
_STEP_S = 0.01
_TIMEOUT_S = 10.0
_STILL_S = 0.05


class LinuxCNC_Exception(linuxcnc.error):
    """The awaited state was not reached in time."""


class LinuxCNC:
    """LinuxCNC([command, status, error]): a machine. Objects that are not passed are created."""

    def __init__(self, command=None, status=None, error=None):
        self.command = command or linuxcnc.command()
        self.status = status or linuxcnc.stat()
        self.error = error or linuxcnc.error_channel()

    def _wait(self, is_so, what, timeout):
        end = time.monotonic() + timeout
        while True:
            self.status.poll()
            if is_so(self.status):
                return
            if time.monotonic() > end:
                raise LinuxCNC_Exception(f"{what}: not within {timeout} s")
            time.sleep(_STEP_S)

    def wait_for_linuxcnc_startup(self, timeout=_TIMEOUT_S):
        """Waits until the machine is ready, in emergency stop and idle."""

        def is_ready(status):
            return (status.axis_mask != 0 and status.cycle_time > 0 and status.linear_units > 0
                    and status.exec_state == linuxcnc.EXEC_DONE and status.interp_state == linuxcnc.INTERP_IDLE
                    and status.state == linuxcnc.RCS_DONE and status.task_state == linuxcnc.STATE_ESTOP)

        end = time.monotonic() + timeout
        while True:
            try:
                return self._wait(is_ready, "the machine is ready", max(0.0, end - time.monotonic()))
            except linuxcnc.error as error:
                if isinstance(error, LinuxCNC_Exception) or time.monotonic() > end:
                    raise
                time.sleep(_STEP_S)  # it does not exist yet

    def all_joints_homed(self, joints):
        """True if each joint whose entry is not 0 is homed."""
        self.status.poll()
        return all(self.status.homed[i] for i, wanted in enumerate(joints) if wanted)

    def wait_for_home(self, joints, timeout=_TIMEOUT_S):
        """Waits until each joint whose entry is not 0 is homed."""
        self._wait(lambda status: all(status.homed[i] for i, wanted in enumerate(joints) if wanted),
                   f"joints {joints} are homed", timeout)

    def wait_for_axis_to_stop(self, axis_letter, timeout=_TIMEOUT_S):
        """Waits until the axis has not moved for a short time."""
        index = _LETTERS.index(axis_letter.lower())
        since = [None, 0.0]

        def has_stopped(status):
            now, place = time.monotonic(), status.position[index]
            if place != since[0]:
                since[:] = [place, now]
            return now - since[1] >= _STILL_S

        self._wait(has_stopped, f"axis {axis_letter} is stopped", timeout)

    def wait_for_axis_to_stop_at(self, axis_letter, target, timeout=_TIMEOUT_S, tolerance=1e-4):
        """Waits until the axis is stopped at the position."""
        index = _LETTERS.index(axis_letter.lower())
        self._wait(lambda status: abs(status.position[index] - target) < tolerance,
                   f"axis {axis_letter} is at {target}", timeout)
        self.wait_for_axis_to_stop(axis_letter, timeout)

    def jog_axis(self, axis_letter, target, timeout=_TIMEOUT_S, velocity=None):
        """Jogs an axis to the position and waits until it is stopped there. The machine is in teleop mode."""
        index = _LETTERS.index(axis_letter.lower())
        self.status.poll()
        distance = target - self.status.position[index]
        if distance != 0:
            speed = velocity or self.status.max_velocity or abs(distance)
            self.command.jog(linuxcnc.JOG_INCREMENT, 0, index, speed if distance > 0 else -speed, abs(distance))
        self.wait_for_axis_to_stop_at(axis_letter, target, timeout)

    def wait_for_interp_state(self, target, timeout=_TIMEOUT_S):
        """Waits until the interpreter is in this state (linuxcnc.INTERP_*)."""
        self._wait(lambda status: status.interp_state == target, f"the interpreter is in state {target}", timeout)

    def wait_for_tool_in_spindle(self, expected, timeout=_TIMEOUT_S):
        """Waits until this tool is in the spindle."""
        self._wait(lambda status: status.tool_in_spindle == expected, f"tool {expected} is in the spindle", timeout)
