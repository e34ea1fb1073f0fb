# SPDX-License-Identifier: GPL-2.0-or-later
# What HAL files in Tcl see, for people who write them: source [file join $::env(HALLIB_DIR) util_lib.tcl]

# The script, its words and its folder.
proc show_context {} {
    puts "script: [expr {[info exists ::argv0] ? $::argv0 : {}}]"
    puts "words: [expr {[info exists ::argv] ? $::argv : {}}]"
    puts "folder: [pwd]"
}

# The sections of the INI file and their settings, as the arrays that scripts have.
proc show_ini {} {
    foreach name [lsort [info globals]] {
        if {![string is upper -strict [string index $name 0]] || ![array exists ::$name]} continue
        foreach key [lsort [array names ::$name]] { puts "\[$name\]$key = [set ::${name}($key)]" }
    }
}

# The environment.
proc show_env {} {
    foreach name [lsort [array names ::env]] { puts "$name = $::env($name)" }
}
