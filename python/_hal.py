# SPDX-License-Identifier: GPL-2.0-or-later
"""The native part of `hal`, with the name that widgets and older packages import."""
from hal._core import *  # noqa: F401,F403
from hal._core import component, error, item  # noqa: F401
from hal import query  # noqa: F401
