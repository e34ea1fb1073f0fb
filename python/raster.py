# SPDX-License-Identifier: GPL-2.0-or-later
"""Sends lines of pixels to the component raster.

    programmer = raster.RasterProgrammer("engraver")        # pins engraver.program, engraver.run, ...
    programmer.begin(offset=0, bpp=8, ppu=10, count=100)
    programmer.data([0, 128, 255] ...)
    programmer.start()                                        # the run begins
    programmer.stop()

Link PROGRAMMER.program to raster.N.program (and set the size of the port's signal), .run to .run, .fault and .fault-code
back.
"""
import enum
import time

import hal
import pyhal


class FaultCodes(enum.IntEnum):
    """Of raster.N.fault-code."""
    NONE = 0
    InvalidOffset = 1
    InvalidBPP = 2
    InvalidPPU = 3
    InvalidCount = 4
    InvalidPixel = 5
    InvalidPosition = 6


class RasterProgrammer:
    """A HAL component with port and run as outputs, reset as output, fault, fault_code and state as inputs."""

    BITS = (4, 8, 12, 16, 20, 24, 28, 32)
    CHUNK = 64

    def __init__(self, name):
        self.component = pyhal.component(name)
        self.port = self.component.pinNew("program", pyhal.halType.PORT, pyhal.pinDir.OUT)
        self.run = self.component.pinNew("run", pyhal.halType.BIT, pyhal.pinDir.OUT)
        self.reset = self.component.pinNew("reset", pyhal.halType.BIT, pyhal.pinDir.OUT)
        self.enabled = self.component.pinNew("enabled", pyhal.halType.BIT, pyhal.pinDir.IN)
        self.fault = self.component.pinNew("fault", pyhal.halType.BIT, pyhal.pinDir.IN)
        self.fault_code = self.component.pinNew("fault-code", pyhal.halType.SIGNED, pyhal.pinDir.IN)
        self.state = self.component.pinNew("state", pyhal.halType.SIGNED, pyhal.pinDir.IN)
        self._digits = 0
        self._missing = 0
        self.component.ready()

    def begin(self, offset, bpp, ppu, count, timeout=None):
        """The header of a line: distance to the first pixel, bits per pixel, pixels per unit, number of pixels."""
        if bpp not in self.BITS:
            raise ValueError(f"a pixel has one of {self.BITS} bits, not {bpp}")
        if self._missing:
            raise ValueError(f"the line before wants {self._missing} more pixels")
        self._digits = bpp // 4
        self._missing = count
        self._send(f"{offset:.9g};{bpp};{ppu:.9g};{count};", timeout)

    def data(self, pixels, timeout=None):
        """Pixels of the line, 0 to 2**bpp - 1, or a text of their hexadecimal digits.

        2**bpp - 2 is full power, 2**bpp - 1 none. Waits for room in the port, at most timeout seconds for each part.
        """
        if isinstance(pixels, str):
            digits = self._digits or 1
            pixels = [int(pixels[at:at + digits], 16) for at in range(0, len(pixels), digits)]
        pixels = list(pixels)
        if len(pixels) > self._missing:
            raise ValueError(f"the line has {self._missing} pixels left, not {len(pixels)}")
        for value in pixels:
            if not 0 <= value < 16 ** self._digits:
                raise ValueError(f"pixel {value} does not have {4 * self._digits} bits")
        self._missing -= len(pixels)
        text = "".join(f"{value:0{self._digits}x}" for value in pixels)
        for at in range(0, len(text), self.CHUNK):
            self._send(text[at:at + self.CHUNK], timeout)

    def start(self, timeout=1.0):
        """Starts the run at the current position.

        If the pin `enabled` is linked, waits until raster reports that it follows the line. Raises RuntimeError at a fault,
        TimeoutError after timeout seconds.
        """
        self.run.value = True
        self._wait_until(True, timeout)

    def stop(self, timeout=1.0):
        """Ends the run; raster then reads the next line. Waits as start() does."""
        self.run.value = False
        self._wait_until(False, timeout)

    def exit(self):
        """Ends the component."""
        self.component.exit()

    def _wait_until(self, enabled, timeout):
        if not hal.pin_has_writer(self.enabled.name):
            return
        end = time.monotonic() + timeout
        while bool(self.enabled.value) != enabled:
            code = self.fault_code.value
            if code and enabled:
                raise RuntimeError(f"raster has fault {code}")
            if time.monotonic() >= end:
                raise TimeoutError("raster does not follow: is it in a running thread, with a whole line?")
            time.sleep(self.enabled.POLL_S)

    def _send(self, text, timeout):
        data = text.encode()
        if not self.port.waitWritable(len(data), timeout):
            raise TimeoutError("the port stays full: is raster loaded, linked and in a running thread?")
        if not self.port.write(data):
            raise OSError("the port took no data")
