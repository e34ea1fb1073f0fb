// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/host_status.hh"

#include <algorithm>
#include <cstring>

#include "hal/core/detail/segment.hh"

namespace mw::hal {

using namespace detail;

bool HostStatus::isRealtime() const noexcept {
    return segment_.header().realtime;
}

std::string HostStatus::realtime_missing() const {
    Guard guard(segment_);
    return segment_.header().realtime_missing.data();
}

void HostStatus::set_realtime_missing(std::string_view why) {
    Guard guard(segment_);
    auto &text = segment_.header().realtime_missing;
    text.fill('\0');
    std::copy_n(why.begin(), std::min(why.size(), text.size() - 1), text.begin());
}

std::optional<std::string> HostStatus::end_reason() const {
    const EndRecord &end = segment_.header().end;
    if (end.state.load(std::memory_order_acquire) == EndRecord::WHOLE) {
        return end.text.data();
    }
    return segment_.hasHost() ? std::nullopt
                              : std::optional<std::string>("it was killed, or ended without a message");
}

void HostStatus::note_end(const char *text) noexcept {
    EndRecord &end = segment_.header().end;
    std::uint32_t nobody = EndRecord::NONE;
    if (end.state.compare_exchange_strong(nobody, EndRecord::BEING_WRITTEN)) {
        std::strncpy(end.text.data(), text, end.text.size() - 1);
        // Release: pairs with end_reason(); a process that sees WHOLE sees the text.
        end.state.store(EndRecord::WHOLE, std::memory_order_release);
    }
}

std::atomic<std::uint32_t> &HostStatus::lost_positions() noexcept {
    return segment_.header().lost_positions;
}

}  // namespace mw::hal
