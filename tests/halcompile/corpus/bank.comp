// SPDX-License-Identifier: GPL-2.0-or-later
component bank "Channels with a name in the middle";
pin in float ch.#.in[3];
pin out float ch.#.out[3];
param rw float ch.#.offset[3] = 0.5;
param r u32 runs_ = 0x10;
function _;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    int i;
    for (i = 0; i < 3; i++) ch_out(i) = ch_in(i) + ch_offset(i);
    runs_++;
}
