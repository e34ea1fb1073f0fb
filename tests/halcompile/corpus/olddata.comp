// SPDX-License-Identifier: GPL-2.0-or-later
component olddata "The older way to keep something";
include "corpus_types.h";
option data struct corpus_data;
pin out float out;
function _;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    data.count++;
    data.sum += corpus_step;
    out = data.sum + data.count;
}
