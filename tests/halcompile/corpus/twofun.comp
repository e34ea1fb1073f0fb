// SPDX-License-Identifier: GPL-2.0-or-later
component twofun "Reads in one function, writes in another";
pin in u32 raw;
pin out u32 cooked;
variable unsigned latch;
function read nofp "takes the input";
function write nofp "gives it out";
license "GPL"; // GPL-2.0-or-later
;;
static unsigned twice(unsigned v) { return 2 * v; }
FUNCTION(read) { latch = raw; }
FUNCTION(write) { cooked = twice(latch); }
