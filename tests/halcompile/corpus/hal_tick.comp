// SPDX-License-Identifier: GPL-2.0-or-later
component hal_tick "The component is hal_tick, its pins are tick.N";
pin out bit tick_;
function run_now nofp;
license "GPL"; // GPL-2.0-or-later
;;
tick_ = !tick_;
