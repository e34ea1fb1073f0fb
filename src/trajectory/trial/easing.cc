// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/trial/easing.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

bool isCurved(const PlannedPath &path, const Workspace &workspace, Sequence piece) noexcept {
    const Piece &p = path.piece(piece);
    return p.blend_d > 0 || path.primitive(p.primitive).isArc || workspace.isMapped();
}

}  // namespace

void Easing::begin() noexcept {
    ++planning_;
    excess_ = UNLIMITED;
    tick_ = 0;
    gentle_ = {};
}

Easing::Eased &Easing::eased(Sequence piece) noexcept {
    Eased &of = eased_[piece % PIECE_CAPACITY];
    if (of.piece != piece) {
        of = {};
        of.piece = piece;
    }
    return of;
}

double Easing::gentle_of(Sequence piece) const noexcept {
    const Eased &of = eased_[piece % PIECE_CAPACITY];
    return of.piece == piece ? of.gentle : 1.0;
}

void Easing::ease_piece(PlannedPath &path, Sequence piece, double speed, double acceleration) noexcept {
    Eased &of = eased(piece);
    if (of.planning != planning_) {
        of.planning = planning_;
        of.speed = 1;
        of.acceleration = 1;
    }
    of.speed *= speed;
    of.acceleration *= acceleration;
    path.scale(piece, speed, acceleration);
}

Cause Easing::take_back(PlannedPath &path) noexcept {
    Cause changed;
    for (Sequence k = path.oldest_piece(); k <= path.last_piece(); ++k) {
        Eased &of = eased_[k % PIECE_CAPACITY];
        if (of.piece == k && of.planning == planning_) {
            path.scale(k, 1.0 / of.speed, 1.0 / of.acceleration);
            of.planning = 0;
            changed.low = changed.low == 0 ? k : changed.low;
            changed.high = k;
        }
    }
    return changed;
}

Means Easing::means_against(const PathView &view, const Cause &cause) const noexcept {
    const double tau = view.conditions.limits.filter_s();
    Means means;
    for (Sequence k = cause.low; k <= cause.high; ++k) {
        const PlannedPiece &plan = view.path.plan(k);
        means.most_dwell_s =
            plan.isStopBefore ? std::max(means.most_dwell_s, tau - plan.dwell_s) : means.most_dwell_s;
        means.isAnyCurved = means.isAnyCurved || isCurved(view.path, view.conditions.workspace, k);
        const Piece &piece = view.path.piece(k);
        const double a = piece.acceleration.at(0);
        means.rising_s += std::min(speed_cap(view, k) / a, std::sqrt(2.0 * piece.length / a));
    }
    return means;
}

bool Easing::lengthen_stands(PlannedPath &path, const PathLimits &limits, const Cause &cause,
                             const Means &means, double excess) const noexcept {
    const bool isGentle = (excess - 1.0) * means.rising_s < EasingTuning::STAND_WORTH * means.most_dwell_s &&
                          excess < EasingTuning::MOST_GENTLE;
    if (!(means.most_dwell_s > 0) || isGentle) {
        return false;
    }
    const double tau = limits.filter_s();
    for (Sequence k = cause.low; k <= cause.high; ++k) {
        PlannedPiece &plan = path.plan(k);
        plan.dwell_s =
            plan.isStopBefore ? std::min(tau, plan.dwell_s + EasingTuning::STAND_STEP * tau) : plan.dwell_s;
    }
    return true;
}

/// The attempt before got farther, or failed by much less.
bool Easing::hasHelped(const Verdict &verdict) const noexcept {
    return verdict.tick > tick_ || verdict.excess - 1.0 < EasingTuning::HELPED * (excess_ - 1.0);
}

Sequence Easing::take_back_gentleness(PlannedPath &path, const Verdict &verdict) noexcept {
    if (hasHelped(verdict) || gentle_.low == 0) {
        return 0;
    }
    for (Sequence k = gentle_.low; k <= gentle_.high; ++k) {
        ease_piece(path, k, 1.0, 1.0 / gentle_.factor);
        eased(k).gentle /= gentle_.factor;
    }
    const Sequence last = gentle_.high;
    gentle_ = {};
    return last;
}

/// No piece loses more than a part of its acceleration to `factor` and those before it.
bool Easing::canBeGentler(const Cause &cause, double factor) const noexcept {
    for (Sequence k = cause.low; k <= cause.high; ++k) {
        if (!(gentle_of(k) * factor >= EasingTuning::LEAST_ALONG)) {
            return false;
        }
    }
    return true;
}

void Easing::apply(PlannedPath &path, const Workspace &workspace, const Step &step) noexcept {
    for (Sequence k = step.low; k <= step.high; ++k) {
        if (step.isEverything || isCurved(path, workspace, k)) {
            ease_piece(path, k, step.speed, step.acceleration);
        }
    }
}

void Easing::slow_down(PlannedPath &path, const Workspace &workspace, const Cause &cause, const Means &means,
                       const Verdict &verdict) noexcept {
    const double excess = verdict.excess;
    const double along = 1.0 - EasingTuning::ALONG_MARGIN * (excess - 1.0) / (verdict.along_share * excess) -
                         EasingTuning::ALONG_ROOM;
    const bool isStand = means.most_dwell_s > 0;
    const bool isAlong = !isStand && verdict.along_share > EasingTuning::ALONG_SHARE && hasHelped(verdict) &&
                         canBeGentler(cause, along);
    // If slower curves alone do not help, the pieces before them are too fast.
    const bool isEverything = !means.isAnyCurved || isStand || isAlong || excess >= excess_;
    excess_ = excess;
    tick_ = verdict.tick;
    const double slower = isStand || isAlong ? 1.0
                                             : std::clamp(EasingTuning::LEAST_SLOWER / std::sqrt(excess),
                                                          EasingTuning::SLOWEST, EasingTuning::LEAST_SLOWER);
    const double gentler = isAlong ? along
                                   : std::clamp(EasingTuning::LEAST_GENTLER / excess, EasingTuning::GENTLEST,
                                                EasingTuning::LEAST_GENTLER);
    step_ = {cause.low, cause.high, slower, gentler, isEverything};
    apply(path, workspace, step_);
    gentle_ = isAlong ? Gentleness{cause.low, cause.high, gentler} : Gentleness{};
    for (Sequence k = gentle_.low; k <= gentle_.high && k > 0; ++k) {
        eased(k).gentle *= gentler;
    }
}

void Easing::undo(PlannedPath &path, const Workspace &workspace) noexcept {
    step_.speed = 1.0 / step_.speed;
    step_.acceleration = 1.0 / step_.acceleration;
    apply(path, workspace, step_);
    gentle_ = {};
}

}  // namespace mw::trajectory
