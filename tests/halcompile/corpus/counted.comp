// SPDX-License-Identifier: GPL-2.0-or-later
component counted "As many as there are addresses";
option count_function;
option extra_setup;
option extra_cleanup;
option constructable no;
pin out s32 address;
param r u32 place;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
#define MOST 4
static int at[MOST];
RTAPI_MP_ARRAY_INT(at, MOST, "addresses")

int get_count(void) {
    int n = 0;
    while (n < MOST && at[n] != 0) n++;
    return n;
}

EXTRA_SETUP() {
    if (at[extra_arg] < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: address %d is negative\n", prefix, at[extra_arg]);
        return -ERANGE;
    }
    place = at[extra_arg];
    return 0;
}

EXTRA_CLEANUP() { rtapi_print_msg(RTAPI_MSG_ERR, "counted: cleaned up\n"); }

FUNCTION(_) { address = place; }
