// SPDX-License-Identifier: GPL-2.0-or-later
component onoff "Two-point controller with a dead band";
pin in float value;
pin in float setpoint = 20;
pin io bit enable = TRUE;
pin out bit heat;
param rw float band = 1.0 "half the dead band";
function _ fp "Switches the heater";
description r"""
.B onoff
switches on below \fIsetpoint\fR - \fIband\fR and off above \fIsetpoint\fR + \fIband\fR.""";
notes "One per heater.";
see_also "\\fBcomp\\fR(9)";
examples "loadrt onoff names=bed";
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    if (!enable) { heat = 0; return; }
    if (value < setpoint - band) heat = 1;
    if (value > setpoint + band) heat = 0;
}
