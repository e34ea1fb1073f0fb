// SPDX-License-Identifier: GPL-2.0-or-later
component tpline "A trajectory planner that knows one line";
option tpmod yes;
pin out bit is_module = 1;
license "GPL"; // GPL-2.0-or-later
;;
double tpline_length(double a, double b);
double tpline_length(double a, double b) { return a < b ? b - a : a - b; }
EXPORT_SYMBOL(tpline_length);
