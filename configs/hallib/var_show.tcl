# SPDX-License-Identifier: GPL-2.0-or-later
# Prints what HAL files in Tcl see: [HAL]HALFILE = LIB:var_show.tcl
source [file join [file dirname [info script]] util_lib.tcl]
show_context
show_ini
show_env
