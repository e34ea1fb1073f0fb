# SPDX-License-Identifier: GPL-2.0-or-later
"""Internal parts of Millwright's programs in Python; not for clients."""
