// SPDX-License-Identifier: GPL-2.0-or-later
component taker "Asks the module giver";
pin in s32 question = 21;
pin out s32 answer;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
extern int corpus_answer(int);
int corpus_private = 2;
FUNCTION(_) { answer = corpus_answer(question) + corpus_private; }
