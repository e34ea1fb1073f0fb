// SPDX-License-Identifier: GPL-2.0-or-later
// Task's side of the motion channels against a realtime process that runs beside it.
#include <memory>

#include <gtest/gtest.h>

#include "task/link/motion_link.hh"

namespace mw::task {
namespace {

/// In another process the servo thread answers within its cycle and publishes its snapshot at the end of it:
/// task may see the answer with the snapshot of before.
TEST(MotionLink, AnAnswerCountsFromASnapshotThatKnowsOfIt_C10) {
    auto channels = std::make_unique<motion::Channels>();
    motion::Status status;
    status.cycle = 10;
    channels->status.write(status);
    MotionLink link(*channels);
    const motion::CommandId id = link.send(motion::SetMode{motion::Mode::COORD});
    link.update();
    EXPECT_FALSE(link.isAnswered(id));

    channels->servo_answers.push({id});  // cycle 11 is under way
    link.update();
    EXPECT_FALSE(link.isAnswered(id)) << "the snapshot is still that of cycle 10";
    EXPECT_EQ(link.status().cycle, 10U);

    status.cycle = 11;
    status.mode = motion::Mode::COORD;
    status.last_immediate_id = id;
    channels->status.write(status);
    link.update();
    EXPECT_TRUE(link.isAnswered(id));
    EXPECT_EQ(link.status().mode, motion::Mode::COORD);
}

TEST(MotionLink, ASnapshotAloneIsNoAnswer) {
    auto channels = std::make_unique<motion::Channels>();
    MotionLink link(*channels);
    const motion::CommandId first = link.send(motion::Enable{}), second = link.send(motion::Disable{});
    motion::Status status;
    status.last_immediate_id = second;
    channels->status.write(status);
    channels->servo_answers.push({first});
    link.update();
    EXPECT_TRUE(link.isAnswered(first));
    EXPECT_FALSE(link.isAnswered(second));
}

}  // namespace
}  // namespace mw::task
