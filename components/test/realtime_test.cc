// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "components/test/bench.hh"
#include "components/test/modules.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::components::test {
namespace {

/// Commands that load one of each module; the prefix of the pins is the name of the module.
std::string load_all() {
    std::string commands;
    for (const std::string &module : all_modules()) {
        // at_pid has the pins of pid; the bench has its own threads.
        if (module != "at_pid" && module != "threads") {
            commands += "loadrt " + module + " " + arguments_of(module) + "\n";
        }
    }
    return commands;
}

void add_all_functions(Bench &bench) {
    for (const hal::FunctionInfo &function : bench.hal().functions().list()) {
        ASSERT_TRUE(bench.hal().threads().add_function(function.name, "t").has_value()) << function.name;
    }
}

TEST(EveryComponent, RunsWithoutTheHeap) {
    Bench bench(load_all() + "setp stepgen.0.enable 1\nsetp stepgen.0.position-cmd 100\nsetp pid.0.enable 1\n"
                             "setp pid.1.enable 1\nsetp pid.1.tune-mode 1\nsetp pid.1.tune-start 1\n");
    add_all_functions(bench);
    bench.pass();
    {
        const testing::AllocationGuard guard;
        bench.pass(200);
        EXPECT_EQ(guard.calls(), 0U);
    }
    EXPECT_EQ(bench.get("t.threadbeat"), 201.0);
    EXPECT_GT(bench.get("sampler.0.overruns"), 0.0) << "a full queue is no reason to stop";
}

TEST(EveryComponent, StandsAnyInput) {
    Bench bench(load_all());
    add_all_functions(bench);
    const double values[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -1.0, 0.0, 1.0, 4e9};
    for (const double value : values) {
        for (const hal::PinInfo &pin : bench.hal().pins().list("*")) {
            if (pin.dir == hal::Dir::OUT || pin.owner == "threads" || !pin.signal.empty()) {
                continue;
            }
            switch (pin.type) {
            case hal::Type::BIT: bench.set(pin.name, value > 0.0 ? 1.0 : 0.0); break;
            case hal::Type::FLOAT: bench.set(pin.name, value); break;
            case hal::Type::S32:
            case hal::Type::U32:
            case hal::Type::S64:
            case hal::Type::U64:
                bench.set(pin.name, value >= 0.0 && value <= 1.0 ? value : 2147483647.0);
                break;
            default: break;
            }
        }
        bench.pass(20);
    }
    EXPECT_EQ(bench.get("t.threadbeat"), 160.0);
}

}  // namespace
}  // namespace mw::components::test
