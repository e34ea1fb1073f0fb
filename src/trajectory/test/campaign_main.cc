// SPDX-License-Identifier: GPL-2.0-or-later
// A campaign of random programs of at least 50 blocks and 5 s of motion each, in virtual time.
// traj_campaign --first N --count M --log FILE [--processes P]: the log has one line per seed. Seeds in it
// are not run again. The number before the verdict is a hash of every commanded bit. Exits with 1 if a
// program has exceeded its limits or its tolerance, or changed its order.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <optional>
#include <set>

#include "base/options/command_line.hh"
#include "base/text.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/sample_hash.hh"

namespace mw::trajectory::test {
namespace {

constexpr double SECONDS = 3, LEAST_SECONDS = 5;
constexpr std::size_t LEAST_BLOCKS = 50;

struct Verdict {
    std::size_t blocks = 0;
    double seconds = 0;
    unsigned long long samples = 0;  ///< SampleHash of all commanded poses
    std::string fault;
};

/// Follows the nearest points on the path, each not before the previous one. Success is sufficient proof. A
/// failure is checked again with isInOrder.
class Follower {
  public:
    Follower(const Program &program, double tolerance) : program_(program), tolerance_(tolerance) {}

    bool follow(const Pose &p) {
        const double moved = testing::pose_distance(p, last_);
        const double reach = 3.0 * moved + 2.0 * tolerance_;
        const int steps = std::clamp(static_cast<int>(2.0 * reach / tolerance_), 4, 64);
        std::size_t best_move = move_;
        double best_s = s_;
        double best = testing::pose_distance(p, position_at(program_.primitives[move_], s_));
        std::size_t m = move_;
        double s = s_;
        for (int i = 1; i <= steps; ++i) {
            s += reach / steps;
            while (m + 1 < program_.primitives.size() && s > program_.primitives[m].length) {
                s -= program_.primitives[m++].length;
            }
            const double off = testing::pose_distance(p, position_at(program_.primitives[m], s));
            if (off < best) {
                best = off;
                best_move = m;
                best_s = std::min(s, program_.primitives[m].length);
            }
        }
        bool isNear = best <= tolerance_ * 1.25;
        for (std::size_t k = move_; k < best_move; ++k) {
            const Pose &end = program_.primitives[k].end;
            isNear = isNear && std::min(testing::pose_distance(end, p), testing::pose_distance(end, last_)) <=
                                   tolerance_ * 1.25 + moved;
        }
        move_ = best_move;
        s_ = best_s;
        last_ = p;
        return isNear;
    }
    bool isAtEnd() const {
        return testing::pose_distance(last_, program_.primitives.back().end) <= tolerance_;
    }

