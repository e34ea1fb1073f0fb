# SPDX-License-Identifier: GPL-2.0-or-later
# Tells what is likely forgotten: [HAL]HALFILE = LIB:halcheck.tcl [nopopup], as the last one.
# Functions that no thread runs, signals that nobody reads, signals that nobody writes. "nopopup" is taken: there is never a
# window.
proc halcheck_functions {} {
    set idle {}
    foreach line [split [hal show funct] \n] {
        if {[regexp {^\s*\d+\s.*\s(\d+)\s+(\S+)\s*$} $line -> users name] && $users == 0} { lappend idle $name }
    }
    return $idle
}

# {signals without readers} {signals without writers}
proc halcheck_signals {} {
    set unread {}
    set unwritten {}
    set name ""
    foreach line [concat [split [hal show sig] \n] [list "bit 0 end"]] {
        if {[regexp {^\s*(==>|<==|<=>)\s+\S+} $line -> arrow]} {
            if {$arrow ne "==>"} { set hasWriter 1 }
            if {$arrow ne "<=="} { set hasReader 1 }
        } elseif {[regexp {^(bit|float|s32|u32|s64|u64|port)\s+\S+\s+(\S+)} $line -> type next]} {
            if {$name ne "" && !$hasReader} { lappend unread $name }
            if {$name ne "" && !$hasWriter} { lappend unwritten $name }
            set name $next
            set hasReader 0
            set hasWriter 0
        }
    }
    return [list $unread $unwritten]
}

lassign [halcheck_signals] unread unwritten
foreach {what names} [list "functions without addf" [halcheck_functions] "signals with no inputs" $unread \
        "signals with no output" $unwritten] {
    puts "halcheck: [llength $names] $what[expr {[llength $names] > 0 ? ": [join $names { }]" : {}}]"
}
