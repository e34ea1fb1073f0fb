// SPDX-License-Identifier: GPL-2.0-or-later
// The tests' own judgement of a trace (tests/support/limit_checker.hh, tests/support/deviation.hh), to
// compare with that of tools/trajcheck.py: traj_verdict KIND TRACE.csv [--jerk]. Prints the worst velocity,
// acceleration and jerk over their limits, the deviation, and the verdict.
#include <cstdio>
#include <vector>

#include "base/options/command_line.hh"
#include "tests/support/deviation.hh"
#include "tests/support/limit_checker.hh"
#include "traj/kinds.hh"

namespace mw::bench {
namespace {

struct Trace {
    double period_s = 0;
    std::vector<Pose> rows;
};

bool read_trace(const char *path, Trace &trace) {
    std::FILE *file = std::fopen(path, "r");
    if (file == nullptr) {
        std::perror(path);
        return false;
    }
    double tolerance = 0;
    bool isOk = std::fscanf(file, "# period_s=%lf tolerance=%lf", &trace.period_s, &tolerance) == 2;
    Pose p;
    while (isOk && std::fscanf(file, "%lf", &p[0]) == 1) {
        for (int i = 1; i < geometry::AXIS_COUNT && isOk; ++i) {
            isOk = std::fscanf(file, ",%lf", &p[i]) == 1;
        }
        trace.rows.push_back(p);
    }
    std::fclose(file);
    if (!isOk || trace.rows.size() < 2) {
        std::fprintf(stderr, "%s: not a trace of nine coordinates\n", path);
    }
    return isOk && trace.rows.size() >= 2;
}

bool judge(const Program &program, const Trace &trace, bool isJerkLimited) {
    std::vector<testing::AxisLimit> limits;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        limits.push_back({program.max_velocity[i], program.max_acceleration[i],
                          isJerkLimited ? program.max_jerk[i] : 1e300});
    }
    testing::LimitChecker checker(limits, trace.period_s);
    for (const Pose &p : trace.rows) {
        checker.sample(p.c.data());
    }
    const bool isBlend = program.moves[0].control == geometry::PathMode::BLEND;
    const double tolerance = isBlend ? program.tolerance : 1e-6;
    const double step = isBlend ? program.tolerance / 8 : 2e-3;
    const double deviation =
        testing::deviation_in_order(trace.rows, sample_path(program, step), step, 10 * program.tolerance);
    const bool isOk =
        checker.isWithin() && trace.rows.back() == program.moves.back().end && deviation <= tolerance + step;
    std::printf("%.9f %.9f %.9f %.6f %s\n", checker.worst_velocity(), checker.worst_acceleration(),
                checker.worst_jerk(), deviation, isOk ? "ok" : "beyond");
    return isOk;
}

}  // namespace
}  // namespace mw::bench

int main(int argc, char **argv) {
    bool isJerkLimited = false;
    mw::options::Words words;
    mw::options::CommandLine line("traj_verdict KIND TRACE.csv [--jerk]",
                                  "The tests' own judgement of a trace.\n");
    line.flag("--jerk", "with jerk limits", isJerkLimited);
    line.rest(words);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || words.size() != 2) {
        std::fprintf(stderr, "%s\n%s",
                     parsed ? "a kind and a trace are needed" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    mw::bench::Trace trace;
    if (!mw::bench::read_trace(words[1].c_str(), trace)) {
        return 2;
    }
    for (const mw::bench::Program &program : mw::bench::all_kinds()) {
        if (program.name == words[0]) {
            return mw::bench::judge(program, trace, isJerkLimited) ? 0 : 1;
        }
    }
    std::fprintf(stderr, "traj_verdict: there is no kind '%s'\n", words[0].c_str());
    return 2;
}
