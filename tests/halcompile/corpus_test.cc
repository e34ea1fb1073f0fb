// SPDX-License-Identifier: GPL-2.0-or-later
// Components as users write them: compiled by halcompile, loaded and run.
#include <gtest/gtest.h>

#include "hal/include/hal.h"
#include "hal/include/kinematics.h"
#include "tests/halcompile/corpus.hh"

namespace mw::hal {
namespace {

TEST_F(Corpus, OneFunctionWithoutTheWord) {
    ASSERT_EQ(load("gain.comp"), "ok");
    set("gain.0.in", "4");
    cycle({"gain.0"});
    EXPECT_EQ(number("gain.0.out"), 10);
    EXPECT_EQ(pins("gain*"), "gain.0.in gain.0.out gain.0.time ");
    EXPECT_EQ(number("gain.0.tmax"), 0);
}

TEST_F(Corpus, SettersNewerTypesAndAPersonalityByOption) {
    ASSERT_EQ(load("setters.comp", {"personality=7"}), "ok");
    EXPECT_EQ(hal().pins().find("setters.0.a")->type, Type::S32);
    EXPECT_EQ(hal().pins().find("setters.0.b")->type, Type::U32);
    cycle({"setters.0"});
    EXPECT_EQ(number("setters.0.b"), 10);
    EXPECT_EQ(number("setters.0.many-1"), 1);
    EXPECT_EQ(number("setters.0.many-0"), 0);
    EXPECT_EQ(number("setters.0.level"), 1.5);
    EXPECT_EQ(number("setters.0.kept-set"), 1) << "a pin of that name stays a pin";
}

TEST_F(Corpus, StartValuesNamesAndBits) {
    ASSERT_EQ(load("onoff.comp", {"names=bed,nozzle"}), "ok");
    EXPECT_EQ(number("bed.setpoint"), 20);
    EXPECT_EQ(number("nozzle.enable"), 1);
    set("bed.value", "18");
    cycle({"bed", "nozzle"});
    EXPECT_EQ(number("bed.heat"), 1);
    set("bed.value", "20.5");
    more(1);
    EXPECT_EQ(number("bed.heat"), 1) << "in the band";
    set("bed.value", "22");
    more(1);
    EXPECT_EQ(number("bed.heat"), 0);
}

TEST_F(Corpus, ArraysOfFixedAndDependentSize) {
    ASSERT_EQ(load("shiftreg.comp"), "ok");
    ASSERT_EQ(load("gate.comp", {"count=3", "personality=0x3,0x212,0x711"}), "ok");
    EXPECT_EQ(pins("gate.0.*"), "gate.0.in-00 gate.0.in-01 gate.0.in-02 gate.0.sum gate.0.time ");
    EXPECT_EQ(pins("gate.1.*"), "gate.1.average gate.1.in-00 gate.1.in-01 gate.1.sum gate.1.time ");
    EXPECT_NE(load_only("gate"), "ok") << "twice";
    set("gate.1.in-00", "3");
    set("gate.1.in-01", "4");
    set("shiftreg.0.in", "1");
    cycle({"gate.1", "shiftreg.0"}, 3);
    EXPECT_EQ(number("gate.1.average"), 3.5);
    EXPECT_EQ(number("shiftreg.0.out-02"), 1);
    EXPECT_EQ(number("shiftreg.0.out-03"), 0);
}

TEST_F(Corpus, APersonalityThatAsksTooMuchIsRefused) {
    EXPECT_NE(
        load("gate.comp", {"personality=0x520"}).find("personality sets 5 of weight-#, 0 to 4 are possible"),
        std::string::npos);
    EXPECT_EQ(load_only("gate", {"personality=0x420"}), "ok");
    EXPECT_EQ(number("gate.0.weight-3"), 1.5);
}

TEST_F(Corpus, PersonalitiesWrapAtTheirLimit) {
    compile("gate.comp", "--personalities=2");
    ASSERT_EQ(load_only("gate", {"count=3", "personality=1,2"}), "ok");
    EXPECT_EQ(pins("gate.2.in*"), "gate.2.in-00 ") << "takes the first again";
    EXPECT_FALSE(messages.empty());
}

TEST_F(Corpus, NamesWithNumbersInside) {
    ASSERT_EQ(load("bank.comp"), "ok");
    set("bank.0.ch.1.in", "2");
    cycle({"bank.0"});
    EXPECT_EQ(number("bank.0.ch.1.out"), 2.5);
    EXPECT_EQ(number("bank.0.runs"), 17);
}

TEST_F(Corpus, TimeAndVariables) {
    ASSERT_EQ(load("pulse.comp"), "ok");
    cycle({"pulse.0"}, 2);
    set("pulse.0.trigger", "1");
    more(2);
    EXPECT_EQ(number("pulse.0.out"), 1);
    more(3);
    EXPECT_EQ(number("pulse.0.out"), 0);
}

TEST_F(Corpus, SeveralFunctionsWithNamesOfTheCLibrary) {
    ASSERT_EQ(load("twofun.comp", {"count=2"}), "ok");
    set("twofun.1.raw", "8");
    cycle({"twofun.1.read", "twofun.1.write"});
    EXPECT_EQ(number("twofun.1.cooked"), 16);
}

TEST_F(Corpus, OptionsForInstances) {
    ASSERT_EQ(load("single.comp"), "ok");
    cycle({"single.tick"}, 5);
    EXPECT_EQ(number("single.ticks"), 5);
    ASSERT_EQ(load("many.comp"), "ok");
    EXPECT_EQ(pins("many.*.alive"), "many.0.alive many.1.alive many.2.alive ");
    const UseInstance use(&hal());
    EXPECT_EQ(hal_comp_invoke_make("many", "other", ""), 0);
    EXPECT_EQ(number("other.alive"), 1);
    EXPECT_NE(load("onoff.comp", {"count=1", "names=a"}).find("give count= or names=, not both"),
              std::string::npos);
    EXPECT_EQ(load_only("onoff", {"count=300"}), "ok");
}

TEST_F(Corpus, CountFunctionSetUpAndCleanUp) {
    ASSERT_EQ(load("counted.comp", {"at=5,6"}), "ok");
    cycle({"counted.0", "counted.1"});
    EXPECT_EQ(number("counted.1.address"), 6);
    EXPECT_TRUE(host->unload_realtime("counted"));
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages.back(), "counted: cleaned up");
    const std::string refused = load_only("counted", {"at=5,-1"});
    EXPECT_NE(refused.find("Numerical result out of range"), std::string::npos) << refused;
    EXPECT_EQ(pins("counted*"), "");
}

TEST_F(Corpus, SetUpBeforeAndAfterThePins) {
    ASSERT_EQ(load("setup.comp", {"names=abcde,xy"}), "ok");
    EXPECT_EQ(number("xy.number"), 11);
    cycle({"abcde"});
    EXPECT_EQ(number("abcde.length"), 5);
}

TEST_F(Corpus, ModuleParameters) {
    ASSERT_EQ(load("modp.comp", {"far=1000", "list=1,2", "title=hello", "table=a,bc"}), "ok");
    cycle({"modp.0"});
    EXPECT_EQ(number("modp.0.sum"), 3 + 1000 + 1 + 2 + 7 + 7);
    EXPECT_EQ(number("modp.0.letters"), 305);
}

TEST_F(Corpus, TypesOfItsOwnPointersAndData) {
    ASSERT_EQ(load("structs.comp"), "ok");
    ASSERT_EQ(load("ptrs.comp", {"count=2"}), "ok");
    ASSERT_EQ(load("olddata.comp"), "ok");
    set("structs.0.in", "1");
    cycle({"structs.0", "ptrs.1", "olddata.0"}, 2);
    EXPECT_EQ(number("structs.0.out"), 6);
    EXPECT_EQ(number("structs.0.check"), 1 + 40 + 100 - 5000 + 'c');
    EXPECT_EQ(number("ptrs.1.sum"), 12);
    EXPECT_EQ(number("olddata.0.out"), 2.5);
    EXPECT_TRUE(host->unload_realtime("ptrs"));
}

TEST_F(Corpus, HeadersAndWideTypes) {
    ASSERT_EQ(load("incl.comp"), "ok");
    ASSERT_EQ(load("wide.comp"), "ok");
    ASSERT_EQ(load("hal_tick.comp"), "ok");
    set("incl.0.angle", "0");
    cycle({"incl.0", "wide.0", "tick.0.run-now"});
    EXPECT_EQ(number("incl.0.cos"), 1);
    EXPECT_EQ(number("wide.0.sum"), 999999999);
    EXPECT_EQ(hal().values().get("wide.0.top")->as_u64(), ~std::uint64_t{0});
    EXPECT_EQ(number("tick.0.tick"), 1);
    EXPECT_TRUE(hal().components().find("hal_tick"));
}

TEST_F(Corpus, KinematicsHomingAndPlannerModules) {
    ASSERT_EQ(load("polar.comp"), "ok");
    ASSERT_EQ(load("homeall.comp"), "ok");
    ASSERT_EQ(load("tpline.comp"), "ok");
    EXPECT_EQ(number("homeall.is-module"), 1);
    const auto inverse =
        reinterpret_cast<decltype(&kinematicsInverse)>(host->loader().find_symbol("kinematicsInverse"));
    ASSERT_NE(inverse, nullptr);
    EmcPose pose{};
    pose.tran.y = 2;
    double joints[3] = {};
    EXPECT_EQ(inverse(&pose, joints, nullptr, nullptr), 0);
    EXPECT_DOUBLE_EQ(joints[0], 2);
    EXPECT_DOUBLE_EQ(joints[1], 90);
    for (const char *symbol :
         {"kinematicsType", "kinematicsSwitchable", "do_homing", "get_allhomed", "tpline_length"}) {
        EXPECT_NE(host->loader().find_symbol(symbol), nullptr) << symbol;
    }
    ASSERT_TRUE(host->unload_realtime("polar"));
    ASSERT_EQ(load("kinsc.c"), "ok");
    EXPECT_NE(host->loader().find_symbol("kinematicsForward"), nullptr);
}

TEST_F(Corpus, AComponentThatMakesItsInstancesItself) {
    ASSERT_EQ(load("ownapp.comp", {"how_many=3"}), "ok");
    cycle({"mine.c"});
    EXPECT_EQ(number("mine.c.number"), 10);
}

TEST_F(Corpus, PortsByValueAndByAddress) {
    ASSERT_EQ(load("portecho.comp"), "ok");
    for (const char *name : {"to", "from"}) {
        ASSERT_TRUE(hal().signals().create(name, Type::PORT));
        ASSERT_TRUE(hal().signals().set(name, std::string_view("32")));
    }
    const int comp = *hal().components().create("user");
    const auto in = hal().pins().create("user.in", Type::PORT, Dir::IN, comp);
    const auto out = hal().pins().create("user.out", Type::PORT, Dir::OUT, comp);
    ASSERT_TRUE(hal().signals().link("user.out", "to"));
    ASSERT_TRUE(hal().signals().link("portecho.0.in", "to"));
    ASSERT_TRUE(hal().signals().link("portecho.0.out", "from"));
    ASSERT_TRUE(hal().signals().link("user.in", "from"));
    const UseInstance use(&hal());
    ASSERT_TRUE(hal_port_write(static_cast<hal_port_t *>(**out), "abc", 3));
    cycle({"portecho.0"});
    EXPECT_EQ(number("portecho.0.waiting"), 3);
    char text[4] = {};
    EXPECT_TRUE(hal_port_read(static_cast<hal_port_t *>(**in), text, 3));
    EXPECT_STREQ(text, "ABC");
}

TEST_F(Corpus, ModulesShareWhatTheyExportAndNothingElse) {
    ASSERT_EQ(load("giver.comp"), "ok");
    ASSERT_EQ(load("taker.comp"), "ok");
    cycle({"taker.0", "giver"});
    EXPECT_EQ(number("taker.0.answer"), 44) << "its own corpus_private";
    EXPECT_EQ(number("giver.asked"), 1);
    const std::string refused = load("snoop.comp");
    EXPECT_NE(refused.find("snoop: dlopen: "), std::string::npos) << refused;
    EXPECT_NE(refused.find("undefined symbol: corpus_hidden"), std::string::npos) << refused;
    EXPECT_FALSE(host->unload_realtime("giver")) << "taker uses it";
    EXPECT_TRUE(host->unload_realtime("taker"));
    EXPECT_TRUE(host->unload_realtime("giver"));
}

// As in LinuxCNC's test halcompile/serial-out-of-tree, the header is available without the sources of the
// driver.
TEST_F(Corpus, SerialInterfacesOfBoards) {
    EXPECT_EQ(compile("serialport.comp"), "");
    const std::string refused = load_only("serialport", {"names=hm2_7i80.0.uart.0"});
    EXPECT_NE(refused.find("undefined symbol: hm2_"), std::string::npos) << refused;
}

TEST_F(Corpus, ModulesInCAndCxx) {
    ASSERT_EQ(load("cmod.c", {"ch=x,y", "scale=3"}), "ok");
    ASSERT_EQ(load("cxxmod.cc"), "ok");
    set("cxxmod.in", "8");
    cycle({"cmod.run", "cxxmod.run"}, 2);
    EXPECT_EQ(number("cmod.y.count"), 6);
    EXPECT_EQ(number("cmod.x.speed"), 3000);
    EXPECT_EQ(number("cmod.x.flag"), 1);
    EXPECT_EQ(number("cxxmod.out"), 6);
    EXPECT_TRUE(host->unload_realtime("cmod"));
    const std::string refused = load_only("cmod");
    EXPECT_NE(refused.find("cmod: no channels"), std::string::npos) << refused;
    EXPECT_NE(refused.find("Numerical result out of range"), std::string::npos) << refused;
}

}  // namespace
}  // namespace mw::hal
