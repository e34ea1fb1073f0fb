// SPDX-License-Identifier: GPL-2.0-or-later
// scope_rt: replaces halscope's sampling function, so that HAL files which load it and add `scope.sample` to
// a thread work unchanged. It records nothing, because the halscope window of LinuxCNC 2.9 reads the memory
// of LinuxCNC's own HAL. It reports this when it is loaded; `capture` records pins (`millwright hal
// capture`).
#include "hal/sdk/component.hh"

static int num_samples = 16000;
RTAPI_MP_INT(num_samples, "accepted for the files that name it; nothing is recorded");

namespace mw::components {

struct ScopeRt {
    void declare(sdk::Declare &d) noexcept { d.function<&ScopeRt::sample>(this, "sample"); }
    void sample() noexcept {}
};

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id = hal_init("scope_rt");
    if (mw_comp_id < 0) {
        return mw_comp_id;
    }
    rtapi_print_msg(RTAPI_MSG_ERR,
                    "scope_rt: scope.sample is there for files that add it to a thread, and records "
                    "nothing; 'millwright hal capture' records pins around a trigger");
    auto *scope = mw::sdk::make<mw::components::ScopeRt>();
    int status = -ENOMEM;
    if (scope != nullptr) {
        mw::sdk::Declare declare(mw_comp_id, "scope", 0);
        scope->declare(declare);
        status = declare.status();
    }
    mw_comp_id = mw::sdk::finish(mw_comp_id, status);
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
