// SPDX-License-Identifier: GPL-2.0-or-later
// Prints a hash of every commanded pose of random programs per seed. A refactoring must not change it. In
// addition to the moves of traj_campaign, the programs have joints that are not axes, feed per revolution,
// threads, gates, single blocks, separate tolerances, events, and jerk limits that change from path to path.
// traj_fingerprint --first N --count M: one line per seed. Compare the output of two builds.
#include <cmath>
#include <cstdio>
#include <optional>

#include "base/options/command_line.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/sample_hash.hh"
#include "trajectory/test/turning_table.hh"

namespace mw::trajectory::test {
namespace {

JointLimits table_limits(Maker &maker) {
    JointLimits l;
    l.count = 4;
    for (std::size_t i = 0; i < 4; ++i) {
        l.velocity[i] = std::pow(10.0, maker.real(1.5, 2.7));
        l.acceleration[i] = std::pow(10.0, maker.real(2.5, 4));
        l.jerk[i] = l.acceleration[i] * std::pow(10.0, maker.real(1, 2));
    }
    l.low[0] = maker.chance(0.3) ? -maker.real(0, 20) : l.low[0];
    l.high[0] = maker.chance(0.3) ? maker.real(0, 20) : l.high[0];
    return l;
}

/// Adds feeds per revolution and gates at random moves of a program.
void vary(Maker &maker, Program &p) {
    bool isFirst = false;
    double per_revolution = 0;
    for (std::size_t i = 0; i < p.requests.size(); ++i) {
        MoveRequest &r = p.requests[i];
        if (maker.chance(0.08)) {
            const bool isSynched = maker.chance(0.5);
            per_revolution = isSynched ? maker.real(0.05, 2) : 0.0;
            isFirst = isSynched;
        }
        r.feed_per_revolution = per_revolution;
        r.isRapid = r.isRapid && !r.isSynched();
        r.isGated = isFirst || maker.chance(0.02);
        r.isPhased = isFirst;
        isFirst = false;
        r.isOverridable = !maker.chance(0.1);
        r.corner_scale = maker.chance(0.1) ? 0.5 : 1.0;
        r.tag.isProbe = maker.chance(0.01);
    }
}

struct Drive {
    Maker &maker;
    Rig &rig;
    Scales scales{};
    double turns = 0, rps = 0;
    bool isStepping = false;
    SampleHash hash{};

