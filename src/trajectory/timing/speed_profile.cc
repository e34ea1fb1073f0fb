// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/speed_profile.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// Maximum speed of a move under the current scales [1/s].
double move_cap(const PlannedMove &m, const Scales &scales, double v_limit) noexcept {
    double cap = v_limit;
    if (m.request.isRapid) {
        cap = v_limit * std::min(1.0, scales.rapid);
    } else if (m.request.feed_per_revolution > 0) {
        const double rps = scales.spindle_rps[static_cast<std::size_t>(m.request.spindle)];
        const bool isOverridden = m.request.isOverridable && !m.request.isLocked;
        cap = m.request.feed_per_revolution * std::abs(rps) * m.request.tag.feed_ratio *
              (isOverridden ? scales.feed : 1.0);
    } else if (m.feed > 0) {
        cap = m.feed * (m.request.isOverridable ? scales.feed : 1.0);
    }
    if (!m.request.isAngular) {
        cap = std::min(cap, scales.max_velocity * m.request.tag.feed_ratio);
    }
    return std::min(cap, v_limit);
}

}  // namespace

double speed_cap(const PathView &view, Sequence piece) noexcept {
    const Piece &p = view.path.piece(piece);
    const Scales &scales = view.conditions.scales;
    const double v_limit = view.path.plan(piece).v_limit;
    const double cap = move_cap(view.path.move(p.move), scales, v_limit);
    return p.blend_d > 0 ? std::min(cap, move_cap(view.path.move(p.move + 1), scales, v_limit)) : cap;
}

bool isBarrier(const PathView &view, Sequence piece) noexcept {
    const MoveRequest &r = view.path.move(view.path.move_of(piece)).request;
    return r.isGated || view.conditions.blocks.isStopBefore(r.tag);
}

void SpeedProfile::pass_backward(const PathView &view, Sequence from, bool isWhole) noexcept {
    const PlannedPath &path = view.path;
    while (known_ < path.last_piece()) {
        v2_in_[++known_ % PIECE_CAPACITY] = UNKNOWN;
    }
    const Sequence oldest = path.oldest_piece();
    double next2 = from < path.last_piece() ? v2_in_[(from + 1) % PIECE_CAPACITY] : 0.0;
    double cap = from >= oldest && from > 0 ? speed_cap(view, from) : 0.0;
    for (Sequence k = from; k >= oldest && k > 0; --k) {
        const Piece &p = path.piece(k);
        double v2 = std::min(cap * cap, p.acceleration.highest_before(next2, p.length));
        if (k > oldest) {
            cap = speed_cap(view, k - 1);
            v2 = std::min(v2, cap * cap);
        }
        if (path.plan(k).isStopBefore || isBarrier(view, k)) {
            v2 = 0;
        }
        double &v2_in = v2_in_[k % PIECE_CAPACITY];
        if (v2 != v2_in) {
            changed_from_ = k;
            v2_in = v2;
        } else if (!isWhole) {
            break;
        }
        next2 = v2;
    }
}

void SpeedProfile::renew(const PathView &view, Sequence low, Sequence high) noexcept {
    for (Sequence k = low; k <= high; ++k) {
        v2_in_[k % PIECE_CAPACITY] = UNKNOWN;
    }
    pass_backward(view, std::min(high + 1, view.path.last_piece()), true);
}

bool SpeedProfile::isKept(const PlannedPath &path, const LeaderState &state) const noexcept {
    const Piece &p = path.piece(state.piece);
    return state.v * state.v <= p.acceleration.highest_before(out2(path, state.piece), p.length - state.x) *
                                    (1.0 + TrialTuning::ROUNDING);
}

}  // namespace mw::trajectory
