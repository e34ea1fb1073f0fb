// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/probe/probe.hh"

namespace mw::motion {

ProbeEvent step(TouchProbe &probe, const ProbeInputs &in, const geometry::Pose &position) noexcept {
    if (in.probing_move != 0) [[unlikely]] {
        if (probe.move != in.probing_move) {
            probe.move = in.probing_move;
            probe.isTripped = false;
        }
        const bool isContact = in.isClosed != in.isAway;
        if (!isContact || probe.isTripped) {
            return ProbeEvent::NONE;
        }
        probe.isTripped = true;
        probe.position = position;
        ++probe.trips;
        return ProbeEvent::FOUND;
    }
    const bool isTouched = in.isClosed && !probe.wasClosed && in.isMoving;
    const bool isRetracting = in.isDropping && probe.isTripped;
    return isTouched && !isRetracting ? ProbeEvent::TOUCHED : ProbeEvent::NONE;
}

CommandResult take(TouchProbe &probe, const ClearProbeFlag &) noexcept {
    probe.isTripped = false;
    return {};
}

void fill(const TouchProbe &probe, bool isClosed, Status &status) noexcept {
    status.probed_pos = probe.position;
    status.isProbeTripped = probe.isTripped;
    status.probe_value = isClosed;
}

}  // namespace mw::motion
