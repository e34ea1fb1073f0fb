# SPDX-License-Identifier: GPL-2.0-or-later
"""Helpers for programs that look at G-code through the module gcode: see rs274.interpret.

Other modules of a package rs274 further along the path (those of an installed LinuxCNC, for its own programs) stay
within reach.
"""
import pkgutil

__path__ = pkgutil.extend_path(__path__, __name__)

from .interpret import ArcsToSegmentsMixin, Translated  # noqa: E402,F401
