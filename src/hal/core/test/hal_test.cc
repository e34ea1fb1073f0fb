// SPDX-License-Identifier: GPL-2.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"

namespace mw::hal {
namespace {

struct HalTest : testing::Test {
    TestMachine machine;
    Instance &hal = machine.hal();
    int comp = *hal.components().create("comp");

    void **pin(const std::string &name, Type type, Dir dir) {
        auto made = hal.pins().create(name, type, dir, comp);
        EXPECT_TRUE(made) << text_of(made ? Result<>{} : std::unexpected(made.error()));
        return made ? *made : nullptr;
    }
    double read(void **slot) { return **reinterpret_cast<double **>(slot); }
    void write(void **slot, double value) { **reinterpret_cast<double **>(slot) = value; }
};

TEST_F(HalTest, LinkMovesTheSlotAndUnlinkKeepsTheValue) {
    void **out = pin("out", Type::FLOAT, Dir::OUT);
    void **in = pin("in", Type::FLOAT, Dir::IN);
    write(out, 4.5);
    ASSERT_EQ(text_of(hal.signals().net("s", {"out", "in"})), "ok");
    EXPECT_EQ(read(in), 4.5) << "the first pin gives the signal its value";
    EXPECT_EQ(*in, *out);
    write(out, 5.5);
    ASSERT_TRUE(hal.signals().unlink("in"));
    EXPECT_EQ(read(in), 5.5);
    write(out, 6.5);
    EXPECT_EQ(read(in), 5.5);
    ASSERT_TRUE(hal.signals().remove("s"));
    EXPECT_EQ(read(out), 6.5);
}

TEST_F(HalTest, ValuesOfAComponentLieSideBySideAndAloneInTheirCacheLines) {
    const auto place = [](void **slot) { return reinterpret_cast<std::uintptr_t>(*slot); };
    std::set<std::uintptr_t> lines;
    for (int i = 0; i < 600; ++i) {
        void **slot = pin("p" + std::to_string(i), i % 2 == 0 ? Type::BIT : Type::FLOAT, Dir::IN);
        EXPECT_EQ(place(slot) % 8, 0U);
        lines.insert(place(slot) / 64);
    }
    EXPECT_EQ(lines.size(), 600U / 8);
    const int other = *hal.components().create("other");
    void **of_other = *hal.pins().create("other.p", Type::FLOAT, Dir::OUT, other);
    EXPECT_FALSE(lines.contains(place(of_other) / 64));
    // A value that is reused must be zero.
    write(of_other, 3);
    const std::uintptr_t used = place(of_other);
    ASSERT_TRUE(hal.components().remove(other));
    void **again = pin("again", Type::FLOAT, Dir::OUT);
    EXPECT_EQ(place(again), used);
    EXPECT_EQ(read(again), 0);
}

TEST_F(HalTest, NetRulesRefuseSecondWritersAndChangeNothing) {
    pin("o1", Type::BIT, Dir::OUT);
    pin("o2", Type::BIT, Dir::OUT);
    pin("io", Type::BIT, Dir::IO);
    pin("io2", Type::BIT, Dir::IO);
    pin("in", Type::BIT, Dir::IN);
    pin("f", Type::FLOAT, Dir::IN);
    EXPECT_NE(
        text_of(hal.signals().net("s", {"in", "o1", "o2"})).find("another pin of the same net writes it"),
        std::string::npos);
    EXPECT_FALSE(hal.signals().find("s"));
    EXPECT_EQ(hal.pins().find("in")->signal, "");
    ASSERT_EQ(text_of(hal.signals().net("s", {"in", "o1", "in"})), "ok");
    EXPECT_NE(text_of(hal.signals().net("s", {"o2"})).find("pin 'o1' writes it already"), std::string::npos);
    EXPECT_NE(text_of(hal.signals().net("s", {"io"})).find("I/O pin 'io'"), std::string::npos);
    EXPECT_NE(text_of(hal.signals().net("s", {"f"})).find("pin 'f' is of type float, signal 's' of type bit"),
              std::string::npos);
    EXPECT_NE(text_of(hal.signals().net("t", {"in"})).find("linked to signal 's' already"),
              std::string::npos);
    EXPECT_EQ(text_of(hal.signals().net("b", {"io", "io2"})), "ok");
    EXPECT_FALSE(hal.signals().net("b", {"o2"}));
    EXPECT_NE(text_of(hal.signals().net("inn", {"o3"})).find("there is no pin 'o3'"), std::string::npos);
    EXPECT_FALSE(hal.signals().net("in", {"o2"})) << "a pin's name as the signal's";
}

TEST_F(HalTest, SetRefusesOutputsLinkedPinsAndReadOnlyParameters) {
    pin("o", Type::S32, Dir::OUT);
    pin("i", Type::S32, Dir::IN);
    auto *memory = static_cast<double *>(hal.memory().allocate(16));
    ASSERT_TRUE(hal.params().create("ro", Type::FLOAT, Dir::RO, memory, comp));
    ASSERT_TRUE(hal.params().create("i", Type::FLOAT, Dir::RW, memory + 1, comp));
    EXPECT_NE(text_of(hal.values().set("o", "1")).find("is an output"), std::string::npos);
    EXPECT_NE(text_of(hal.values().set("ro", "1")).find("read-only"), std::string::npos);
    ASSERT_TRUE(hal.values().set("i", "2.5")) << "a parameter comes before a pin of the same name";
    EXPECT_EQ(memory[1], 2.5);
    EXPECT_EQ(*hal.values().get("i"), Value::of_float(2.5));
    EXPECT_EQ(*hal.pins().get("i"), Value::of_s32(0));
    pin("p", Type::U32, Dir::IN);
    EXPECT_NE(text_of(hal.values().set("p", "-1")).find("from 0 to 4294967295"), std::string::npos);
    EXPECT_NE(text_of(hal.values().set("p", "1,5")).find("'1,5'"), std::string::npos);
    EXPECT_TRUE(hal.values().set("p", "0xffffffff"));
    EXPECT_EQ(*hal.values().get("p"), Value::of_u32(0xffffffff));
    ASSERT_TRUE(hal.signals().net("n", {"p"}));
    EXPECT_NE(text_of(hal.values().set("p", "1")).find("linked to signal 'n'"), std::string::npos);
    EXPECT_TRUE(hal.signals().set("n", "7"));
    EXPECT_EQ(*hal.signals().get("n"), Value::of_u32(7));
    EXPECT_NE(text_of(hal.values().set("pp", "1")).find("there is no pin or parameter 'pp'"),
              std::string::npos);
    ASSERT_TRUE(hal.signals().net("w", {"o"}));
    EXPECT_EQ(text_of(hal.signals().set("w", "1")), "signal 'w' is written by pin 'o'");
}

TEST_F(HalTest, AliasesAreSecondNamesThatListsShow) {
    pin("driver.0.x", Type::BIT, Dir::IN);
    ASSERT_TRUE(hal.pins().set_alias("driver.0.x", "lamp"));
    EXPECT_TRUE(hal.values().set("lamp", "1"));
    EXPECT_EQ(*hal.values().get("driver.0.x"), Value::of_bit(true));
    EXPECT_EQ(hal.pins().list()[0].name, "lamp");
    EXPECT_EQ(hal.pins().list()[0].original_name, "driver.0.x");
    EXPECT_EQ(hal.pins().list("driver*").size(), 1U);
    EXPECT_FALSE(hal.pins().create("lamp", Type::BIT, Dir::IN, comp));
    ASSERT_TRUE(hal.pins().set_alias("lamp", ""));
    EXPECT_FALSE(hal.values().get("lamp"));
    EXPECT_EQ(hal.pins().list()[0].name, "driver.0.x");
}

TEST_F(HalTest, NamesAreCheckedAndListsSorted) {
    pin("b", Type::BIT, Dir::IN);
    pin("a", Type::BIT, Dir::IN);
    pin(std::string(127, 'z'), Type::BIT, Dir::IN);
    EXPECT_FALSE(hal.pins().create(std::string(128, 'z'), Type::BIT, Dir::IN, comp));
    EXPECT_FALSE(hal.pins().create("", Type::BIT, Dir::IN, comp));
    EXPECT_FALSE(hal.pins().create("a", Type::BIT, Dir::IN, comp));
    const auto pins = hal.pins().list();
    ASSERT_EQ(pins.size(), 3U);
    EXPECT_EQ(pins[0].name, "a");
    EXPECT_EQ(pins[2].name.size(), 127U);
    EXPECT_EQ(pins[0].owner, "comp");
    ASSERT_TRUE(hal.components().set_ready(comp));
    EXPECT_FALSE(hal.pins().create("late", Type::BIT, Dir::IN, comp));
    void *elsewhere = nullptr;
    const int other = *hal.components().create("other");
    EXPECT_NE(text_of(hal.pins().create("x", Type::BIT, Dir::IN, &elsewhere, other))
                  .find("allocated by hal_malloc"),
              std::string::npos);
}

TEST_F(HalTest, LocksForbid) {
    pin("a", Type::BIT, Dir::IN);
    ASSERT_TRUE(hal.set_lock(LOCK_ALL));
    EXPECT_FALSE(hal.values().set("a", "1"));
    EXPECT_FALSE(hal.signals().net("s", {"a"}));
    EXPECT_FALSE(hal.threads().start());
    EXPECT_FALSE(hal.components().create("x"));
    ASSERT_TRUE(hal.set_lock(LOCK_TUNE));
    EXPECT_TRUE(hal.values().set("a", "1"));
    EXPECT_FALSE(hal.signals().net("s", {"a"}));
}

/// Appends its letter to a text when it runs.
struct Recorder {
    std::string *text;
    char letter;
    static void run(void *self, long /*period*/) {
        auto *recorder = static_cast<Recorder *>(self);
        *recorder->text += recorder->letter;
    }
};

TEST(HalThreads, RunFunctionsInOrderAndInitFunctionsOnce) {
    TestMachine machine;
    Instance &hal = machine.hal();
    const int comp = *hal.components().create("rt", CompType::REALTIME);
    std::string text;
    std::vector<Recorder> recorders;
    for (const char letter : std::string("abcdi")) {
        recorders.push_back({&text, letter});
    }
    for (Recorder &recorder : recorders) {
        ASSERT_TRUE(
            hal.functions().create(std::string(1, recorder.letter), {&Recorder::run, &recorder}, comp));
    }
    ASSERT_EQ(text_of(hal.threads().create("t", 1'000'000)), "ok");
    EXPECT_EQ(text_of(hal.threads().add_function("b", "t")), "ok");
    EXPECT_EQ(text_of(hal.threads().add_function("d", "t", -1)), "ok");
    EXPECT_EQ(text_of(hal.threads().add_function("c", "t", -2)), "ok");
    EXPECT_EQ(text_of(hal.threads().add_function("a", "t", 1)), "ok");
    EXPECT_EQ(text_of(hal.threads().add_init_function("i", "t")), "ok");
    EXPECT_FALSE(hal.threads().add_function("a", "t")) << "can only be added once";
    EXPECT_FALSE(hal.threads().add_function("nothing", "t"));
    EXPECT_FALSE(hal.threads().add_function("b", "nothing"));
    machine.clock.step();
    EXPECT_EQ(text, "");
    ASSERT_TRUE(hal.threads().start());
    machine.clock.step();
    EXPECT_EQ(text, "iabcd");
    ASSERT_TRUE(hal.threads().remove_function("b", "t"));
    machine.clock.step();
    EXPECT_EQ(text, "iabcdacd");
    EXPECT_NE(text_of(hal.threads().add_function("b", "t", 7)).find("position 7 is outside"),
              std::string::npos);
    EXPECT_FALSE(hal.threads().add_function("b", "t", 0));
    ASSERT_TRUE(hal.threads().add_function("b", "t", 2));
    EXPECT_EQ(hal.threads().list()[0].functions, (std::vector<std::string>{"a", "b", "c", "d"}));
    EXPECT_EQ(hal.threads().list()[0].init_functions, (std::vector<std::string>{"i"}));
    ASSERT_TRUE(hal.threads().stop());
    machine.clock.step();
    EXPECT_EQ(text, "iabcdacd");
    EXPECT_TRUE(hal.components().find("__t"));
    ASSERT_TRUE(hal.threads().remove("t"));
    EXPECT_FALSE(machine.clock.step());
    EXPECT_FALSE(hal.components().find("__t"));
}

TEST(HalThreads, FasterThreadsRunFirstAtEqualTimes) {
    TestMachine machine;
    Instance &hal = machine.hal();
    const int comp = *hal.components().create("rt", CompType::REALTIME);
    std::string text;
    Recorder slow{&text, 's'};
    Recorder fast{&text, 'f'};
    ASSERT_TRUE(hal.functions().create("slow.f", {&Recorder::run, &slow}, comp));
    ASSERT_TRUE(hal.functions().create("fast.f", {&Recorder::run, &fast}, comp));
    ASSERT_TRUE(hal.threads().create("slow", 3000));
    ASSERT_TRUE(hal.threads().create("fast", 1000));
    ASSERT_TRUE(hal.threads().add_function("slow.f", "slow"));
    ASSERT_TRUE(hal.threads().add_function("fast.f", "fast"));
    ASSERT_TRUE(hal.threads().start());
    machine.clock.run_until(6000);
    EXPECT_EQ(text, "fffsfffs");
    EXPECT_EQ(hal.threads().list()[0].name, "fast");
}

TEST(HalValue, ReadsAndPrintsEveryType) {
    EXPECT_EQ(*parse_value(Type::BIT, "TRUE"), Value::of_bit(true));
    EXPECT_EQ(*parse_value(Type::BIT, "0"), Value::of_bit(false));
    EXPECT_FALSE(parse_value(Type::BIT, "2"));
    EXPECT_FALSE(parse_value(Type::BIT, "1.0"));
    EXPECT_EQ(*parse_value(Type::S32, "010"), Value::of_s32(8));
    EXPECT_EQ(*parse_value(Type::S32, "-010"), Value::of_s32(-8));
    EXPECT_FALSE(parse_value(Type::U32, "08"));
    EXPECT_EQ(*parse_value(Type::S32, "-0x10"), Value::of_s32(-16));
    EXPECT_EQ(*parse_value(Type::U32, "+0x10"), Value::of_u32(16));
    EXPECT_EQ(*parse_value(Type::S64, "-0x10"), Value::of_s64(-16));
    EXPECT_EQ(*parse_value(Type::U64, "010"), Value::of_u64(8));
    EXPECT_EQ(*parse_value(Type::FLOAT, "-0x10"), Value::of_float(-16));
    EXPECT_FALSE(parse_value(Type::S32, "+-1"));
    EXPECT_FALSE(parse_value(Type::FLOAT, "nan"));
    EXPECT_EQ(*parse_value(Type::FLOAT, "010"), Value::of_float(10));
    EXPECT_EQ(*parse_value(Type::FLOAT, ".15"), Value::of_float(0.15));
    EXPECT_EQ(*parse_value(Type::FLOAT, "4.2e1"), Value::of_float(42));
    EXPECT_FALSE(parse_value(Type::FLOAT, "1,5"));
    EXPECT_EQ(*parse_value(Type::S32, "-2147483648"), Value::of_s32(-2147483647 - 1));
    EXPECT_FALSE(parse_value(Type::S32, "2147483648"));
    EXPECT_FALSE(parse_value(Type::S32, "1.5"));
    EXPECT_EQ(*parse_value(Type::U64, "0xffffffffffffffff"), Value::of_u64(~0ULL));
    EXPECT_EQ(parse_value(Type::S64, "-9223372036854775808")->str(), "-9223372036854775808");
    EXPECT_EQ(Value::of_float(2147483647).str(), "2.147484e+09");
    EXPECT_EQ(Value::of_bit(true).str(), "TRUE");
}

TEST(HalValue, NamesOfTypesAreInAnyCase) {
    EXPECT_EQ(*parse_type("BIT"), Type::BIT);
    EXPECT_EQ(*parse_type("Float"), Type::FLOAT);
    EXPECT_EQ(*parse_type("S32"), Type::S32);
    EXPECT_EQ(*parse_type("U64"), Type::U64);
    EXPECT_FALSE(parse_type("BITS"));
}

}  // namespace
}  // namespace mw::hal
