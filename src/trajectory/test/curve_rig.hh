// SPDX-License-Identifier: GPL-2.0-or-later
// Curves of programs whose path mode changes. Profiles plan them from stop to stop while more of the curve
// becomes known.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/profile/profile.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::test {

inline constexpr double CURVE_PERIOD_S = profile::T;

/// A curve with its feeds, caps and stops.
struct LaidCurve {
    std::vector<curve::Span> spans;
    std::vector<profile::FeedLimit> feeds;
    std::vector<profile::SpeedCap> caps;
    std::vector<double> stops;
    double worst_deviation = 0;      ///< maximum deviation of fitted parts, divided by their tolerance
    std::vector<std::size_t> exact;  ///< numbers of the moves that are followed exactly
    std::vector<double> starts;      ///< s at the start of each move
};

class CurveLayer {
  public:
    /// `map` may be null.
    CurveLayer(const Program &program, const profile::CurveLimits &limits, const JointMap *map = nullptr,
               const JointLimits &joints = {})
        : program_(program), limits_(limits), map_(map), joints_(joints) {}

    LaidCurve lay() {
        const std::size_t n = program_.primitives.size();
        for (std::size_t k = 0; k < n;) {
            const bool is_exact = isExact(k);
            std::size_t end = k;
            while (end < n && isExact(end) == is_exact) {
                ++end;
            }
            is_exact ? lay_exact(k, end) : lay_blend(k, end);
            k = end;
        }
        out_.stops.push_back(end_s());
        return std::move(out_);
    }

  private:
    bool isExact(std::size_t k) const {
        return program_.requests[k].join != geometry::PathMode::BLEND ||
               !(program_.requests[k].tolerance > 0);
    }
    double end_s() const { return out_.spans.empty() ? 0.0 : out_.spans.back().end_s(); }

    void add_move(std::size_t k) {
        const Primitive &p = program_.primitives[k];
        const MoveRequest &r = program_.requests[k];
        const bool is_rapid = r.isRapid || !(r.tag.requested_velocity > 0);
        out_.starts.push_back(next_s_);
        next_s_ += p.length;
        out_.feeds.push_back({next_s_,
                              is_rapid ? 1e300 : r.tag.requested_velocity * p.length / feed_length(p).length,
                              profile::FeedLimit::Along::LENGTH});
    }

    void lay_blend(std::size_t from, std::size_t to) {
        curve::CurveBuilder builder(3.0);
        builder.begin(end_s());
        next_s_ = end_s();
        for (std::size_t k = from; k < to; ++k) {
            builder.add(program_.primitives[k], program_.requests[k].tolerance);
            add_move(k);
        }
        builder.extend(true);
        out_.worst_deviation = std::max(out_.worst_deviation, builder.worst_deviation());
        append(builder.spans(), {});
    }

    void lay_exact(std::size_t from, std::size_t to) {
        curve::ExactBuilder builder(3.0);
        builder.begin(end_s());
        next_s_ = end_s();
        for (std::size_t k = from; k < to; ++k) {
            out_.exact.push_back(k);
            add_move(k);
            builder.add(program_.primitives[k]);
        }
        append(builder.spans(), builder.seams(), from);
    }

    void append(const std::vector<curve::Span> &spans, const std::vector<curve::Seam> &seams,
                std::size_t move = 0) {
        if (!out_.spans.empty()) {
            take_seam(curve::seam_between(out_.spans.back(), spans.front()),
                      out_.exact.size() > 0 && out_.exact.back() + 1 == move);
        }
        for (std::size_t i = 0; i < seams.size(); ++i) {
            take_seam(seams[i], program_.requests[move + i].join == geometry::PathMode::EXACT_STOP);
        }
        out_.spans.insert(out_.spans.end(), spans.begin(), spans.end());
    }

    void take_seam(const curve::Seam &seam, bool is_stop) {
        const profile::SpeedCap cap = profile::cap_of(seam, limits_, map_, joints_, CURVE_PERIOD_S);
        if (cap.is_stop || is_stop) {
            out_.stops.push_back(cap.s);
        } else if (isNeeded(cap, limits_, joints_)) {
            out_.caps.push_back(cap);
        }
    }

    const Program &program_;
    const profile::CurveLimits &limits_;
    const JointMap *map_;
    JointLimits joints_;
    LaidCurve out_;
    double next_s_ = 0;
};

