// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/probe/probe.hh"

namespace mw::motion {

ProbeEvent TouchProbe::step(const ProbeInputs &in, const geometry::Pose &position) noexcept {
    if (in.probing_move != 0) [[unlikely]] {
        if (move_ != in.probing_move) {
            move_ = in.probing_move;
            tripped_ = false;
        }
        const bool isContact = in.isClosed != in.isAway;
        if (!isContact || tripped_) {
            return ProbeEvent::NONE;
        }
        tripped_ = true;
        position_ = position;
        ++trips_;
        return ProbeEvent::FOUND;
    }
    const bool isTouched = in.isClosed && !was_closed_ && in.isMoving;
    const bool isRetracting = in.isDropping && tripped_;
    return isTouched && !isRetracting ? ProbeEvent::TOUCHED : ProbeEvent::NONE;
}

CommandResult TouchProbe::take(const ClearProbeFlag &) noexcept {
    tripped_ = false;
    return {};
}

void TouchProbe::fill(bool isClosed, Status &status) const noexcept {
    status.probed_pos = position_;
    status.isProbeTripped = tripped_;
    status.probe_value = isClosed;
}

}  // namespace mw::motion
