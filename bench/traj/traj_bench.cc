// SPDX-License-Identifier: GPL-2.0-or-later
// Runs each type of program with the planner in virtual time: cycle time, limits, deviation, planning rate.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "base/options/command_line.hh"
#include "tests/support/deviation.hh"
#include "tests/support/limit_checker.hh"
#include "traj/bound.hh"
#include "traj/jerk_bound.hh"
#include "traj/kinds.hh"
#include "trajectory/curve/curve_builder.hh"
#include "trajectory/curve/exact_builder.hh"
#include "trajectory/follow/executor.hh"
#include "trajectory/planner.hh"
#include "trajectory/profile/acceleration_profile.hh"
#include "trajectory/profile/profile.hh"

namespace mw::bench {
namespace {

namespace curve = trajectory::curve;
namespace profile = trajectory::profile;

constexpr double T = 1e-3;

struct Options {
    bool isJerkLimited = false;
    bool isFast = false;
    bool isRate = false;
    bool isBound = false;
    bool third_order = false;
    bool second_order = false;
    std::string trace, only;
    double jerk_share = 1;  ///< fraction of the jerk limits of all programs

    options::CommandLine line() {
        options::CommandLine line("traj_bench [options]",
                                  "Drives each kind of program with the planner in virtual time.\n");
        line.flag("--jerk", "with jerk limits", isJerkLimited);
        line.flag("--fast", "leave the deviation out", isFast);
        line.flag("--third-order", "with the third-order profile instead of the planner", third_order);
        line.flag("--second-order", "with the profile within velocity and acceleration instead",
                  second_order);
        line.flag("--bound", "the bound beside each", isBound);
        line.flag("--rate", "planning alone, on 0.01 mm blocks in nine coordinates", isRate);
        line.text("--trace", "FOLDER", "write the samples of each kind there", trace);
        line.text("--only", "WORD", "the kinds with this in their name", only);
        line.number("--jerk-share", "PART", "this part of the jerk limits (default 1)", jerk_share, 1e-6,
                    1e6);
        return line;
    }
};

trajectory::Primitive primitive_of(const Pose &from, const Move &m) {
    if (!m.isArc) {
        return trajectory::make_line(from, m.end);
    }
    trajectory::Primitive p;
    trajectory::make_arc(from, m.end, {m.centre, m.normal, m.angle_rad, false}, p);
    return p;
}

trajectory::MoveRequest request_of(const Program &program, const Move &m) {
    trajectory::MoveRequest r;
    r.tag.requested_velocity = m.feed;
    r.isRapid = m.feed == 0;
    r.tolerance = program.tolerance;
    r.join = m.control;
    return r;
}

trajectory::Limits limits_of(const Program &program, bool isJerkLimited) {
    trajectory::Limits l;
    l.velocity.fill(trajectory::UNLIMITED);
    l.acceleration.fill(trajectory::UNLIMITED);
    l.jerk.fill(trajectory::UNLIMITED);
    l.isJerkLimited = isJerkLimited;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        l.velocity[static_cast<std::size_t>(i)] = program.max_velocity[i];
        l.acceleration[static_cast<std::size_t>(i)] = program.max_acceleration[i];
        l.jerk[static_cast<std::size_t>(i)] = program.max_jerk[i];
    }
    return l;
}

struct Run {
    std::vector<Pose> samples;
    double planning_s = 0;
    bool isFinished = false;
};

/// The planner receives as much of the program as its queue can hold.
Run drive(const Program &program, bool isJerkLimited) {
    Run run;
    auto store = std::make_unique<trajectory::PathStore>();
    trajectory::Executor executor(*store, T);
    auto planner = std::make_unique<trajectory::Planner>(*store, trajectory::PlannerSettings{T});
    planner->set_limits(limits_of(program, isJerkLimited));
    executor.set_position(program.start);
    std::uint64_t cycle = 0;
    executor.step(cycle);
    planner->begin(program.start, executor.snapshot());
    run.samples.push_back(program.start);
    std::size_t fed = 0;
    for (int n = 0; n < 2000000 && !run.isFinished; ++n) {
        if (n % 5 == 0) {
            const auto begin = std::chrono::steady_clock::now();
            for (; fed < program.moves.size() && planner->hasRoom(); ++fed) {
                const Pose from = fed == 0 ? program.start : program.moves[fed - 1].end;
                planner->add(primitive_of(from, program.moves[fed]), request_of(program, program.moves[fed]));
            }
            if (fed == program.moves.size()) {
                planner->release_end();
            }
            planner->update(executor.snapshot());
            run.planning_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        }
        run.samples.push_back(executor.step(++cycle).position);
        run.isFinished = fed == program.moves.size() && executor.isAtRest() &&
                         executor.snapshot().done_move >= planner->last_move();
    }
    return run;
}

profile::CurveLimits curve_limits_of(const Program &program, bool isJerkLimited) {
    profile::CurveLimits limits;
    limits.has_jerk = isJerkLimited;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        limits.axes[static_cast<std::size_t>(i)] = {program.max_velocity[i], program.max_acceleration[i],
                                                    program.max_jerk[i]};
    }
    return limits;
}

