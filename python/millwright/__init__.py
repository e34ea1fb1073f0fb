# SPDX-License-Identifier: GPL-2.0-or-later
"""What programs of Millwright that are written in Python consist of. Nothing here is for clients."""
