# SPDX-License-Identifier: GPL-2.0-or-later
"""Helpers for programs that interpret G-code with the module gcode: see rs274.interpret.

Modules of other packages rs274 later in the path (those of an installed LinuxCNC, for its programs) remain accessible.
"""
import pkgutil

__path__ = pkgutil.extend_path(__path__, __name__)

from .interpret import ArcsToSegmentsMixin, Translated  # noqa: E402,F401
