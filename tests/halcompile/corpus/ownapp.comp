// SPDX-License-Identifier: GPL-2.0-or-later
component ownapp "Makes its instances itself";
option rtapi_app no;
pin out s32 number;
variable int extra;
option extra_setup;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
static int how_many = 2;
RTAPI_MP_INT(how_many, "instances");

EXTRA_SETUP() { extra = extra_arg; return 0; }

int rtapi_app_main(void) {
    int i, r = 0;
    comp_id = hal_init("ownapp");
    if (comp_id < 0) return comp_id;
    for (i = 0; i < how_many && r == 0; i++) {
        char name[HAL_NAME_LEN + 1];
        rtapi_snprintf(name, sizeof(name), "mine.%c", 'a' + i);
        r = export(name, 5 * i);
    }
    if (r < 0) { hal_exit(comp_id); return r; }
    return hal_ready(comp_id);
}
void rtapi_app_exit(void) { hal_exit(comp_id); }
FUNCTION(_) { number = extra; }
