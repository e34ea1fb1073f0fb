#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A component in Python whose output is twice its input."""
import time

import hal

component = hal.component('pyusr')
component.newpin('in', hal.HAL_FLOAT, hal.HAL_IN)
component.newpin('out', hal.HAL_FLOAT, hal.HAL_OUT)
component.ready()
try:
    while True:
        component['out'] = 2 * component['in']
        time.sleep(0.002)
except KeyboardInterrupt:
    pass
