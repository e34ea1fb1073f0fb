// SPDX-License-Identifier: GPL-2.0-or-later
component setters "Sets outputs by functions";
pin in si32 a = 3;
pin out ui32 b;
pin out bit many-#[3];
pin io float level;
pin out bit kept_set;
pin out bit kept;
option personality;
option period no;
function _ fp;
license "GPL"; // GPL-2.0-or-later
;;
#include <rtapi_vsnprintf.h>
FUNCTION(_) {
    b_set(a + personality);
    many_set(1, 1);
    level_set(1.5);
    kept_set = 1;
}
