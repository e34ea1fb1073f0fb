# SPDX-License-Identifier: GPL-2.0-or-later
# Lets wheels jog: [HAL]HALFILE = LIB:wheeljogpins.tcl [scale]
# jog-enable is true and jog-scale is scale (1 without one) at each joint and each axis of [TRAJ]COORDINATES. The counts of the
# wheel are for other files to link.
set scale [expr {[llength $argv] > 0 ? [lindex $argv 0] : 1}]
if {![string is double -strict $scale]} { error "wheeljogpins.tcl: '$scale' is no scale" }
for {set j 0} {$j < [lindex $::KINS(JOINTS) 0]} {incr j} {
    setp joint.$j.jog-enable 1
    setp joint.$j.jog-scale $scale
}
foreach letter [lsort -unique [split [string tolower [string map {" " ""} [join $::TRAJ(COORDINATES) ""]]] ""]] {
    setp axis.$letter.jog-enable 1
    setp axis.$letter.jog-scale $scale
}
