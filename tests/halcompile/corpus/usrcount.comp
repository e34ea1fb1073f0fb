// SPDX-License-Identifier: GPL-2.0-or-later
component usrcount "A program that counts";
option userspace yes;
pin out s32 count_;
pin in s32 step = 1;
pin out float phase-#[2];
modparam int pace = 1 "milliseconds";
license "GPL"; // GPL-2.0-or-later
;;
#include <unistd.h>
void user_mainloop(void) {
    while (1) {
        FOR_ALL_INSTS() {
            count_ += step;
            phase(0) = drand48();
            phase(1) = -phase(0);
        }
        usleep(1000 * pace);
    }
}
