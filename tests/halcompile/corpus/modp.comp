// SPDX-License-Identifier: GPL-2.0-or-later
component modp "Module parameters of all kinds";
modparam int level = 3 "an integer";
modparam long far "a long one";
modparam string title = "none" "a text";
modparam int list[4] = 7 "several";
modparam dummy table "declared in the code";
pin out s32 sum;
pin out s32 letters;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
static char *table[3];
RTAPI_MP_ARRAY_STRING(table, 3, "texts");
FUNCTION(_) {
    int i;
    sum = level + (int)far + list[0] + list[1] + list[2] + list[3];
    letters = strlen(title);
    for (i = 0; i < 3; i++) if (table[i]) letters += 100 * strlen(table[i]);
}
