// SPDX-License-Identifier: GPL-2.0-or-later
// HAL functions in a thread use neither heap nor locks.
#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"
#include "hal/include/hal.h"
#include "tests/support/allocation_guard.hh"

namespace mw::hal {
namespace {

TEST(AllocationGuard, CountsWhatThisThreadDoes) {
    mw::testing::AllocationGuard guard;
    EXPECT_EQ(guard.calls(), 0U);
    int *memory = new int(1);
    // prevents the compiler from removing an unused allocation
    __asm__ volatile("" : : "r"(memory) : "memory");
    delete memory;
    EXPECT_EQ(guard.calls(), 2U);
}

TEST(RealtimeCode, ThreadsRunWithoutTheHeap) {
    TestMachine machine;
    ASSERT_EQ(machine.load("threads2"), "ok");
    ASSERT_EQ(machine.load("counter"), "ok");
    ASSERT_EQ(machine.load("sdk_sum", {"count=4"}), "ok");
    Instance &hal = machine.hal();
    ASSERT_TRUE(hal.threads().add_init_function("counter.0.update", "fast"));
    ASSERT_TRUE(hal.threads().add_function("counter.1.update", "slow"));
    for (int i = 0; i < 4; ++i) {
        ASSERT_TRUE(hal.threads().add_function("sdk-sum." + std::to_string(i), "fast"));
    }
    ASSERT_TRUE(hal.threads().start());
    mw::testing::AllocationGuard guard;
    machine.clock.run_until(1'000'000'000);
    EXPECT_EQ(guard.calls(), 0U);
    EXPECT_EQ(machine.value("sdk-sum.3.runs"), Value::of_s32(1000));
}

/// Calls every function that is permitted in realtime functions.
struct Talker {
    hal_stream_t stream{};
    int runs = 0;
    char text[32] = "";

    static void run(void *self, long /*period*/) {
        auto *talker = static_cast<Talker *>(self);
        hal_stream_data_u data[2]{};
        data[0].f = ++talker->runs;
        data[1].k = static_cast<rtapi_u64>(rtapi_get_time());
        hal_stream_write(&talker->stream, data);
        rtapi_print_msg(RTAPI_MSG_DBG, "not printed %d", 1);
        rtapi_snprintf(talker->text, sizeof talker->text, "%d %g %s", talker->runs, 2.5, "three");
        rtapi_delay(1000);
    }
};

TEST(RealtimeCode, StreamsTimeAndFormattingWorkWithoutTheHeap) {
    TestMachine machine;
    Instance &hal = machine.hal();
    const UseInstance use(&hal);
    const int comp = *hal.components().create("talker", CompType::REALTIME);
    Talker talker;
    ASSERT_EQ(hal_stream_create(&talker.stream, comp, 77, 11, "fk"), 0);
    ASSERT_TRUE(hal.functions().create("talk", {&Talker::run, &talker}, comp));
    ASSERT_TRUE(hal.threads().create("t", 1'000'000));
    ASSERT_TRUE(hal.threads().add_function("talk", "t"));
    ASSERT_TRUE(hal.threads().start());
    {
        mw::testing::AllocationGuard guard;
        machine.clock.run_until(12'000'000);
        EXPECT_EQ(guard.calls(), 0U);
    }
    EXPECT_EQ(talker.runs, 12);
    EXPECT_STREQ(talker.text, "12 2.5 three");
    hal_stream_t reader{};
    const int other = *hal.components().create("reader");
    EXPECT_EQ(hal_stream_attach(&reader, other, 77, "ff"), -EINVAL);
    EXPECT_EQ(hal_stream_attach(&reader, other, 78, nullptr), -EINVAL) << "as in LinuxCNC";
    ASSERT_EQ(hal_stream_attach(&reader, other, 77, "FK"), 0);
    EXPECT_EQ(hal_stream_element_type(&reader, 1), HAL_U64);
    EXPECT_EQ(hal_stream_depth(&reader), 10U);
    EXPECT_EQ(hal_stream_num_overruns(&reader), 2);
    hal_stream_data_u data[2];
    unsigned sample = 0;
    for (unsigned i = 1; i <= 10; ++i) {
        ASSERT_EQ(hal_stream_read(&reader, data, &sample), 0);
        EXPECT_EQ(sample, i);
        EXPECT_EQ(data[0].f, i);
        EXPECT_EQ(data[1].k, i * 1'000'000U);
    }
    EXPECT_EQ(hal_stream_read(&reader, data, &sample), -ENOSPC);
    EXPECT_EQ(hal_stream_num_underruns(&reader), 1);
    machine.clock.step();
    ASSERT_EQ(hal_stream_read(&reader, data, &sample), 0);
    EXPECT_EQ(sample, 13U) << "the gap shows what was lost";
    EXPECT_EQ(hal_stream_detach(&reader), 0);
    hal_stream_destroy(&talker.stream);
    EXPECT_EQ(hal_stream_attach(&reader, other, 77, nullptr), -EINVAL);
}

TEST(CApi, CountersWidenAcrossTheirWrap) {
    EXPECT_EQ(hal_extend_counter(0, 5, 16), 5);
    EXPECT_EQ(hal_extend_counter(0xfffe, 3, 16), 0x10003);
    EXPECT_EQ(hal_extend_counter(0x10003, 0xfffe, 16), 0xfffe);
    EXPECT_EQ(hal_extend_counter(-1, 0, 8), 0);
    EXPECT_EQ(hal_extend_counter(100, 100, 32), 100);
}

TEST(CApi, ReferencesReadAndWritePins) {
    TestMachine machine;
    const UseInstance use(&machine.hal());
    const int comp = hal_init("refs");
    ASSERT_GT(comp, 0);
    struct Refs {
        hal_real_t real;
        hal_sint_t wide, narrow;
        hal_bool_t bit;
        hal_uint_t param;
    };
    auto *refs = static_cast<Refs *>(hal_malloc(sizeof(Refs)));
    ASSERT_EQ(hal_pin_new_real(comp, HAL_OUT, &refs->real, 2.5, "refs.%d.real", 0), 0);
    ASSERT_EQ(hal_pin_new_sint(comp, HAL_OUT, &refs->wide, -5, "refs.wide"), 0);
    ASSERT_EQ(hal_pin_new_si32(comp, HAL_IN, &refs->narrow, -7, "refs.narrow"), 0);
    ASSERT_EQ(hal_pin_new_bool(comp, HAL_IN, &refs->bit, true, "refs.bit"), 0);
    ASSERT_EQ(hal_param_new_uint(comp, HAL_RW, &refs->param, 9, "refs.param"), 0);
    EXPECT_EQ(hal_pin_new_real(comp, HAL_RO, &refs->real, 0, "refs.x"), -EINVAL);
    EXPECT_EQ(hal_get_real(refs->real), 2.5);
    EXPECT_EQ(machine.value("refs.narrow"), Value::of_s32(-7));
    EXPECT_EQ(hal_get_si32(refs->narrow), -7);
    EXPECT_TRUE(hal_get_bool(refs->bit));
    hal_set_sint(refs->wide, 1LL << 40);
    EXPECT_EQ(hal_get_si32_clamped(refs->wide), RTAPI_INT32_MAX);
    EXPECT_EQ(machine.value("refs.wide"), Value::of_s64(1LL << 40));
    EXPECT_EQ(machine.value("refs.param"), Value::of_u64(9));
    EXPECT_EQ(machine.hal().pins().find("refs.wide")->type, Type::S64);
    hal_type_t type = HAL_TYPE_UNSPECIFIED;
    hal_data_u *data = nullptr;
    bool connected = true;
    ASSERT_EQ(hal_get_pin_value_by_name("refs.0.real", &type, &data, &connected), 0);
    EXPECT_EQ(type, HAL_FLOAT);
    EXPECT_EQ(data->f, 2.5);
    EXPECT_FALSE(connected);
    EXPECT_EQ(hal_ready(comp), 0);
    EXPECT_EQ(hal_exit(comp), 0);
    EXPECT_EQ(hal_exit(comp), -EINVAL);
}

TEST(CApi, SharedBlocksAreOnePerKeyAndZeroedAnew) {
    TestMachine machine;
    const UseInstance use(&machine.hal());
    const int id = rtapi_shmem_new(5, 1, 100);
    void *memory = nullptr;
    ASSERT_EQ(rtapi_shmem_getptr(id, &memory), 0);
    *static_cast<int *>(memory) = 7;
    EXPECT_EQ(*machine.hal().memory().shared_block(5, 50), memory);
    EXPECT_EQ(rtapi_shmem_new(5, 2, 200), -EINVAL);
    EXPECT_EQ(rtapi_shmem_delete(id, 1), 0);
    EXPECT_EQ(rtapi_shmem_delete(id, 2), 0);
    EXPECT_EQ(rtapi_shmem_delete(id, 2), -EINVAL);
    const int again = rtapi_shmem_new(5, 1, 200);
    ASSERT_EQ(rtapi_shmem_getptr(again, &memory), 0);
    EXPECT_EQ(*static_cast<int *>(memory), 0);
}

TEST(CApi, PortsCarryBytesInOrderAllOrNone) {
    TestMachine machine;
    const UseInstance use(&machine.hal());
    const int comp = hal_init("ports");
    auto **pins = static_cast<hal_port_t **>(hal_malloc(2 * sizeof(hal_port_t *)));
    ASSERT_EQ(hal_pin_port_new("ports.out", HAL_OUT, &pins[0], comp), 0);
    ASSERT_EQ(hal_pin_port_new("ports.in", HAL_IN, &pins[1], comp), 0);
    EXPECT_FALSE(hal_port_write(pins[0], "x", 1)) << "not linked";
    ASSERT_EQ(text_of(machine.hal().signals().net("bytes", {"ports.out", "ports.in"})), "ok");
    EXPECT_EQ(hal_port_writable(pins[0]), 0U) << "no size yet";
    EXPECT_FALSE(machine.hal().signals().set("bytes", "1"));
    EXPECT_FALSE(machine.hal().signals().set("bytes", "65537"));
    ASSERT_EQ(text_of(machine.hal().signals().set("bytes", "8")), "ok");
    EXPECT_FALSE(machine.hal().signals().set("bytes", "16"));
    EXPECT_EQ(hal_port_buffer_size(pins[1]), 8U);
    mw::testing::AllocationGuard guard;
    std::uint8_t wrote = 0;
    std::uint8_t seen = 0;
    for (int round = 0; round < 1000; ++round) {
        char bytes[8];
        const unsigned count = static_cast<unsigned>(round) % 7 + 1;
        for (unsigned i = 0; i < count; ++i) {
            bytes[i] = static_cast<char>(wrote++);
        }
        ASSERT_TRUE(hal_port_write(pins[0], bytes, count));
        EXPECT_FALSE(hal_port_write(pins[0], bytes, 8 - count)) << "one more than fits";
        EXPECT_EQ(hal_port_readable(pins[1]), count);
        EXPECT_FALSE(hal_port_read(pins[1], bytes, count + 1));
        char peeked[8];
        ASSERT_TRUE(hal_port_peek(pins[1], peeked, count));
        EXPECT_EQ(static_cast<std::uint8_t>(peeked[0]), seen);
        ASSERT_TRUE(round % 2 == 0 ? hal_port_read(pins[1], bytes, count)
                                   : hal_port_peek_commit(pins[1], count));
        seen = static_cast<std::uint8_t>(seen + count);
    }
    EXPECT_EQ(guard.calls(), 0U);
    ASSERT_TRUE(hal_port_write(pins[0], "abc", 3));
    hal_port_clear(pins[1]);
    EXPECT_EQ(hal_port_readable(pins[1]), 0U);
    ASSERT_TRUE(machine.hal().signals().unlink("ports.in"));
    EXPECT_EQ(hal_port_buffer_size(pins[1]), 0U);
}

TEST(CApi, SaysWhatIsWrong) {
    TestMachine machine;
    const UseInstance use(&machine.hal());
    EXPECT_EQ(hal_init(std::string(128, 'x').c_str()), -EINVAL);
    EXPECT_EQ(hal_link("a", "b"), -ENOENT);
    EXPECT_EQ(machine.messages.lines.back(), "HAL: there is no pin 'a'");
    EXPECT_EQ(hal_signal_new("s", HAL_FLOAT), 0);
    EXPECT_EQ(hal_signal_new("s", HAL_FLOAT), -EEXIST);
    EXPECT_EQ(hal_create_thread("t", 1, 1), -EINVAL);
    EXPECT_EQ(rtapi_set_msg_level(99), -EINVAL);
}

}  // namespace
}  // namespace mw::hal
