// SPDX-License-Identifier: GPL-2.0-or-later
// debounce: groups of inputs with one delay each. `cfg=2,3` (required) makes groups 0 and 1 of 2 and 3
// inputs, up to 8 groups of up to 50.
//
// Function debounce.G. Pins debounce.G.F.in and debounce.G.F.out (bit); parameter debounce.G.delay (s32, 5 at
// start) [periods]: see dbounce.
#include "components/logic/debouncer.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_GROUPS = 8;
static int cfg[MAX_GROUPS];
RTAPI_MP_ARRAY_INT(cfg, MAX_GROUPS, "inputs of each group");

namespace mw::components {
using namespace sdk;

constexpr int MAX_INPUTS = 50;

struct DebounceGroup {
    int size = 0;
    In<bool> in[MAX_INPUTS];
    Out<bool> out[MAX_INPUTS];
    ParamRw<std::int32_t> delay;
    logic::Debouncer debouncer[MAX_INPUTS];

    void declare(Declare &d) noexcept {
        for (int i = 0; i < size; ++i) {
            d.pin_at(in[i], "%d.in", i);
            d.pin_at(out[i], "%d.out", i);
        }
        d.param(delay, "delay", 5);
        d.function<&DebounceGroup::update>(this);
    }

    void update() noexcept {
        const long periods = delay;
        for (int i = 0; i < size; ++i) {
            out[i] = debouncer[i].run(in[i], periods);
        }
    }
};

struct Debounce {
    int load(int comp_id) noexcept {
        if (cfg[0] == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "debounce: cfg= is missing, for example cfg=2,3");
            return -EINVAL;
        }
        int status = 0;
        for (int group = 0; group < MAX_GROUPS && cfg[group] != 0 && status == 0; ++group) {
            status = load_group(comp_id, group);
        }
        return status;
    }

    int load_group(int comp_id, int number) noexcept {
        if (cfg[number] < 1 || cfg[number] > MAX_INPUTS) {
            rtapi_print_msg(RTAPI_MSG_ERR, "debounce: cfg has %d, but a group has 1 to %d inputs",
                            cfg[number], MAX_INPUTS);
            return -EINVAL;
        }
        DebounceGroup *group = make<DebounceGroup>();
        if (group == nullptr) {
            return -ENOMEM;
        }
        group->size = cfg[number];
        Name prefix;
        rtapi_snprintf(prefix.text, sizeof prefix.text, "debounce.%d", number);
        Declare d(comp_id, prefix.text, number);
        group->declare(d);
        return d.status();
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Debounce, "debounce");
