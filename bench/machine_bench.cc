// SPDX-License-Identifier: GPL-2.0-or-later
// Speed of a whole three-axis machine in virtual time, as a multiple of real time (1 ms servo, no trace, one
// core).
#include <cstdio>
#include <cstdlib>

#include <benchmark/benchmark.h>

#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "programs/run/run_session.hh"

namespace {

void run_program(benchmark::State &state, const char *ini, const char *program) {
    ::setenv("MILLWRIGHT_MODULE_PATH", MW_LIB_DIR, 0);
    double virtual_s = 0;
    for (auto _ : state) {
        state.PauseTiming();
        mw::diagnostics::Sink sink;
        const auto loaded = mw::machine::LoadedConfig::load(std::string(MW_SOURCE_DIR "/") + ini, sink);
        if (loaded == nullptr) {
            state.SkipWithError("the configuration has errors");
            return;
        }
        loaded->machine.task.parameter_file.clear();
        const mw::machine::MachineParts parts{loaded->ini, loaded->reader, loaded->machine, sink};
        auto machine = mw::machine::make_virtual_machine(parts, {});
        if (!machine.has_value()) {
            state.SkipWithError(machine.error().message.c_str());
            return;
        }
        mw::programs::OwnMachine own(**machine);
        mw::programs::RunSession person(own, loaded->machine, sink, {});
        auto status = person.switch_on();
        status = status.has_value() ? person.home_all() : status;
        status = status.has_value() ? person.open_program(program) : status;
        const std::int64_t start_ns = (*machine)->now_ns();
        state.ResumeTiming();
        status = status.has_value() ? person.run_program(1, [] {}) : status;
        state.PauseTiming();
        virtual_s += static_cast<double>((*machine)->now_ns() - start_ns) * 1e-9;
        person.switch_off();
        machine->reset();
        state.ResumeTiming();
        if (!status.has_value()) {
            state.SkipWithError(status.error().message.c_str());
            return;
        }
    }
    state.counters["virtual_s"] = benchmark::Counter(virtual_s, benchmark::Counter::kAvgIterations);
    state.counters["times_faster"] = benchmark::Counter(virtual_s, benchmark::Counter::kIsRate);
}

void BM_Pocket(benchmark::State &state) {
    run_program(state, "configs/sim/mill_mm.ini", MW_SOURCE_DIR "/nc_files/pocket.ngc");
}
BENCHMARK(BM_Pocket)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(5);

void BM_Surface(benchmark::State &state) {
    run_program(state, "configs/sim/mill_mm.ini", MW_SURFACE_PROGRAM);
}
BENCHMARK(BM_Surface)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);

void BM_Drilling(benchmark::State &state) {
    run_program(state, "configs/sim/mill_mm.ini", MW_SOURCE_DIR "/nc_files/drilling.ngc");
}
BENCHMARK(BM_Drilling)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(5);

}  // namespace
