// SPDX-License-Identifier: GPL-2.0-or-later
component gate "Sum of several inputs, with an optional average";
pin in s32 in-##[16 : personality & 0xf] "a summand";
pin out s32 sum;
pin out float average if (personality & 0x10) != 0 "their mean";
param rw float weight-#[4 : (personality >> 8) & 7] if personality & 0x20 = 1.5;
function _;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    int i, n = personality & 0xf, s = 0;
    for (i = 0; i < n; i++) s += in(i);
    sum = s;
    if (personality & 0x10) average = n ? (double)s / n : 0;
}
