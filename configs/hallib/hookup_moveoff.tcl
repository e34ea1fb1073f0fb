# SPDX-License-Identifier: GPL-2.0-or-later
# Puts the component moveoff, named mv, between motion and the motors: [HAL]HALFILE = LIB:hookup_moveoff.tcl, behind the files that
# link joint.N.motor-pos-cmd and joint.N.motor-pos-fb.
# Settings: [MOVEOFF]EPSILON, WAYPOINT_SAMPLE_SECS, WAYPOINT_THRESHOLD, BACKTRACK_ENABLE, also of [OFFSET]; of joint n [MOVEOFF_n]MAX_LIMIT,
# MIN_LIMIT, MAX_VELOCITY, MAX_ACCELERATION, else those of its axis, with or without OFFSET_ before them.
namespace eval moveoff {
    # The first setting that is there; words are "SECTION KEY".
    proc first {args} {
        foreach {section key} [join $args] {
            if {[info exists ::${section}($key)]} { return [lindex [set ::${section}($key)] 0] }
        }
        return ""
    }
    proc set_pin {pin value} { if {$value ne ""} { setp $pin $value } }

    # The signal of a pin.
    proc signal_of {pin} {
        foreach line [split [hal show pin $pin] \n] {
            if {[regexp {(\S+)\s+(?:==>|<==|<=>)\s+(\S+)\s*$} $line -> name signal] && $name eq $pin} { return $signal }
        }
        error "hookup_moveoff.tcl: $pin is not linked; files that link it stand before this one"
    }

    # The place in the servo thread of a function, from 1.
    proc place_of {function} {
        foreach line [split [hal show thread servo-thread] \n] {
            if {[regexp {^\s*(\d+)\s+(\S+)\s*$} $line -> place name] && $name eq $function} { return $place }
        }
        error "hookup_moveoff.tcl: $function is not in servo-thread"
    }

    proc hook_up {} {
        set joints [lindex $::KINS(JOINTS) 0]
        set letters [split [string toupper [string map {" " ""} [join $::TRAJ(COORDINATES) ""]]] ""]
        loadrt moveoff names=mv personality=$joints
        # What was measured counts before motion looks, what is commanded behind it.
        addf mv.read-inputs servo-thread [place_of motion-controller]
        addf mv.write-outputs servo-thread [expr {[place_of motion-controller] + 1}]
        for {set j 0} {$j < $joints} {incr j} {
            set command [signal_of joint.$j.motor-pos-cmd]
            set feedback [signal_of joint.$j.motor-pos-fb]
            unlinkp joint.$j.motor-pos-cmd
            unlinkp joint.$j.motor-pos-fb
            net mv:pos-$j joint.$j.motor-pos-cmd mv.pos-$j
            net $command mv.pos-plusoffset-$j
            net $feedback mv.fb-$j
            net mv:fb-$j mv.fb-minusoffset-$j joint.$j.motor-pos-fb
            foreach {key pin} {MAX_LIMIT max MIN_LIMIT min MAX_VELOCITY vel MAX_ACCELERATION accel} {
                set axis AXIS_[lindex $letters $j]
                set_pin mv.offset-$pin-$j [first [list MOVEOFF_$j $key $axis OFFSET_$key $axis $key]]
            }
        }
        foreach {key pin} {EPSILON epsilon WAYPOINT_SAMPLE_SECS waypoint-sample-secs WAYPOINT_THRESHOLD waypoint-threshold
                BACKTRACK_ENABLE backtrack-enable} {
            set_pin mv.$pin [first [list MOVEOFF $key OFFSET $key]]
        }
    }
}
moveoff::hook_up
