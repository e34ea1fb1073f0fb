// SPDX-License-Identifier: GPL-2.0-or-later
component snoop "Wants what giver keeps to itself; does not load";
pin out s32 seen;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
extern int corpus_hidden;
FUNCTION(_) { seen = corpus_hidden; }