    void turn_spindle() {
        rps += maker.chance(0.002) ? maker.real(-1, 1) : 1e-4 * maker.real(-1, 1);
        rps = std::clamp(rps, -20.0, 20.0);
        turns += rps * Rig::T;
        rig.executor.set_spindle(0, turns);
        scales.spindle_rps[0] = rps;
        rig.planner.set_scales(scales);
    }
    void open_gates() {
        const Snapshot &now = rig.executor.snapshot();
        const Sequence gate = rig.planner.waiting_gate(now);
        if (gate == 0) {
            return;
        }
        rig.planner.open_gate(gate, rig.planner.isPhased(gate) ? maker.real(0, 0.05) : 0.0);
    }
    void step_blocks() {
        const Snapshot &now = rig.executor.snapshot();
        if (maker.chance(0.0005)) {
            isStepping = !isStepping;
            rig.planner.set_step(isStepping, rig.planner.next_block(now));
        }
        if (isStepping && (rig.planner.isAtStepStop(now) || maker.chance(0.001))) {
            rig.planner.set_step(true, rig.planner.next_block(now));
        }
    }
    void look() {
        const Snapshot &now = rig.executor.snapshot();
        hash.add(rig.executor.output().position);
        hash.add(rig.executor.output().velocity);
        hash.add(static_cast<double>(rig.planner.moves_left(now) + rig.planner.next_block(now)));
        hash.add((rig.planner.isStarving() ? 1.0 : 0.0) + (rig.planner.hasNext(now) ? 2.0 : 0.0) +
                 (rig.planner.take_trouble().isStuck ? 4.0 : 0.0) + (rig.planner.hasRoom() ? 8.0 : 0.0));
    }
    bool isOver() const {
        return rig.executor.isAtRest() && rig.executor.snapshot().done_move >= rig.planner.last_move();
    }
    /// Runs one path to its end, or until it is dropped or takes too long.
    bool run_path(const Program &program, int most_cycles) {
        std::size_t fed = 0;
        const int drop_at = maker.chance(0.2) ? maker.whole(100, 5000) : -1;
        bool isHeld = false;
        for (int n = 0; n < most_cycles; ++n) {
            const int batch = maker.chance(0.02) ? maker.whole(1, 30) : 0;
            for (int i = 0; i < batch && fed < program.primitives.size() && rig.planner.hasRoom();
                 ++i, ++fed) {
                rig.planner.add(program.primitives[fed], program.requests[fed]);
                if (maker.chance(0.01)) {
                    rig.planner.add_event({});
                }
            }
            if (fed == program.primitives.size() || maker.chance(0.001)) {
                rig.planner.release_end();
            }
            if (maker.chance(0.003)) {
                scales.feed = maker.real(0.05, 1.5);
                scales.rapid = maker.real(0.1, 1.0);
                scales.max_velocity = maker.chance(0.1) ? maker.real(1, 100) : UNLIMITED;
            }
            if (maker.chance(isHeld ? 0.02 : 0.001)) {
                isHeld = !isHeld;
                rig.executor.hold(isHeld);
            }
            turn_spindle();
            open_gates();
            step_blocks();
            if (n == drop_at) {
                rig.executor.drop();
            }
            rig.isPlannerAlive = !maker.chance(0.01);
            rig.step();
            while (rig.executor.due_event() != nullptr) {
                hash.add(static_cast<double>(n));
                rig.executor.drop_event();
            }
            look();
            if (fed == program.primitives.size() && isOver()) {
                rig.executor.hold(false);
                return true;
            }
            if (drop_at >= 0 && n > drop_at && rig.executor.isAtRest()) {
                break;
            }
        }
        rig.executor.hold(false);
        rig.executor.drop();
        for (int n = 0; n < 5000 && !rig.executor.isEmpty(); ++n) {
            rig.step();
            look();
        }
        return rig.executor.isEmpty();
    }
};

Primitive moved(const Primitive &p, const Pose &by) {
    Primitive q = p;
    q.start = p.start + by;
    q.end = p.end + by;
    q.base = p.base + by;
    return q;
}

void fingerprint(unsigned seed) {
    Maker maker(seed, seed % 3 != 0);
    const TurningTable table;
    Rig rig{Pose{}};
    // 2: a plan is made while the previous one waits for acceptance.
    rig.planner_period = seed % 6 == 0 ? 2 : 5;
    Drive drive{.maker = maker, .rig = rig, .scales = {}, .hash = {}};
    drive.rps = maker.real(-15, 15);
    int finished = 0;
    const int paths = maker.whole(1, 4);
    for (int path = 0; path < paths; ++path) {
        Program program = seed % 3 == 1 ? maker.make_curve() : maker.make_long(seed % 5 == 1, 3);
        vary(maker, program);
        const Pose from = rig.executor.output().position;
        for (Primitive &p : program.primitives) {
            p = moved(p, from);
        }
        rig.planner.set_limits(program.limits);
        rig.planner.set_joints(seed % 4 == 1 ? &table : nullptr, table_limits(maker));
        Pose low;
        Pose high;
        low.c.fill(maker.chance(0.5) ? -1.0 : -1e300);
        high.c.fill(1e300);
        rig.planner.set_room(low, high);
        rig.planner.begin(from, rig.executor.snapshot());
        finished += drive.run_path(program, 40000) ? 1 : 0;
    }
    std::printf("%u %d of %d paths, %llu cycles, %016llx\n", seed, finished, paths,
                static_cast<unsigned long long>(rig.cycle), drive.hash.value());
}

}  // namespace
}  // namespace mw::trajectory::test

int main(int argc, char **argv) {
    unsigned first = 1, count = 0;
    mw::options::CommandLine line("traj_fingerprint --first N --count M", "One line for each seed.\n");
    line.number("--first", "N", "seed to begin with (default 1)", first, 0, UINT32_MAX);
    line.number("--count", "M", "so many seeds", count, 1, UINT32_MAX);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || count == 0) {
        std::fprintf(stderr, "%s\n%s", parsed ? "--count is missing" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    for (unsigned seed = first; seed < first + count; ++seed) {
        mw::trajectory::test::fingerprint(seed);
    }
    return 0;
}
