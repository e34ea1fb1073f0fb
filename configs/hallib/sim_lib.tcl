# SPDX-License-Identifier: GPL-2.0-or-later
# Parts of simulated machines of any number of joints, for HAL files in Tcl: source [file join $::env(HALLIB_DIR) sim_lib.tcl]
# Names of signals: J0:pos-cmd, J0:pos-fb, J0:enable, J0:vel, J0:acc, J0:homesw; estop:loop; tool:change...
namespace eval mwsim {
    # A value of the INI file, or what stands for it: the first of several.
    proc ini {section key {otherwise ""}} {
        if {![info exists ::${section}($key)]} { return $otherwise }
        return [lindex [set ::${section}($key)] 0]
    }
    # The words of a value of the INI file, also where Tcl has them as one.
    proc words {section key {otherwise ""}} {
        if {![info exists ::${section}($key)]} { return $otherwise }
        return [split [string trim [join [set ::${section}($key)]]]]
    }
    proc joints {} {
        set all {}
        for {set j 0} {$j < [ini KINS JOINTS 0]} {incr j} { lappend all $j }
        return $all
    }
    proc is_angular {j} { return [string equal -nocase [ini JOINT_$j TYPE LINEAR] ANGULAR] }

    # Kinematics and motion, and the servo thread.
    proc motion {} {
        loadrt {*}[words KINS KINEMATICS trivkins]
        set given [words EMCMOT EMCMOT motmod]
        loadrt {*}$given base_period_nsec=[ini EMCMOT BASE_PERIOD 0] \
            servo_period_nsec=[ini EMCMOT SERVO_PERIOD 1000000] num_joints=[ini KINS JOINTS] \
            {*}[expr {[ini TRAJ SPINDLES 1] > 1 ? "num_spindles=[ini TRAJ SPINDLES]" : ""}]
        addf motion-command-handler servo-thread
        addf motion-controller servo-thread
    }

    # Each motor goes where it is told to while the machine is on, and stays where it is otherwise.
    proc motors {} {
        set js [joints]
        loadrt pid names=[join [lmap j $js { format J%d_pid $j }] ,]
        loadrt mux2 names=[join [lmap j $js { format J%d_mux $j }] ,]
        foreach j $js { addf J${j}_pid.do-pid-calcs servo-thread }
        foreach j $js { addf J${j}_mux servo-thread }
        net sample:enable motion.motion-enabled
        foreach j $js {
            setp J${j}_pid.Pgain 0
            setp J${j}_pid.FF0 1
            net J$j:enable joint.$j.amp-enable-out J${j}_pid.enable
            net J$j:pos-cmd joint.$j.motor-pos-cmd J${j}_pid.command
            net J$j:on-pos J${j}_pid.output J${j}_mux.in1
            net J$j:pos-fb J${j}_mux.out J${j}_mux.in0 joint.$j.motor-pos-fb
            net sample:enable J${j}_mux.sel
        }
    }

    # Speed and acceleration of each joint, and along the path where joints 0 to 2 are X, Y and Z.
    proc derivatives {} {
        set js [joints]
        set names {}
        foreach j $js { lappend names J${j}_vel J${j}_accel }
        loadrt ddt names=[join $names ,]
        foreach name $names { addf $name servo-thread }
        foreach j $js {
            net J$j:pos-fb J${j}_vel.in
            net J$j:vel J${j}_vel.out J${j}_accel.in
            net J$j:acc J${j}_accel.out
        }
        if {[lindex [words KINS KINEMATICS] 0] ne "trivkins" || [llength $js] < 2} return
        loadrt hypot names=hyp_xy,hyp_xyz
        addf hyp_xy servo-thread
        addf hyp_xyz servo-thread
        net J0:vel hyp_xy.in0 hyp_xyz.in0
        net J1:vel hyp_xy.in1 hyp_xyz.in1
        if {[llength $js] > 2} { net J2:vel hyp_xyz.in2 }
        net xy:vel hyp_xy.out
        net xyz:vel hyp_xyz.out
    }

    # A home switch of each joint, near zero.
    proc home_switches {} {
        set js [joints]
        loadrt sim_home_switch names=[join [lmap j $js { format J%d_switch $j }] ,]
        foreach j $js {
            addf J${j}_switch servo-thread
            net J$j:pos-fb J${j}_switch.cur-pos
            net J$j:homesw J${j}_switch.home-sw joint.$j.home-sw-in
            setp J${j}_switch.home-pos [expr {[is_angular $j] ? 1.0 : 0.1}]
            setp J${j}_switch.hysteresis [expr {[is_angular $j] ? 0.1 : 0.05}]
            if {[string tolower [ini JOINT_$j HOME_USE_INDEX 0]] in {1 yes true on}} {
                net J$j:index-enable joint.$j.index-enable J${j}_switch.index-enable
            }
        }
    }

    # A spindle with some mass, its encoder, and when it is at speed.
    proc spindle {} {
        loadrt sim_spindle names=sim_spindle
        loadrt limit2 names=limit_speed
        loadrt lowpass names=spindle_mass
        loadrt near names=near_speed
        loadrt scale names=rpm_rps
        setp sim_spindle.scale 0.01666667
        setp limit_speed.maxv 5000
        setp spindle_mass.gain 0.07
        setp near_speed.scale 1.1
        setp near_speed.difference 10
        setp rpm_rps.gain 0.0167
        net spindle-speed-cmd spindle.0.speed-out limit_speed.in near_speed.in1
        net spindle-speed-limited limit_speed.out sim_spindle.velocity-cmd spindle_mass.in
        net spindle-rpm-filtered spindle_mass.out near_speed.in2 rpm_rps.in
        net spindle-rps-filtered rpm_rps.out spindle.0.speed-in
        net spindle-at-speed near_speed.out spindle.0.at-speed
        net spindle-pos sim_spindle.position-fb spindle.0.revs
        net spindle-index-enable sim_spindle.index-enable spindle.0.index-enable
        net spindle-orient spindle.0.orient spindle.0.is-oriented
        foreach name {limit_speed spindle_mass rpm_rps near_speed sim_spindle} { addf $name servo-thread }
    }

    proc estop {} { net estop:loop iocontrol.0.user-enable-out iocontrol.0.emc-enable-in }

    # Tools are changed at once, or by a person.
    proc tools {is_by_hand} {
        net tool:prep-loop iocontrol.0.tool-prepare iocontrol.0.tool-prepared
        if {!$is_by_hand} {
            net tool:change-loop iocontrol.0.tool-change iocontrol.0.tool-changed
            return
        }
        loadusr -W hal_manualtoolchange
        net tool:change iocontrol.0.tool-change hal_manualtoolchange.change
        net tool:changed hal_manualtoolchange.changed iocontrol.0.tool-changed
        net tool:prep-number iocontrol.0.tool-prep-number hal_manualtoolchange.number
    }
}
