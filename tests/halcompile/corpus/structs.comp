// SPDX-License-Identifier: GPL-2.0-or-later
component structs "Types of its own";
struct sample {
    double value; /* the last; } */
    struct { int count; } times;
};
typedef struct { int a, b; } pair_t;
typedef unsigned long long big_t;
variable struct sample last;
variable struct sample history[2][3];
variable pair_t pairs[2] = {{1, 2}, {3, 4}};
variable big_t big = 1ULL << 40;
variable float table[3] = 2.5;
variable s32 old_style = -5;
variable char word[8] = "abc";
pin in float in;
pin out float out;
pin out s64 check;
function _;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    last.value = in;
    last.times.count++;
    history[1][2] = last;
    out = history[1][2].value + table[0] + table[2];
    check = pairs[0].a + 10 * pairs[1].b + (big >> 40) * 100 + old_style * 1000 + word[2];
}
