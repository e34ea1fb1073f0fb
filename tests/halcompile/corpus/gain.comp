// SPDX-License-Identifier: GPL-2.0-or-later
component gain "Multiplies a value";
pin in float in "what comes in";
pin out float out "in times gain";
param rw float gain = 2.5 "the factor";
function _;
license "GPL"; // GPL-2.0-or-later
author "Millwright";
;;
out = in * gain;
