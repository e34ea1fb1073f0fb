// SPDX-License-Identifier: GPL-2.0-or-later
// A module in C++.
#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"
#include "rtapi_string.h"

namespace {
template <class T>
struct Filter {
    T state{};
    T step(T in) { return state += (in - state) / 2; }
};
struct Channel {
    hal_float_t *in, *out;
    Filter<double> filter;
};
int comp_id;
void run(void *arg, long) {
    auto *c = static_cast<Channel *>(arg);
    *c->out = c->filter.step(*c->in);
}
}  // namespace

extern "C" int rtapi_app_main(void) {
    comp_id = hal_init("cxxmod");
    auto *c = static_cast<Channel *>(hal_malloc(sizeof(Channel)));
    if (comp_id < 0 || c == nullptr) {
        return -1;
    }
    int r = hal_pin_float_newf(HAL_IN, &c->in, comp_id, "cxxmod.in");
    if (r == 0) {
        r = hal_pin_float_newf(HAL_OUT, &c->out, comp_id, "cxxmod.out");
    }
    if (r == 0) {
        r = hal_export_funct("cxxmod.run", run, c, 1, 0, comp_id);
    }
    if (r == 0) {
        r = hal_ready(comp_id);
    }
    return r;
}
extern "C" void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
