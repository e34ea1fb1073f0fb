// SPDX-License-Identifier: GPL-2.0-or-later
component setup "Looks at its name, then at its pins";
option extra_setup yes;
option post_export yes;
pin out s32 length;
pin out s32 number;
variable int letters = 100;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
EXTRA_SETUP() {
    letters = strlen(prefix);
    return 0;
}
POST_EXPORT() {
    number = extra_arg + 10;
    return 0;
}
FUNCTION(_) { length = letters; }
