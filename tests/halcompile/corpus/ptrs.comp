// SPDX-License-Identifier: GPL-2.0-or-later
component ptrs "Memory of its own";
option extra_setup;
option extra_cleanup;
variable int *numbers;
variable char **texts;
pin out s32 sum;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
static int *kept[16];
static int used;
EXTRA_SETUP() {
    numbers = rtapi_kzalloc(4 * sizeof(int), RTAPI_GFP_KERNEL);
    if (!numbers) return -ENOMEM;
    if (used < 16) kept[used++] = numbers;
    texts = 0;
    return 0;
}
EXTRA_CLEANUP() { while (used > 0) rtapi_kfree(kept[--used]); }
FUNCTION(_) {
    int i, s = 0;
    for (i = 0; i < 4; i++) { numbers[i] += i; s += numbers[i]; }
    sum = s;
}
