// SPDX-License-Identifier: GPL-2.0-or-later
// Tests task's side of the motion channels with a realtime process in parallel.
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "machine/task/link/motion_link.hh"

namespace mw::task {
namespace {

/// In another process the servo thread answers in its cycle and publishes the snapshot at the end of it: task
/// may see the answer with the previous snapshot.
TEST(MotionLink, AnAnswerCountsFromASnapshotThatKnowsOfIt) {
    auto channels = std::make_unique_for_overwrite<motion::Channels>();
    motion::Status status;
    status.cycle = 10;
    channels->status.write(status);
    MotionLink link(*channels);
    const motion::CommandId id = link.send(motion::SetMode{motion::Mode::COORD});
    link.update();
    EXPECT_FALSE(link.isAnswered(id));

    channels->servo_answers.push({id});  // during cycle 11
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
    auto channels = std::make_unique_for_overwrite<motion::Channels>();
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

/// Answers of the realtime side to all pending commands: a rejection for each that the predicate selects.
int answer_all(motion::Channels &channels, motion::Status &status,
               const std::function<bool(const motion::Command &)> &refuse) {
    int count = 0;
    motion::Command command;
    while (channels.immediate.pop(command)) {
        const auto *point = std::get_if<motion::LoadCompensation>(&command.body);
        const bool rejected = refuse(command);
        channels.servo_answers.push(
            {.id = command.id,
             .kind = rejected ? motion::AnswerKind::REFUSED : motion::AnswerKind::DONE,
             .reason = rejected ? motion::Reason::SWITCHED_ON : motion::Reason::NONE,
             .index = static_cast<std::int16_t>(point != nullptr ? point->joint : 0)});
        status.last_immediate_id = command.id;
        count += point != nullptr ? 1 : 0;
    }
    ++status.cycle;
    channels.status.write(status);
    return count;
}

std::vector<motion::LoadCompensation> table_of(int joint, int count) {
    std::vector<motion::LoadCompensation> points;
    for (int n = 0; n < count; ++n) {
        points.push_back({joint, n, count, static_cast<double>(n), 0, 0});
    }
    return points;
}

TEST(MotionLink, ALongTableLeavesRoomForACommandThatComesLater) {
    auto channels = std::make_unique_for_overwrite<motion::Channels>();
    MotionLink link(*channels);
    motion::Status status;
    link.send_table(table_of(0, 10000));
    link.send_table(table_of(1, 10000));
    const motion::CommandId stop = link.send(motion::Disable{});
    int taken = 0;
    int updates = 0;
    for (; !link.areTablesAnswered() && updates < 1000; ++updates) {
        EXPECT_TRUE(link.update().refused.empty());
        EXPECT_LT(channels->immediate.size(), 300U);
        taken += answer_all(*channels, status, [](const motion::Command &) { return false; });
        EXPECT_TRUE(updates == 0 || link.isAnswered(stop)) << "it has not waited for the tables";
    }
    EXPECT_EQ(taken, 20000);
    EXPECT_LT(updates, 100);
}

TEST(MotionLink, ATableThatIsRefusedIsToldOnceAndTheRestStaysHere) {
    auto channels = std::make_unique_for_overwrite<motion::Channels>();
    MotionLink link(*channels);
    motion::Status status;
    link.send_table(table_of(0, 10000));
    link.send_table(table_of(1, 500));
    int taken = 0;
    std::size_t told = 0;
    for (int n = 0; n < 100 && !link.areTablesAnswered(); ++n) {
        told += link.update().refused.size();
        taken += answer_all(*channels, status, [](const motion::Command &c) {
            const auto *point = std::get_if<motion::LoadCompensation>(&c.body);
            return point != nullptr && point->joint == 0 && point->index > 100;
        });
    }
    EXPECT_TRUE(link.areTablesAnswered());
    EXPECT_EQ(told, 1U);
    EXPECT_LT(taken, 1100);
    EXPECT_GT(taken, 600) << "the other table has come through";
}

}  // namespace
}  // namespace mw::task