constexpr double WIDEST = 3.0;

/// A curve, its limits, and the positions of its stops.
struct Laid {
    std::vector<curve::Span> spans;
    std::vector<profile::FeedLimit> feeds;
    std::vector<profile::SpeedCap> caps;
    std::vector<double> stops;
};

/// The whole program on one curve.
Laid lay_blend(const Program &program) {
    constexpr double OPEN = 30.0;
    Laid out;
    curve::CurveBuilder builder(WIDEST);
    Pose from = program.start;
    double length = 0;
    for (const Move &m : program.moves) {
        const trajectory::Primitive p = primitive_of(from, m);
        builder.add(p, program.tolerance);
        length += p.length;
        out.feeds.push_back({length, m.feed > 0 ? m.feed : 1e300});
        from = m.end;
        if (builder.programmed_length() - builder.final_s() > OPEN) {
            builder.extend(false);
        }
    }
    builder.extend(true);
    out.spans = builder.spans();
    out.stops.push_back(builder.final_s());
    return out;
}

/// The programmed path with stops at tangent discontinuities, or at the end of each move.
Laid lay_exact(const Program &program, bool isJerkLimited) {
    Laid out;
    curve::ExactBuilder builder(WIDEST);
    Pose from = program.start;
    for (const Move &m : program.moves) {
        builder.add(primitive_of(from, m));
        out.feeds.push_back({builder.final_s(), m.feed > 0 ? m.feed : 1e300});
        from = m.end;
    }
    const profile::CurveLimits limits = curve_limits_of(program, isJerkLimited);
    const bool is_stop = program.moves[0].control == geometry::PathMode::EXACT_STOP;
    for (const curve::Seam &seam : builder.seams()) {
        const profile::SpeedCap cap = profile::cap_of(seam, limits, T);
        if (is_stop || cap.is_stop) {
            out.stops.push_back(cap.s);
        } else if (isNeeded(cap, limits)) {
            out.caps.push_back(cap);
        }
    }
    out.spans = builder.spans();
    out.stops.push_back(builder.final_s());
    return out;
}

/// Planned in windows of 0.5 s every 50 ms. False if the end was not reached.
bool drive_run(profile::PathTiming &profile, const profile::Run &run, double from_s,
               std::vector<profile::TimeCell> &cells) {
    constexpr double COMMIT_S = 0.05;
    constexpr std::size_t LEAST_CELLS = 8;  // behind what is passed on
    profile.begin(from_s);
    bool is_done = false;
    for (int n = 0; n < 100000 && !is_done; ++n) {
        profile.plan(run, 0);
        const std::size_t last = profile.isComplete() ? profile.cells() : profile.cells() - LEAST_CELLS;
        std::size_t k = 0;
        for (double t = 0; k < last && t < COMMIT_S; ++k) {
            cells.push_back(profile.cell(k));
            t += profile.cell(k).duration;
        }
        is_done = profile.isComplete() && k == profile.cells();
        profile.drop(k);
    }
    return is_done;
}

/// Includes the time of fitting and planning.
Run drive_curve(const Program &program, profile::PathTiming &profile, bool isJerkLimited) {
    Run out;
    const auto begin = std::chrono::steady_clock::now();
    const bool is_blend = program.moves[0].control == geometry::PathMode::BLEND;
    const Laid laid = is_blend ? lay_blend(program) : lay_exact(program, isJerkLimited);
    profile::Run run{&laid.spans, &laid.feeds, curve_limits_of(program, isJerkLimited)};
    run.caps = &laid.caps;
    run.has_stop = true;
    out.isFinished = true;
    std::vector<profile::TimeCell> cells;
    double from_s = 0;
    for (const double stop : laid.stops) {
        run.end_s = stop;
        out.isFinished = drive_run(profile, run, from_s, cells) && out.isFinished;
        from_s = stop;
    }
    out.planning_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    out.samples.push_back(program.start);
    std::size_t span = 0;
    double cell_start = 0;
    for (const profile::TimeCell &cell : cells) {
        for (double t = T * static_cast<double>(out.samples.size()) - cell_start; t <= cell.duration;
             t += T) {
            const double s = cell.s_at(t);
            while (span + 1 < laid.spans.size() && s >= laid.spans[span].end_s()) {
                ++span;
            }
            out.samples.push_back(curve::position_at(laid.spans[span], s));
        }
        cell_start += cell.duration;
    }
    out.samples.insert(out.samples.end(), 3, program.moves.back().end);
    return out;
}

/// Time [s] from the first to the last sample with motion.
double cycle_time(const std::vector<Pose> &samples) {
    std::size_t first = 0;
    while (first + 1 < samples.size() && samples[first + 1] == samples[0]) {
        ++first;
    }
    std::size_t last = samples.size() - 1;
    while (last > first && samples[last - 1] == samples.back()) {
        --last;
    }
    return static_cast<double>(last - first) * T;
}

