# SPDX-License-Identifier: GPL-2.0-or-later
# What programs in Tcl source or require as "Linuxcnc": where things are, fonts, INI files, the command hal.
# The commands emc_* that speak to a machine are compiled and loaded from the same folder.

package provide Linuxcnc 1.0

namespace eval linuxcnc {
    proc environment {name preset} {
        expr {[info exists ::env($name)] && $::env($name) ne "" ? $::env($name) : $preset}
    }
    # Where this file is: screens of an installation have a link to it.
    variable PART_DIR [info script]
    while {[file type $PART_DIR] eq "link"} {
        set PART_DIR [file join [file dirname $PART_DIR] [file readlink $PART_DIR]]
    }
    set PART_DIR [file dirname [file normalize $PART_DIR]]
    variable TCL_DIR [environment LINUXCNC_TCL_DIR [file dirname [info script]]]
    variable HOME [environment LINUXCNC_HOME /usr]
    variable BIN_DIR $HOME/bin
    variable TCL_LIB_DIR $TCL_DIR
    variable TCL_BIN_DIR $TCL_DIR/bin
    variable TCL_SCRIPT_DIR $TCL_DIR/scripts
    variable HELP_DIR [environment LINUXCNC_HELP_DIR $HOME/share/doc/linuxcnc]
    variable RTLIB_DIR [environment HAL_RTMOD_DIR $HOME/lib/millwright/modules]
    variable CONFIG_PATH [list ~/linuxcnc/configs $HOME/share/doc/linuxcnc/examples/sample-configs]
    variable CONFIG_DIR $CONFIG_PATH
    variable USER_CONFIG_DIR ~/linuxcnc/configs
    variable NCFILES_DIR [environment LINUXCNC_NCFILES_DIR $HOME/share/linuxcnc/ncfiles]
    variable LANG_DIR [environment LINUXCNC_LANG_DIR $TCL_DIR/msgs]
    variable REALTIME [environment REALTIME $BIN_DIR/realtime]
    variable RTS uspace
    variable LINUXCNC_AUX_GLADEVCP [environment LINUXCNC_AUX_GLADEVCP $HOME/share/linuxcnc/aux_gladevcp]
    variable LINUXCNC_AUX_EXAMPLES [environment LINUXCNC_AUX_EXAMPLES $HOME/share/linuxcnc/aux_examples]
    variable TMP_DIR [environment TMPDIR /tmp]
    variable RUN_IN_PLACE no
    variable IMAGEDIR {}
    foreach folder [list $HOME/share/linuxcnc $HOME/share/axis/images /usr/share/linuxcnc /usr/share/axis/images] {
        if {[file isdirectory $folder]} {
            lappend IMAGEDIR $folder
        }
    }

    # An image of a file of that name, with any ending that Tk reads.
    proc image_search {name} {
        variable IMAGEDIR
        foreach folder $IMAGEDIR {
            foreach ending {"" .png .gif .xbm} {
                set path [file join $folder $name$ending]
                if {[file isfile $path]} {
                    return [image create photo -file $path]
                }
            }
        }
        error "image '$name' is in none of the folders: $IMAGEDIR"
    }

    proc standard_font_family {} { return [font actual TkDefaultFont -family] }
    proc standard_fixed_font_family {} { return [font actual TkFixedFont -family] }
    proc standard_font_size {} { return [font actual TkDefaultFont -size] }
    proc standard_font {{size ""}} {
        list [standard_font_family] [expr {$size eq "" ? [standard_font_size] : $size}]
    }
    proc standard_fixed_font {{size ""}} {
        list [standard_fixed_font_family] [expr {$size eq "" ? [standard_font_size] : $size}]
    }
}

# Every key of an INI file, appended to the list in ::SECTION(KEY).
proc parse_ini {path} {
    set file [open $path]
    set section ""
    foreach line [split [read $file] \n] {
        set line [string trim $line]
        if {$line eq "" || [string index $line 0] in {"#" ";"}} {
            continue
        }
        if {[regexp {^\[\s*([^\]]*?)\s*\]} $line -> section]} {
            continue
        }
        if {[regexp {^([^=]*?)\s*=\s*(.*)$} $line -> key value] && $section ne ""} {
            lappend ::${section}($key) $value
        }
    }
    close $file
}

# Loads the command of that name when it is first called.
if {[info commands ::hal] eq ""} {
    proc hal {args} {
        rename ::hal ""
        package require Hal
        uplevel 1 [linsert $args 0 hal]
    }
}

# The commands emc_* of a machine that is up are a part of their own.
load [file join $linuxcnc::PART_DIR libmillwright_linuxcnc_tcl.so] Linuxcnc

catch {
    package require msgcat
    ::msgcat::mcload $linuxcnc::LANG_DIR
}
