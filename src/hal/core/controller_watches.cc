// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/controller_watches.hh"

#include <algorithm>

namespace mw::hal {

void ControllerWatches::add(std::uint32_t *is_gone, const std::uint32_t *is_safe, int comp_id) {
    watches_.push_back({is_gone, is_safe, comp_id});
}

bool ControllerWatches::count_checks(int comp_id, std::uint32_t *checks) {
    const auto found = std::ranges::find(watches_, comp_id, &Watch::comp_id);
    if (found == watches_.end()) {
        return false;
    }
    found->checks = checks;
    return true;
}

void ControllerWatches::remove(int comp_id) {
    std::erase_if(watches_, [comp_id](const Watch &watch) { return watch.comp_id == comp_id; });
}

void ControllerWatches::report_gone() noexcept {
    for (const Watch &watch : watches_) {
        __atomic_store_n(watch.is_gone, 1U, __ATOMIC_RELEASE);
    }
}

void ControllerWatches::count_check() noexcept {
    for (const Watch &watch : watches_) {
        if (watch.checks != nullptr) {
            __atomic_fetch_add(watch.checks, 1U, __ATOMIC_RELAXED);
        }
    }
}

bool ControllerWatches::isSafe() const noexcept {
    return std::ranges::all_of(
        watches_, [](const Watch &watch) { return __atomic_load_n(watch.is_safe, __ATOMIC_ACQUIRE) != 0; });
}

}  // namespace mw::hal
