// SPDX-License-Identifier: GPL-2.0-or-later
component pulse "A pulse of a given length";
pin in bit trigger;
pin out bit out;
pin out float left "seconds";
param rw float length = 0.003;
variable double rest = 0;
variable int was_on;
variable long total = 40;
function _;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    if (trigger && !was_on) rest = length;
    was_on = trigger;
    rest -= fperiod;
    if (rest < 1e-9) rest = 0;
    total += period;
    out = rest > 0;
    left = rest;
}
