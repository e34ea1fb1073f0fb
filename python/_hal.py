# SPDX-License-Identifier: GPL-2.0-or-later
"""The native part of `hal`, under the name by which widgets and older packages import it."""
from hal._core import *  # noqa: F401,F403
from hal._core import component, error, item  # noqa: F401
from hal import query  # noqa: F401
