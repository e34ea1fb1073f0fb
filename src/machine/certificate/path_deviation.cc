// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/certificate/path_deviation.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::machine {
namespace {

using geometry::Pose;

/// Candidates are followed while their deviation is less than this multiple of the smallest one. An actual
/// deviation is reported at most 1/REACH too large.
constexpr double REACH = 8;
constexpr double REACH_OF_TOLERANCE = 2;
constexpr std::size_t MOST_CANDIDATES = 512;
constexpr std::uint32_t COMMIT_STEPS = 16;    ///< interval in samples for comparing the origins of the
                                              ///< candidates
constexpr std::uint32_t DECIDE_STEPS = 2000;  ///< number of samples without a common origin after which the
                                              ///< best candidate decides

}  // namespace

void Deviations::take(const Deviation &one) {
    if (one.distance() > largest.distance()) {
        largest = one;
    }
    if (one.isExact && one.distance() > exact.distance()) {
        exact = one;
    }
    if (!one.isExact && one.ratio() > tightest.ratio()) {
        tightest = one;
    }
}

void Deviations::take(const Deviations &others) {
    take(others.largest);
    take(others.exact);
    take(others.tightest);
}

void PathDeviation::start_sections(std::uint64_t id) {
    const std::optional<PieceStart> start = pieces_.due_section(id);
    if (!start.has_value()) {
        return;
    }
    flush();
    if (*start == PieceStart::AFTER_END) {
        complete();
    } else if (!candidates_.empty()) {
        commit(best());
    }
    pieces_.begin_section(id);
    candidates_.clear();
    if (pieces_.has(pieces_.first())) {
        candidates_.emplace_back().piece = pieces_.first();
    }
    steps_ = 0;
    hasLast_ = false;
}

void PathDeviation::on_sample(const Pose &p, std::uint64_t id, std::int64_t time_ns) {
    start_sections(id);
    if (pending_.has_value()) {
        advance(*pending_, p);
    }
    pending_ = Sample{p, time_ns};
}

/// Assigns the pending sample.
void PathDeviation::flush() {
    if (pending_.has_value()) {
        advance(*pending_, pending_->p);
        pending_.reset();
    }
}

PathDeviation::Step PathDeviation::step_to(const Sample &sample, const Pose &next) const {
    constexpr double SAG = 1.0 / 8;
    const Pose begin = sample.p - last_.p - (last_.p - before_last_);
    const Pose end = next - sample.p - (sample.p - last_.p);
    return {gcode::PieceShape({.start = last_.p, .end = sample.p, .centre = {}, .normal = {}}),
            {SAG * std::max(geometry::norm_linear(begin), geometry::norm_linear(end)),
             SAG * std::max(geometry::norm_abc(begin), geometry::norm_abc(end))},
            sample.time_ns};
}

void PathDeviation::advance(const Sample &sample, const Pose &next) {
    if (!hasLast_) {
        last_ = sample;
        before_last_ = sample.p;
        hasLast_ = true;
    }
    if (!candidates_.empty()) {
        if (pieces_[candidates_.front().piece].isMeasured) {
            assign(sample, step_to(sample, next));
        }
        const PathPiece &here = pieces_[best().piece];
        source_ = here.source;
        isRapid_ = here.shape.piece().isRapid;
    }
    before_last_ = last_.p;
    last_ = sample;
}

double PathDeviation::bound(double cost, std::uint64_t number) const {
    return std::max({REACH * cost, REACH_OF_TOLERANCE * pieces_[number].tolerance, REACH * EXACT_TOLERANCE});
}

bool PathDeviation::isBetter(const Candidate &a, const Candidate &b) {
    return a.cost != b.cost ? a.cost < b.cost : a.now < b.now;
}

const PathDeviation::Candidate &PathDeviation::best() const {
    return *std::ranges::min_element(candidates_, isBetter);
}

/// Each candidate may remain on its piece, or pass corners in the step from the last sample.
void PathDeviation::assign(const Sample &sample, const Step &step) {
    const std::vector<Candidate> &before = candidates_;
    double least = std::numeric_limits<double>::infinity();
    next_.clear();
    for (const Candidate &candidate : before) {
        next_.push_back(candidate);
        move_to(next_.back(), sample, candidate.fraction);
        least = std::min(least, next_.back().cost);
    }
    const double limit = bound(least, before.front().piece);
    const std::size_t stayed = next_.size();
    std::optional<Passing> passing;
    std::size_t i = 0;
    for (std::uint64_t number = before.front().piece; i < stayed || passing.has_value(); ++number) {
        const bool hasStayed = i < stayed && before[i].piece == number;
        std::optional<Passing> onward = pass(hasStayed ? &before[i] : nullptr, passing, step, limit);
        if (passing.has_value()) {
            Candidate &arrived = passing->candidate;
            move_to(arrived, sample, 0);
            if (hasStayed && isBetter(arrived, next_[i])) {
                next_[i] = arrived;
            } else if (!hasStayed && arrived.cost <= limit) {
                next_.push_back(arrived);
            }
        }
        i += hasStayed ? 1 : 0;
        passing = std::move(onward);
    }
    std::ranges::sort(next_, {}, &Candidate::piece);
    candidates_.swap(next_);
    prune();
    commit_common();
}

gcode::Nearest PathDeviation::corner_distance(std::uint64_t number, const Step &step, double from) const {
    return step.chord.nearest(pieces_[number].shape.piece().end, from, step.sag);
}