struct DrivenCurve {
    std::vector<double> places;  ///< s of each sample
    std::vector<Pose> samples;
    double time_s = 0, worst_start = 0, shortest_cell_s = 1e300;
    bool is_done = false;
};

/// Plans a curve that becomes known in parts.
class CurveDriver {
  public:
    CurveDriver(const LaidCurve &laid, const profile::CurveLimits &limits) : laid_(laid) {
        run_.limits = limits;
        run_.spans = &spans_;
        run_.feeds = &laid.feeds;
        run_.caps = &caps_;
    }
    profile::Run &run() { return run_; }
    /// Stops after this number of plans, before the end of the program.
    void stop_after(int plans, profile::StopEffort effort) {
        plans_left_ = plans;
        effort_ = effort;
    }

    DrivenCurve drive() {
        out_.is_done = true;
        for (std::size_t k = 0; k < laid_.stops.size() && plans_left_ > 0; ++k) {
            out_.is_done = drive_to(end_s_, laid_.stops[k]) && out_.is_done;
        }
        out_.places.insert(out_.places.end(), 3, end_s_);
        for (const double s : out_.places) {
            out_.samples.push_back(curve::position_at(laid_.spans[profile::span_at(laid_.spans, s)], s));
        }
        return std::move(out_);
    }

  private:
    /// Time of motion that is known at first, if the curve is long enough [s].
    static constexpr double KNOWN_S = 0.5;

    /// Makes the next `count` spans known, with their caps, but not past the stop.
    void show(double stop, std::size_t count) {
        while (count > 0 && shown_ < laid_.spans.size() && laid_.spans[shown_].start_s < stop - 1e-12) {
            spans_.push_back(laid_.spans[shown_++]);
            --count;
        }
        run_.has_stop = shown_ == laid_.spans.size() || laid_.spans[shown_].start_s >= stop - 1e-12;
        run_.end_s = run_.has_stop ? stop : spans_.back().end_s();
        while (cap_ < laid_.caps.size() && laid_.caps[cap_].s < run_.end_s - 1e-12) {
            caps_.push_back(laid_.caps[cap_++]);
        }
    }

    bool drive_to(double from, double stop) {
        constexpr std::size_t LEAST_CELLS = 8;
        profile::Profile profile({0.5, CURVE_PERIOD_S});
        profile.begin(from);
        show(stop, 40);
        for (int n = 0; n < 20000; ++n) {
            show(stop, 7);
            profile.plan(run_, 0);
            if (--plans_left_ == 0) {
                take_stop(profile);
                return true;
            }
            const std::size_t cells = profile.cells();
            const std::size_t last = profile.isComplete() ? cells : cells - std::min(cells, LEAST_CELLS);
            std::size_t k = 0;
            for (double t = 0; k < last && t < 0.05; ++k) {
                take(profile.cell(k));
                t += profile.cell(k).duration;
            }
            profile.drop(k);
            out_.worst_start = std::max({out_.worst_start, profile.worst_start(), profile.worst_rejected()});
            if (profile.isComplete() && k == cells) {
                end_s_ = stop;
                return true;
            }
        }
        return false;
    }

    void take_stop(profile::Profile &profile) {
        const profile::Stop stop = profile.stop(run_, 0, effort_);
        for (std::size_t k = 0; k < stop.kept; ++k) {
            take(profile.cell(k));
        }
        std::for_each(stop.cells.begin(), stop.cells.end(), [&](const profile::TimeCell &c) { take(c); });
        end_s_ = stop.end_s;
    }

    void take(const profile::TimeCell &cell) {
        for (double t = CURVE_PERIOD_S * static_cast<double>(out_.places.size()) - out_.time_s;
             t <= cell.duration; t = CURVE_PERIOD_S * static_cast<double>(out_.places.size()) - out_.time_s) {
            out_.places.push_back(cell.s_at(std::max(t, 0.0)));
        }
        out_.time_s += cell.duration;
        out_.shortest_cell_s = std::min(out_.shortest_cell_s, cell.duration);
    }

    const LaidCurve &laid_;
    std::vector<curve::Span> spans_;
    std::vector<profile::SpeedCap> caps_;
    std::size_t shown_ = 0, cap_ = 0;
    int plans_left_ = 1 << 30;
    profile::StopEffort effort_ = profile::StopEffort::QUICK;
    double end_s_ = 0;
    profile::Run run_;
    DrivenCurve out_;
};

}  // namespace mw::trajectory::test
