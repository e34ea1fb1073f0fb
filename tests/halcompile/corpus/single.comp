// SPDX-License-Identifier: GPL-2.0-or-later
component single "There is one only";
option singleton yes;
pin out s32 ticks;
function tick nofp;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(tick) { ticks++; }