std::optional<PathDeviation::Passing> PathDeviation::pass(const Candidate *before,
                                                          const std::optional<Passing> &passing,
                                                          const Step &step, double limit) {
    if (before == nullptr && !passing.has_value()) {
        return std::nullopt;
    }
    const std::uint64_t number = before != nullptr ? before->piece : passing->candidate.piece;
    if (!pieces_.continues(number)) {
        return std::nullopt;
    }
    const Candidate *from = nullptr;
    gcode::Nearest corner;
    double least = limit;
    if (passing.has_value()) {
        const gcode::Nearest nearest = corner_distance(number, step, passing->along);
        if (std::max(passing->candidate.cost, nearest.distance()) <= least) {
            from = &passing->candidate;
            corner = nearest;
            least = std::max(from->cost, nearest.distance());
        }
    }
    if (before != nullptr) {
        const gcode::Nearest nearest = corner_distance(number, step, 0);
        if (std::max(before->cost, nearest.distance()) <= least) {
            from = before;
            corner = nearest;
        }
    }
    if (from == nullptr) {
        return std::nullopt;
    }
    Passing onward{*from, corner.fraction};
    add_corner(onward.candidate, corner, step.time_ns);
    onward.candidate.piece = number + 1;
    onward.candidate.fraction = 0;
    return onward;
}

/// Adds a candidate that passes the corner at the end of the candidate's piece.
void PathDeviation::add_corner(Candidate &candidate, const gcode::Nearest &nearest,
                               std::int64_t time_ns) const {
    const PathPiece &before = pieces_[candidate.piece];
    const bool isJoined =
        pieces_.isMade(candidate.piece + 1) && pieces_[candidate.piece + 1].start == PieceStart::AT_CORNER;
    const PathPiece &after = isJoined ? pieces_[candidate.piece + 1] : before;
    const bool isExact = before.isExact || after.isExact;
    const double low = std::min(before.tolerance, after.tolerance);
    const double tolerance = isExact   ? EXACT_TOLERANCE
                             : low > 0 ? low
                                       : std::max(before.tolerance, after.tolerance);
    add(candidate, {nearest.linear, nearest.angular, tolerance, isExact, time_ns, before.source,
                    before.shape.piece().end});
}

/// Assigns the sample to the nearest point of the candidate's piece that is not before `from`.
void PathDeviation::move_to(Candidate &candidate, const Sample &sample, double from) const {
    const PathPiece &here = pieces_[candidate.piece];
    const gcode::Nearest nearest = here.shape.nearest(sample.p, from);
    candidate.fraction = nearest.fraction;
    candidate.now = nearest.distance();
    add(candidate, {nearest.linear, nearest.angular, here.tolerance, here.isExact, sample.time_ns,
                    here.source, sample.p});
}

void PathDeviation::add(Candidate &candidate, const Deviation &found) {
    candidate.cost = std::max(candidate.cost, found.distance());
    candidate.recent_cost = std::max(candidate.recent_cost, found.distance());
    candidate.recent.take(found);
}

void PathDeviation::prune() {
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate &candidate : candidates_) {
        least = std::min(least, candidate.cost);
    }
    const double limit = bound(least, candidates_.front().piece);
    std::erase_if(candidates_, [limit](const Candidate &c) { return c.cost > limit; });
    if (candidates_.size() > MOST_CANDIDATES) {
        candidates_.resize(MOST_CANDIDATES);
    }
    pieces_.drop_before(candidates_.front().piece);
}

/// Decides the part of the assignment that all candidates have in common.
void PathDeviation::commit_common() {
    if (++steps_ % COMMIT_STEPS != 0) {
        return;
    }
    if (steps_ >= DECIDE_STEPS) {
        const std::size_t origin = best().origin;
        std::erase_if(candidates_, [origin](const Candidate &c) { return c.origin != origin; });
    }
    const std::size_t origin = candidates_.front().origin;
    if (!std::ranges::all_of(candidates_, [origin](const Candidate &c) { return c.origin == origin; })) {
        return;
    }
    committed_.take(candidates_.front().older);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        Candidate &candidate = candidates_[i];
        candidate.origin = i;
        candidate.older = candidate.recent;
        candidate.recent = {};
        candidate.cost = candidate.recent_cost;
        candidate.recent_cost = 0;
    }
    steps_ = 0;
}

void PathDeviation::commit(const Candidate &candidate) {
    committed_.take(candidate.older);
    committed_.take(candidate.recent);
}

void PathDeviation::complete() {
    flush();
    if (candidates_.empty() || !pieces_[candidates_.front().piece].isMeasured) {
        return;
    }
    const Step step{
        gcode::PieceShape({.start = last_.p, .end = last_.p, .centre = {}, .normal = {}}), {}, last_.time_ns};
    Candidate shortest;
    shortest.cost = std::numeric_limits<double>::infinity();
    for (Candidate candidate : candidates_) {
        while (true) {
            const bool isEnd = !pieces_.continues(candidate.piece);
            add_corner(candidate, corner_distance(candidate.piece, step, 0), last_.time_ns);
            if (isEnd) {
                break;
            }
            ++candidate.piece;
        }
        if (candidate.cost < shortest.cost) {
            shortest = candidate;
        }
    }
    commit(shortest);
    candidates_.clear();
}

Deviations PathDeviation::deviations() const {
    Deviations all = committed_;
    if (!candidates_.empty()) {
        all.take(best().older);
        all.take(best().recent);
    }
    return all;
}

}  // namespace mw::machine
