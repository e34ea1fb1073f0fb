// SPDX-License-Identifier: GPL-2.0-or-later
component giver "Has something for other modules";
pin out s32 asked;
variable int unused_;
function _ nofp;
option singleton;
license "GPL"; // GPL-2.0-or-later
;;
static int times;
int corpus_private = 1;
int corpus_answer(int question) { times++; return 2 * question; }
EXPORT_SYMBOL_GPL(corpus_answer);
FUNCTION(_) { asked = times; }
