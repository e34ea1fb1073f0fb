// SPDX-License-Identifier: GPL-2.0-or-later
// A program with a HAL component, for tests: user_component NAME [crash|late|deaf]. Ends at SIGTERM; `crash`
// when its input pin NAME.in becomes TRUE; `late` is ready only after a delay; `deaf` ignores SIGTERM.
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <string>

#include "hal/include/hal.h"
#include "hal/include/rtapi.h"

namespace {

volatile sig_atomic_t ending = 0;

void nap(long ms) {
    const timespec time{0, ms * 1000000};
    nanosleep(&time, nullptr);
}

}  // namespace

int main(int argc, char **argv) {
    const std::string name = argc > 1 ? argv[1] : "user_component";
    const std::string mode = argc > 2 ? argv[2] : "";
    signal(SIGTERM, mode == "deaf" ? SIG_IGN : +[](int) { ending = 1; });
    const int comp = hal_init(name.c_str());
    if (comp < 0) {
        return 1;
    }
    auto **pins = static_cast<hal_bit_t **>(hal_malloc(2 * sizeof(hal_bit_t *)));
    const bool made = hal_pin_bit_newf(HAL_IN, &pins[0], comp, "%s.in", name.c_str()) == 0 &&
                      hal_pin_bit_newf(HAL_OUT, &pins[1], comp, "%s.out", name.c_str()) == 0;
    if (!made) {
        return 1;
    }
    *pins[1] = 1;
    if (mode == "late") {
        nap(50);
    }
    hal_ready(comp);
    while (ending == 0) {
        if (mode == "crash" && *pins[0] != 0) {
            abort();
        }
        nap(2);
    }
    hal_exit(comp);
    return 0;
}
