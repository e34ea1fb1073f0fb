// SPDX-License-Identifier: GPL-2.0-or-later
// multiswitch: buttons step through outputs. `cfg=3,2` makes instances of 3 and 2 outputs (default one of 4),
// 2 to 32 each, up to 32 instances.
//
// Each press of `up` or `down` (bit) moves to the next or previous of `bit-00`, `bit-01`, ..., from the last
// to the first and back. Parameters: `position` (s32) is the number of the output that is true and may be
// set; `top-position` (u32) is the number of the last one used.
#include "hal/sdk/component.hh"

constexpr int MAX_SWITCHES = 32;
static int cfg[MAX_SWITCHES] = {4};
RTAPI_MP_ARRAY_INT(cfg, MAX_SWITCHES, "outputs of each instance");
static int personality = 0;
RTAPI_MP_INT(personality, "not used; see cfg");

namespace mw::components {
using namespace sdk;

constexpr int MAX_OUTPUTS = 32;

struct Multiswitch {
    int size = 0;
    In<bool> up, down;
    Out<bool> bit[MAX_OUTPUTS];
    ParamRw<std::uint32_t> top_position;
    ParamRw<std::int32_t> position;
    bool last_up = false;
    bool last_down = false;

    void declare(Declare &d) noexcept {
        d.pin(up, "up");
        d.pin(down, "down");
        for (int i = 0; i < size; ++i) {
            d.pin_at(bit[i], "bit-%02d", i);
        }
        d.param(top_position, "top-position", static_cast<std::uint32_t>(size - 1));
        d.param(position, "position");
        d.function<&Multiswitch::update>(this);
    }

    void update() noexcept {
        const bool is_up = up;
        const bool is_down = down;
        const std::int64_t limit = top_position;
        const std::int64_t last = limit < size ? limit : size - 1;
        std::int64_t now = position;
        now += is_up && !last_up ? 1 : 0;
        now -= is_down && !last_down ? 1 : 0;
        last_up = is_up;
        last_down = is_down;
        now = now > last ? 0 : (now < 0 ? last : now);
        position = static_cast<std::int32_t>(now);
        for (int i = 0; i < size; ++i) {
            bit[i] = i == now;
        }
    }
};

struct Multiswitches {
    int load(int comp_id) noexcept {
        int status = 0;
        for (int i = 0; i < MAX_SWITCHES && cfg[i] != 0 && status == 0; ++i) {
            status = load_switch(comp_id, i);
        }
        return status;
    }

    int load_switch(int comp_id, int number) noexcept {
        if (cfg[number] < 2 || cfg[number] > MAX_OUTPUTS) {
            rtapi_print_msg(RTAPI_MSG_ERR, "multiswitch: cfg has %d, but an instance has 2 to %d outputs",
                            cfg[number], MAX_OUTPUTS);
            return -EINVAL;
        }
        Multiswitch *instance = make<Multiswitch>();
        if (instance == nullptr) {
            return -ENOMEM;
        }
        instance->size = cfg[number];
        Name prefix;
        rtapi_snprintf(prefix.text, sizeof prefix.text, "multiswitch.%d", number);
        Declare d(comp_id, prefix.text, number);
        instance->declare(d);
        return d.status();
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Multiswitches, "multiswitch");
