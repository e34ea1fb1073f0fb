// SPDX-License-Identifier: GPL-2.0-or-later
// The pins motion.tooloffset.*: the I/O controller writes them, in the servo thread of the loaded motmod.
#include <atomic>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "machine/io/pins.hh"
#include "motion/interface/channels.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::motion {
namespace {

class ToolOffsetPins : public ::testing::Test {
  protected:
    ToolOffsetPins() {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        host = std::move(*hal::LocalHost::create(options, {MW_MODULE_FOLDER}));
        EXPECT_TRUE(io.create(hal()).has_value());
    }
    ~ToolOffsetPins() override { io.destroy(); }
    hal::Instance &hal() { return host->hal(); }
    void load() {
        ASSERT_TRUE(host->load_realtime("trivkins", {}).has_value());
        ASSERT_TRUE(host->load_realtime("motmod", {"num_joints=3"}).has_value());
        ASSERT_TRUE(hal().threads().add_function("motion-command-handler", "servo-thread"));
        ASSERT_TRUE(hal().threads().add_function("motion-controller", "servo-thread"));
        ASSERT_TRUE(hal().threads().start());
        ASSERT_TRUE(io.join_tool_offset().has_value());
        channels =
            static_cast<Channels *>(*hal().memory().shared_block(Channels::SHMEM_KEY, sizeof(Channels)));
    }
    void write(const geometry::Pose &pose) {
        io::Outputs outputs;
        outputs.tool_offset = pose;
        io.write(outputs);
    }
    void run_cycle() { clock.run_until(clock.now_ns() + 1000000); }
    geometry::Pose shown() {
        geometry::Pose pose;
        for (int i = 0; i < MAX_AXES; ++i) {
            pose[i] = hal()
                          .values()
                          .get(std::string("motion.tooloffset.") + geometry::AXIS_LETTERS_LOWER[i])
                          ->as_number();
        }
        return pose;
    }

    const geometry::Pose offset{{1, -2, 3, 4, 5, 6, 7, 8, 9.5}};
    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    io::Pins io;
    Channels *channels = nullptr;
};

TEST_F(ToolOffsetPins, AreMadeWithMotmodAndAreZero) {
    EXPECT_FALSE(hal().pins().has("motion.tooloffset.z"));
    ASSERT_NO_FATAL_FAILURE(load());
    EXPECT_EQ(hal().pins().list("motion.tooloffset.*").size(), std::size_t{MAX_AXES});
    EXPECT_EQ(hal().pins().find("motion.tooloffset.z")->dir, hal::Dir::OUT);
    EXPECT_EQ(shown().c, geometry::Pose{}.c);
}

TEST_F(ToolOffsetPins, ShowWhatTheIoControllerWritesAndNotWhatMotionIsSent) {
    ASSERT_NO_FATAL_FAILURE(load());
    write(offset);
    EXPECT_FALSE(io.read().tool_offset_shown);
    EXPECT_EQ(shown().c, geometry::Pose{}.c) << "they change between two cycles of the servo thread";
    run_cycle();
    EXPECT_TRUE(io.read().tool_offset_shown);
    EXPECT_EQ(shown().c, offset.c);
    channels->immediate.push({1, 1, SetToolOffset{{{0, 0, 77}}}});
    run_cycle();
    ASSERT_FALSE(channels->servo_answers.isEmpty());
    EXPECT_EQ(shown().c, offset.c);
}

TEST_F(ToolOffsetPins, KeepTheirValuesWhenTheTaskProcessIsDead) {
    ASSERT_NO_FATAL_FAILURE(load());
    write(offset);
    run_cycle();
    channels->isTaskDead = 1;
    io.destroy();  // its pins disappear with the process
    ASSERT_FALSE(hal().pins().has("iocontrol.0.tool-number"));
    for (int i = 0; i < 1000; ++i) {
        run_cycle();
        ASSERT_EQ(shown().c, offset.c);
    }
}

TEST_F(ToolOffsetPins, KeepTheirValuesWhenTheTaskProcessDiesWithinAWrite) {
    ASSERT_NO_FATAL_FAILURE(load());
    write(offset);
    run_cycle();
    auto &block = *static_cast<io::ToolOffsetBlock *>(
        *hal().memory().shared_block(io::ToolOffsetBlock::SHMEM_KEY, sizeof(io::ToolOffsetBlock)));
    write({{100, 200, 300}});
    // The sequence number comes first; an odd value means that a write is in progress.
    std::atomic_ref(*reinterpret_cast<std::uint32_t *>(&block.latest)).fetch_sub(1);
    for (int i = 0; i < 3; ++i) {
        run_cycle();
        EXPECT_EQ(shown().c, offset.c);
        EXPECT_FALSE(io.read().tool_offset_shown);
    }
}

/// A signal with a reader keeps its value when a writer is linked.
TEST_F(ToolOffsetPins, AreSeenInTheCycleAfterTheyWereLinked) {
    ASSERT_NO_FATAL_FAILURE(load());
    write(offset);
    run_cycle();
    ASSERT_TRUE(hal().signals().net("length", {"motion.adaptive-feed"}).has_value());
    ASSERT_TRUE(hal().signals().net("length", {"motion.tooloffset.z"}).has_value());
    run_cycle();
    EXPECT_EQ(hal().values().get("motion.adaptive-feed")->as_number(), 3);
}

TEST_F(ToolOffsetPins, NobodyWaitsForThemWhereMotmodIsNotLoaded) {
    ASSERT_TRUE(io.join_tool_offset().has_value());
    write(offset);
    EXPECT_TRUE(io.read().tool_offset_shown) << "motion-logger replaces motmod";
}

}  // namespace
}  // namespace mw::motion
