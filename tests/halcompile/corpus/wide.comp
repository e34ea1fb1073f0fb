// SPDX-License-Identifier: GPL-2.0-or-later
component wide "64 bits";
pin in s64 a = -5000000000;
pin in u64 b = 6000000000;
pin out s64 sum;
pin out u64 top;
param rw s64 p = -1;
param rw u64 q;
pin in signed c; pin in unsigned d;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) { sum = a + (rtapi_s64)b + p + c + d; top = ~(rtapi_u64)0; }
