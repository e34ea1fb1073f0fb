// SPDX-License-Identifier: GPL-2.0-or-later
component many "Three unless told otherwise";
option default_count 3;
option constructable yes;
pin out bit alive = 1;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
alive = !alive;
