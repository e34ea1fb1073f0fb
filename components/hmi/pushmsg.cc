// SPDX-License-Identifier: GPL-2.0-or-later
// pushmsg: shows texts of the machine when pins change. `emsg="One,Two"` lists the texts of errors, `wmsg`,
// `imsg` and `dmsg` the texts of warnings, information and debugging: up to 16 of each.
//
// A rising edge of `error-NN`, `warning-NN`, `info-NN` or `debug-NN` (bit) sends the text of that number to
// the realtime log; errors are shown by user interfaces. A pin without a text does nothing.
#include "hal/sdk/component.hh"

namespace {

constexpr int SLOTS = 16;
char *emsg[SLOTS];
char *wmsg[SLOTS];
char *imsg[SLOTS];
char *dmsg[SLOTS];

}  // namespace
RTAPI_MP_ARRAY_STRING(emsg, SLOTS, "texts of errors");
RTAPI_MP_ARRAY_STRING(wmsg, SLOTS, "texts of warnings");
RTAPI_MP_ARRAY_STRING(imsg, SLOTS, "texts of information");
RTAPI_MP_ARRAY_STRING(dmsg, SLOTS, "texts of debugging");

namespace mw::components {
using namespace sdk;

struct Pushmsg {
    struct Level {
        const char *pattern;
        char **texts;
        msg_level_t level;
        In<bool> pins[SLOTS];
        bool last[SLOTS] = {};
    };
    Level levels[4] = {{"error-%02d", emsg, RTAPI_MSG_ERR, {}},
                       {"warning-%02d", wmsg, RTAPI_MSG_WARN, {}},
                       {"info-%02d", imsg, RTAPI_MSG_INFO, {}},
                       {"debug-%02d", dmsg, RTAPI_MSG_DBG, {}}};

    int load(int comp_id) noexcept {
        Declare d(comp_id, "pushmsg", 0);
        for (Level &level : levels) {
            for (int i = 0; i < SLOTS; ++i) {
                d.pin_at(level.pins[i], level.pattern, i);
            }
        }
        d.function<&Pushmsg::update>(this);
        return d.status();
    }

    void update() noexcept {
        for (Level &level : levels) {
            for (int i = 0; i < SLOTS; ++i) {
                const bool on = level.pins[i];
                const char *const text = level.texts[i];
                if (on && !level.last[i] && text != nullptr && text[0] != '\0') {
                    rtapi_print_msg(level.level, "%s\n", text);
                }
                level.last[i] = on;
            }
        }
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Pushmsg, "pushmsg");
