// SPDX-License-Identifier: GPL-2.0-or-later
// Costs of a servo cycle of the controller, and of planning dense programs.
#include <cmath>

#include <benchmark/benchmark.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

/// One servo cycle of three joints, at standstill and on one long line.
void BM_servo_cycle(benchmark::State &state) {
    testing::MotionRig rig;
    rig.ready();
    geometry::Pose end;
    end[0] = 900;
    end[1] = 500;
    Outputs &out = *rig.out;
    if (state.range(0) != 0) {
        rig.line(end, 0.01);
        rig.send_path(Flush{});
        rig.step(200);
    }
    std::int64_t n = 0;
    for (auto _ : state) {
        rig.controller->handle_commands(rig.in);
        rig.controller->step(rig.in, out);
        if (++n % 5 == 0) {
            state.PauseTiming();
            rig.planner->update();
            state.ResumeTiming();
        }
        benchmark::DoNotOptimize(out);
    }
}
BENCHMARK(BM_servo_cycle)->Arg(0)->Arg(1);

/// A surface of short lines at about 5000 blocks per second of virtual time. Measures the whole cost per
/// virtual second.
void BM_dense_program(benchmark::State &state) {
    for (auto _ : state) {
        state.PauseTiming();
        testing::MotionRig rig("XYZ", 500, 5000);
        rig.ready();
        state.ResumeTiming();
        const int blocks = 20000;
        int sent = 0;
        CommandId flush = 0;
        const std::uint64_t start = rig.cycle;
        while (flush == 0 || !rig.isDone(flush)) {
            rig.answers.clear();
            while (sent < blocks && rig.channels->path.size() < 2000) {
                ++sent;
                geometry::Pose p;
                p[0] = 0.05 * sent;
                p[2] = 0.5 * std::sin(0.02 * sent);
                rig.line(p, 250, PathMode::BLEND, 0.01);
            }
            if (sent == blocks && flush == 0) {
                flush = rig.send_path(Flush{});
            }
            rig.step();
        }
        const double seconds = static_cast<double>(rig.cycle - start) * 1e-3;
        state.counters["blocks/virtual_s"] = blocks / seconds;
        state.counters["virtual_s"] = seconds;
    }
}
BENCHMARK(BM_dense_program)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mw::motion
