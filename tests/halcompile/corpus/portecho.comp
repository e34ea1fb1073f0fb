// SPDX-License-Identifier: GPL-2.0-or-later
component portecho "Gives back what it reads, in capitals";
pin in port in;
pin out port out;
pin out u32 waiting;
function _ nofp;
license "GPL"; // GPL-2.0-or-later
;;
FUNCTION(_) {
    char c;
    waiting = hal_port_readable(&in);
    while (hal_port_writable(out) > 0 && hal_port_read(in, &c, 1)) {
        if (c >= 'a' && c <= 'z') c -= 32;
        hal_port_write(&out, &c, 1);
    }
}
