// SPDX-License-Identifier: GPL-2.0-or-later
component usrinit "A program with options of its own";
option userspace;
option userinit yes;
option extra_compile_args "-DANSWER=42 -I.";
option extra_link_args "-llinuxcncini";
pin out s32 answer;
pin out s32 words;
pin out s32 from_ini;
license "GPL"; // GPL-2.0-or-later
;;
#include <inifile.h>
#include <unistd.h>
static int given, level = -1;
void userinit(int argc, char **argv) {
    given = argc + (names[0] ? 100 : 0);
    if (argc > 1) {
        FILE *f = fopen(argv[1], "r");
        if (!f) exit(3);
        iniFindInt(f, "LEVEL", "TEST", &level);
        fclose(f);
    }
}
void user_mainloop(void) {
    FOR_ALL_INSTS() {
        answer = ANSWER;
        words = given;
        from_ini = level;
    }
    while (1) usleep(1000);
}
