// SPDX-License-Identifier: GPL-2.0-or-later
// message: shows a text to the operator when a pin changes. `messages="One,Two"` lists the texts, one for
// each instance.
//
// `trigger` (bit): its rising edge, or falling edge while the parameter `edge` (bit, true at start) is false,
// shows the text; a rising edge of `force` (bit) shows it again while trigger is in that state. The texts are
// sent as errors of the realtime log, which user interfaces show.
#include "hal/sdk/component.hh"

static char *messages[mw::sdk::MANY];
RTAPI_MP_ARRAY_STRING(messages, mw::sdk::MANY, "text of each instance");

namespace mw::components {
using namespace sdk;

struct Message {
    In<bool> trigger, force;
    ParamRw<bool> edge;
    const char *text = nullptr;
    bool was_active = false;
    bool last_force = false;
    bool first = true;

    void declare(Declare &d) noexcept {
        text = messages[d.index()];
        if (text == nullptr || text[0] == '\0') {
            rtapi_print_msg(RTAPI_MSG_ERR, "message: messages= has no text for instance %d", d.index());
            d.keep(-EINVAL);
            return;
        }
        d.pin(trigger, "trigger");
        d.pin(force, "force");
        d.param(edge, "edge", true);
        d.function<&Message::update>(this);
    }

    void update() noexcept {
        const bool active = trigger == edge;
        const bool forced = force;
        const bool is_new = active && !was_active && !first;
        const bool repeated = active && forced && !last_force;
        if (is_new || repeated) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s\n", text);
        }
        was_active = active;
        last_force = forced;
        first = false;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Message, "message", mw::sdk::MANY);
