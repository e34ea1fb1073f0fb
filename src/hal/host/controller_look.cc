// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/controller_look.hh"

namespace mw::hal {

void ControllerLook::step(Hal::Impl &hal, std::int32_t pid) {
    bool isHung = pid > 0 && !hal.controller_watches.empty();
    for (const auto &watch : hal.controller_watches) {
        if (watch.looks != nullptr) {
            __atomic_fetch_add(watch.looks, 1U, __ATOMIC_RELAXED);
        }
        isHung = isHung && __atomic_load_n(watch.is_safe, __ATOMIC_ACQUIRE) != 0;
    }
    if (isHung && !isHung_) {
        hal.rest_process(pid);
    }
    isHung_ = isHung;
}

}  // namespace mw::hal
