# SPDX-License-Identifier: GPL-2.0-or-later
package ifneeded Hal 1.0 [list load [file join $dir libmillwright_haltcl.so] Hal]
package ifneeded Linuxcnc 1.0 [list source [file join $dir linuxcnc.tcl]]
