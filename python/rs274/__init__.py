# SPDX-License-Identifier: GPL-2.0-or-later
"""Helpers for programs that look at G-code through the module gcode: see rs274.interpret."""
