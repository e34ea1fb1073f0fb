// SPDX-License-Identifier: GPL-2.0-or-later
component shiftreg "Shifts a bit along";
pin in bit in;
pin out bit out-##[8];
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
int i;
for (i = 7; i > 0; i--) out(i) = out(i - 1);
out(0) = in;
