// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"

namespace mw::hal {
namespace {

using ::testing::Test;

TEST(Loader, RunsACComponentFromASharedObject) {
    TestMachine machine;
    ASSERT_EQ(machine.load("threads2"), "ok");
    ASSERT_EQ(machine.load("counter", {"start=5", "steps=2,3", "names=a,b"}), "ok");
    EXPECT_EQ(machine.value("a.count"), Value::of_s32(5));
    ASSERT_TRUE(machine.hal().threads().add_function("a.update", "fast"));
    ASSERT_TRUE(machine.hal().threads().add_function("b.update", "slow"));
    machine.clock.run_until(10'000'000);
    EXPECT_EQ(machine.value("a.count"), Value::of_s32(5)) << "threads are not started";
    ASSERT_TRUE(machine.hal().threads().start());
    machine.clock.run_until(20'000'000);
    EXPECT_EQ(machine.value("a.count"), Value::of_s32(25));
    EXPECT_EQ(machine.value("b.count"), Value::of_s32(14)) << "at 12, 16 and 20 ms";
    EXPECT_EQ(machine.value("fast.threadbeat"), Value::of_s64(10));
    EXPECT_EQ(machine.value("threads2.plans"), Value::of_u64(10));
    EXPECT_EQ(machine.value("a.update.time"), Value::of_s32(0)) << "virtual time";
}

TEST(Loader, SetsModuleParametersAndNamesTheKnownOnes) {
    TestMachine machine;
    EXPECT_NE(machine.load("counter", {"stepz=1"})
                  .find("it has start, steps, names, config (did you mean 'steps'?)"),
              std::string::npos);
    EXPECT_NE(machine.load("counter", {"start=abc"}).find("'abc' is not a whole number of 32 bits"),
              std::string::npos);
    EXPECT_NE(machine.load("counter", {"steps=1,2,3,4"}).find("takes at most 3 values"), std::string::npos);
    EXPECT_NE(machine.load("counter", {"start"}).find("'start' is not of the form name=value"),
              std::string::npos);
    EXPECT_NE(machine.load("nothing").find("there is no module 'nothing.so'"), std::string::npos);
    EXPECT_NE(machine.load("hm2_pci").find("there is no driver of this board yet"), std::string::npos);
    EXPECT_NE(machine.load("countr").find("did you mean 'counter'?"), std::string::npos);
    EXPECT_TRUE(machine.hal().components().list().empty());
    EXPECT_EQ(machine.load("counter", {"config=any, thing=2", "names="}), "ok");
    EXPECT_EQ(machine.hal().components().find("counter")->insmod_args, "config=\"any, thing=2\" names=")
        << "as a HAL file has it";
    EXPECT_TRUE(machine.hal().components().find("counter")->isReady);
    EXPECT_EQ(machine.hal().components().find("counter")->type, CompType::REALTIME);
}

TEST(Loader, AModuleThatFailsLeavesNothing) {
    TestMachine machine;
    EXPECT_EQ(machine.load("counter", {"start=-1"}),
              "module 'counter': counter: start=-1 is below 0: Invalid argument (-22)");
    EXPECT_EQ(machine.messages.all(), "counter: start=-1 is below 0\n");
    EXPECT_NE(machine.load("threads2", {"leak=1"}).find("No such device"), std::string::npos);
    EXPECT_TRUE(machine.hal().components().list().empty());
    EXPECT_TRUE(machine.hal().threads().list().empty());
    EXPECT_TRUE(machine.hal().pins().list().empty());
    EXPECT_FALSE(machine.clock.step());
    EXPECT_EQ(machine.load("counter"), "ok");
}

TEST(Loader, UnloadingTakesFunctionsOutOfThreads) {
    TestMachine machine;
    ASSERT_EQ(machine.load("threads2"), "ok");
    ASSERT_EQ(machine.load("counter"), "ok");
    ASSERT_TRUE(machine.hal().threads().add_function("counter.0.update", "fast"));
    ASSERT_TRUE(machine.hal().threads().start());
    machine.clock.run_until(3'000'000);
    ASSERT_EQ(text_of(machine.host->unload_realtime("counter")), "ok");
    machine.clock.run_until(6'000'000);
    EXPECT_TRUE(machine.hal().threads().list()[0].functions.empty());
    EXPECT_TRUE(machine.hal().functions().list().empty());
    EXPECT_TRUE(machine.hal().pins().list("counter*").empty());
    ASSERT_EQ(machine.load("counter"), "ok") << "and loads again";
}

TEST(Loader, AModuleInUseStays) {
    TestMachine machine;
    ASSERT_EQ(machine.load("counter"), "ok");
    ASSERT_EQ(machine.load("threads2"), "ok");
    EXPECT_EQ(text_of(machine.host->unload_realtime("counter")),
              "module 'counter' is used by component 'threads2'");
    EXPECT_EQ(text_of(machine.host->unload_realtime("threads2")), "ok");
    EXPECT_EQ(text_of(machine.host->unload_realtime("counter")), "ok");
}

TEST(Loader, TwoInstancesInOneProcessShareNoStatics) {
    TestMachine one("one");
    TestMachine two("two");
    ASSERT_EQ(one.load("counter", {"start=1"}), "ok");
    ASSERT_EQ(two.load("counter", {"start=2"}), "ok");
    EXPECT_EQ(one.value("counter.0.count"), Value::of_s32(1));
    EXPECT_EQ(two.value("counter.0.count"), Value::of_s32(2));
    for (TestMachine *machine : {&one, &two}) {
        auto *loads = reinterpret_cast<int (*)()>(machine->host->loader().find_symbol("test_loads"));
        ASSERT_NE(loads, nullptr);
        EXPECT_EQ(loads(), 1);
    }
    EXPECT_EQ(one.host->loader().find_symbol("printf"), nullptr);
    ASSERT_TRUE(one.hal().values().set("counter.0.scale", "3"));
    EXPECT_EQ(two.value("counter.0.scale"), Value::of_float(1));
}

TEST(Loader, SdkComponentHasItsPinsParametersAndFunctions) {
    TestMachine machine;
    ASSERT_EQ(machine.load("threads2"), "ok");
    EXPECT_NE(machine.load("sdk_sum", {"count=5"}).find("1 to 4 are possible"), std::string::npos);
    EXPECT_NE(machine.load("sdk_sum", {"count=010"}).find("count=8"), std::string::npos) << "octal, as in C";
    EXPECT_NE(machine.load("sdk_sum", {"count=-0x1"}).find("count=-1"), std::string::npos);
    EXPECT_NE(machine.load("sdk_sum", {"count=1", "names=a"}).find("not both"), std::string::npos);
    ASSERT_EQ(machine.load("sdk_sum", {"count=2"}), "ok");
    ASSERT_TRUE(machine.hal().threads().add_function("sdk-sum.1", "fast"));
    ASSERT_TRUE(machine.hal().values().set("sdk-sum.1.in0", "1.5"));
    ASSERT_TRUE(machine.hal().values().set("sdk-sum.1.in1", "2"));
    ASSERT_TRUE(machine.hal().values().set("sdk-sum.1.gain", "2"));
    EXPECT_EQ(machine.value("sdk-sum.1.clear"), Value::of_bit(true));
    ASSERT_TRUE(machine.hal().signals().net("total", {"sdk-sum.1.out", "sdk-sum.0.in0"}));
    ASSERT_TRUE(machine.hal().threads().start());
    machine.clock.step();
    EXPECT_EQ(machine.value("sdk-sum.0.in0"), Value::of_float(7));
    EXPECT_EQ(machine.value("sdk-sum.1.runs"), Value::of_s32(1));
}

TEST(Loader, OverlongNamesAreErrorsNeverCut) {
    TestMachine machine;
    const std::string name(120, 'n');
    EXPECT_EQ(machine.load("sdk_sum", {"names=" + name}).find("ok"), std::string::npos)
        << "NAME.tmax-increased would be too long";
    EXPECT_TRUE(machine.hal().pins().list().empty());
    EXPECT_EQ(machine.load("sdk_sum", {"names=" + std::string(107, 'n')}), "ok");
}

}  // namespace
}  // namespace mw::hal