  private:
    const Program &program_;
    double tolerance_;
    std::size_t move_ = 0;
    double s_ = 0;
    Pose last_;
};

Verdict judge(const Program &program, const Outcome &out, bool isDropped) {
    Verdict v;
    v.blocks = program.primitives.size();
    v.seconds = static_cast<double>(out.rig.samples.size()) * Rig::T;
    SampleHash hash;
    for (const Pose &p : out.rig.samples) {
        hash.add(p);
    }
    v.samples = hash.value();
    if (!out.isFinished) {
        v.fault = "not finished";
        return v;
    }
    auto checker = make_checker(program.limits, Rig::T);
    double longest_step = 0;
    const Pose *before = &out.rig.samples.front();
    for (const Pose &p : out.rig.samples) {
        checker.sample(p.c.data());
        longest_step = std::max(longest_step, testing::pose_distance(p, *before));
        before = &p;
    }
    if (!checker.isWithin()) {
        v.fault = "limits: " + checker.report().substr(0, checker.report().find('\n'));
        return v;
    }
    if (worst_excursion(out.rig.samples, program) > 1e-9) {
        v.fault = "soft limits";
        return v;
    }
    const double allowed = allowed_deviation(program);
    if (!isDropped && !(out.rig.samples.back() == program.primitives.back().end)) {
        v.fault = "not at its end";
    } else if (!isDropped && allowed > 0) {
        const double near = allowed + 0.5 * longest_step;
        Follower follower(program, near);
        bool isNear = true;
        for (const Pose &p : out.rig.samples) {
            isNear = isNear && follower.follow(p);
        }
        const bool isInTube =
            (isNear && follower.isAtEnd()) || isInOrder(out.rig.samples, program, near * 1.3 + 1e-9);
        v.fault = isInTube ? "" : "tolerance or order";
    }
    return v;
}

/// The program of a seed, made longer and slower until its motion takes LEAST_SECONDS.
Verdict drive_seed(unsigned seed) {
    const bool isJerkLimited = seed % 4 != 0;
    const bool isCurve = seed % 4 == 1;
    Verdict v;
    for (double seconds = SECONDS; seconds < 40; seconds *= 2) {
        Maker maker(seed, isJerkLimited);
        const Program program = maker.make_long(isCurve, seconds);
        const bool isDropped = maker.chance(0.05);
        Outcome out;
        drive(maker, program, out, isDropped);
        v = judge(program, out, isDropped);
        if (!v.fault.empty() || v.seconds >= LEAST_SECONDS || isDropped) {
            break;
        }
    }
    return v;
}

std::optional<unsigned> number_in(std::string_view text) {
    const auto number = parse_uint(text);
    return number.has_value() && *number < 0xffffffffU ? std::optional<unsigned>(*number) : std::nullopt;
}

std::set<unsigned> seeds_in(const char *name) {
    std::set<unsigned> seeds;
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
        if (const auto seed = number_in(line.substr(0, line.find(' ')))) {
            seeds.insert(*seed);
        }
    }
    return seeds;
}

struct Task {
    unsigned first = 1, count = 100, processes = 2;
    std::string log;
};

/// Runs every `processes`-th seed. Returns the number of failures.
int work(const Task &task, unsigned part, const std::set<unsigned> &done) {
    const int file = ::open(task.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) {
        std::perror(task.log.c_str());
        return 1;
    }
    int failed = 0;
    for (unsigned seed = task.first; seed < task.first + task.count; ++seed) {
        if (seed % task.processes != part || done.contains(seed)) {
            continue;
        }
        const Verdict v = drive_seed(seed);
        const bool isCounted = v.blocks >= LEAST_BLOCKS && v.seconds >= LEAST_SECONDS;
        char line[400];
        const int size = std::snprintf(line, sizeof line, "%u %zu blocks %.2f s %016llx %s%s\n", seed,
                                       v.blocks, v.seconds, v.samples,
                                       !v.fault.empty() ? "FAILED "
                                       : isCounted      ? "ok"
                                                        : "short",
                                       v.fault.c_str());
        failed += v.fault.empty() ? 0 : 1;
        if (::write(file, line, static_cast<std::size_t>(size)) != size) {
            std::perror(task.log.c_str());
            return 1;
        }
    }
    ::close(file);
    return failed;
}

int run(const Task &task) {
    const std::set<unsigned> done = seeds_in(task.log.c_str());
    std::vector<pid_t> children;
    for (unsigned part = 0; part < task.processes; ++part) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::_exit(work(task, part, done) == 0 ? 0 : 1);
        }
        children.push_back(child);
    }
    bool isSound = true;
    for (const pid_t child : children) {
        int status = 0;
        isSound =
            ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 && isSound;
    }
    return isSound ? 0 : 1;
}

}  // namespace
}  // namespace mw::trajectory::test

int main(int argc, char **argv) {
    mw::trajectory::test::Task task;
    mw::options::CommandLine line(
        "traj_campaign --first N --count M --log FILE [--processes P]",
        "One line for each seed in the log; seeds that it has are not driven again.\n");
    line.number("--first", "N", "seed to begin with (default 1)", task.first, 0, UINT32_MAX - 1);
    line.number("--count", "M", "so many seeds (default 100)", task.count, 0, UINT32_MAX - 1);
    line.text("--log", "FILE", "where the verdicts go", task.log);
    line.number("--processes", "P", "at a time (default 2)", task.processes, 1, 1024);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || task.log.empty()) {
        std::fprintf(stderr, "%s\n%s", parsed ? "--log is missing" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    return mw::trajectory::test::run(task);
}
