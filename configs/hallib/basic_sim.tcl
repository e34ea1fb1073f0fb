# SPDX-License-Identifier: GPL-2.0-or-later
# A simulated machine of any number of joints, from its INI file alone: [HAL]HALFILE = LIB:basic_sim.tcl [options]
# Options: -no_make_ddts, -no_simulated_home, -no_use_hal_manualtoolchange, -no_sim_spindle leave a part out.
source [file join [file dirname [info script]] sim_lib.tcl]

set known {-no_make_ddts -no_simulated_home -no_use_hal_manualtoolchange -no_sim_spindle}
foreach option $argv {
    if {$option ni $known} { error "basic_sim.tcl has no option '$option'; it has $known" }
}
mwsim::motion
mwsim::motors
if {"-no_make_ddts" ni $argv} { mwsim::derivatives }
if {"-no_simulated_home" ni $argv} { mwsim::home_switches }
if {"-no_sim_spindle" ni $argv} { mwsim::spindle }
mwsim::estop
mwsim::tools [expr {"-no_use_hal_manualtoolchange" ni $argv}]
