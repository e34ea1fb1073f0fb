// SPDX-License-Identifier: GPL-2.0-or-later
// The time of HAL itself in a period of the virtual clock. It limits the speed of a simulation: 200 times
// realtime at a period of 1 ms leaves 5 us for all work.
#include <string>

#include <benchmark/benchmark.h>

#include "hal/core/instance.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal {
namespace {

void nothing(void * /*argument*/, long /*period_ns*/) {}

/// Argument: functions in the thread.
void BM_VirtualPeriod(benchmark::State &state) {
    runtime::VirtualScheduler clock;
    InstanceOptions options;
    options.scheduler = &clock;
    auto hal = Instance::create(options).value();
    const int comp = *hal->components().create("bench", CompType::REALTIME);
    (void)hal->threads().create("t", 1'000'000);
    for (int i = 0; i < state.range(0); ++i) {
        const std::string name = "f" + std::to_string(i);
        (void)hal->functions().create(name, {&nothing, nullptr}, comp);
        (void)hal->threads().add_function(name, "t");
    }
    (void)hal->threads().start();
    for (auto _ : state) {
        clock.step();
    }
}
BENCHMARK(BM_VirtualPeriod)->Arg(0)->Arg(10)->Arg(50);

void BM_SetAndGetByName(benchmark::State &state) {
    runtime::VirtualScheduler clock;
    InstanceOptions options;
    options.scheduler = &clock;
    auto hal = Instance::create(options).value();
    const int comp = *hal->components().create("bench");
    for (int i = 0; i < 2000; ++i) {
        (void)hal->pins().create("bench.pin-" + std::to_string(i), Type::FLOAT, Dir::IN, comp);
    }
    for (auto _ : state) {
        (void)hal->values().set("bench.pin-1000", Value::of_float(1.0));
        benchmark::DoNotOptimize(hal->values().get("bench.pin-1000"));
    }
}
BENCHMARK(BM_SetAndGetByName);

}  // namespace
}  // namespace mw::hal