void write_trace(const Options &options, const Program &program, const Run &run) {
    std::string name = options.trace + "/" + program.name + ".csv";
    std::replace(name.begin(), name.end(), ' ', '_');
    std::FILE *file = std::fopen(name.c_str(), "w");
    if (file == nullptr) {
        std::perror(name.c_str());
        return;
    }
    std::fprintf(file, "# period_s=%g tolerance=%g\n", T, program.tolerance);
    for (const Pose &p : run.samples) {
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            std::fprintf(file, "%s%.17g", i == 0 ? "" : ",", p[i]);
        }
        std::fputc('\n', file);
    }
    std::fclose(file);
}

std::vector<testing::AxisLimit> axis_limits(const Program &program, bool isJerkLimited) {
    std::vector<testing::AxisLimit> limits;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        limits.push_back({program.max_velocity[i], program.max_acceleration[i],
                          isJerkLimited ? program.max_jerk[i] : 1e300});
    }
    return limits;
}

/// Time divided by the best known time. Limits and deviation of the comparison trajectory are checked in the
/// same way.
void print_bound(const Options &options, const Program &program, double time_s) {
    if (!options.isJerkLimited) {
        const double best = best_known_time(program);
        std::printf("%-18s best known with acceleration limits %8.3f s, ratio %6.3f\n", "", best,
                    time_s / best);
        return;
    }
    const Trajectory best = best_known_trajectory(program);
    testing::LimitChecker checker(axis_limits(program, true), best.period_s);
    for (const Pose &p : best.samples) {
        checker.sample(p.c.data());
    }
    const double step = program.tolerance / 16;
    const double deviation = options.isFast
                                 ? 0.0
                                 : testing::deviation_in_order(best.samples, sample_path(program, step), step,
                                                               10 * program.tolerance);
    std::printf("%-18s best known with jerk limits %8.3f s%s, deviation %.4f, ratio %6.3f\n", "", best.time_s,
                checker.isWithin() ? "" : " BEYOND LIMITS", deviation, time_s / best.time_s);
    std::printf("%.200s", checker.report().c_str());
}

bool measure(const Options &options, const Program &program) {
    profile::Profile third_order({});
    profile::AccelerationProfile second_order(0.5, T);
    const Run run = options.third_order    ? drive_curve(program, third_order, true)
                    : options.second_order ? drive_curve(program, second_order, false)
                                           : drive(program, options.isJerkLimited);
    testing::LimitChecker checker(axis_limits(program, options.isJerkLimited), T);
    for (const Pose &p : run.samples) {
        checker.sample(p.c.data());
    }
    const bool isAtEnd = run.samples.back() == program.moves.back().end;
    const bool isBlend = program.moves[0].control == geometry::PathMode::BLEND;
    const double step = isBlend ? program.tolerance / 16 : 1e-3;
    const double deviation = options.isFast
                                 ? 0.0
                                 : testing::deviation_in_order(run.samples, sample_path(program, step), step,
                                                               10 * program.tolerance);
    const bool isOk =
        run.isFinished && isAtEnd && checker.isWithin() && deviation <= program.tolerance + step;
    std::printf("%-18s %6zu %8.3f s  %5.3f %5.3f %5.3f  %7.4f/%.2f  %9.0f  %s\n", program.name.c_str(),
                program.moves.size(), cycle_time(run.samples), checker.worst_velocity(),
                checker.worst_acceleration(), checker.worst_jerk(), deviation, program.tolerance,
                static_cast<double>(program.moves.size()) / run.planning_s, isOk ? "ok" : "FAILED");
    if (options.isBound) {
        print_bound(options, program, cycle_time(run.samples));
    }
    if (!isOk) {
        std::printf("%.400s", checker.report().c_str());
    }
    if (!options.trace.empty()) {
        write_trace(options, program, run);
    }
    return isOk;
}

}  // namespace
}  // namespace mw::bench

int main(int argc, char **argv) {
    mw::bench::Options options;
    if (const auto parsed = options.line().parse({argv + 1, argv + argc}); !parsed) {
        std::fprintf(stderr, "%s\n%s", parsed.error().str().c_str(), options.line().help().c_str());
        return 2;
    }
    options.isFast = options.isFast || options.isRate;
    options.isJerkLimited = options.isJerkLimited || options.third_order;
    std::printf("%-18s %6s %10s  %17s  %12s  %9s\n", "kind", "blocks", "time", "worst v a j", "deviation",
                "blocks/s");
    bool isOk = true;
    if (options.isRate) {
        return mw::bench::measure(options, mw::bench::dense_nine_axes(100000)) ? 0 : 1;
    }
    for (mw::bench::Program program : mw::bench::all_kinds()) {
        program.max_jerk = program.max_jerk * options.jerk_share;
        if (program.name.find(options.only) != std::string::npos) {
            isOk = mw::bench::measure(options, program) && isOk;
        }
    }
    return isOk ? 0 : 1;
}
