// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "clients/schedule/scheduler.hh"

namespace mw::schedule {
namespace {

Job job(int priority, int tag, const char *file = "a.ngc") {
    Job made;
    made.priority = priority;
    made.tag = tag;
    made.file = file;
    return made;
}

std::string order_of(const Queue &queue) {
    std::string tags;
    for (const Job &one : queue.jobs()) {
        tags += (tags.empty() ? "" : " ") + std::to_string(one.tag);
    }
    return tags;
}

TEST(ScheduleQueue, TheLowestPriorityComesFirstAndOfEqualsTheOlder) {
    Queue queue;
    ASSERT_TRUE(queue.add(job(5, 1)).has_value());
    ASSERT_TRUE(queue.add(job(3, 2)).has_value());
    ASSERT_TRUE(queue.add(job(5, 3)).has_value());
    EXPECT_EQ(order_of(queue), "2 1 3");
    EXPECT_TRUE(queue.set_priority(2, 5));
    EXPECT_EQ(order_of(queue), "1 3 2");
    EXPECT_TRUE(queue.remove(3));
    EXPECT_FALSE(queue.remove(3));
    EXPECT_EQ(order_of(queue), "1 2");
}

TEST(ScheduleQueue, TagsAreGivenAndUnique) {
    Queue queue;
    ASSERT_TRUE(queue.set_last_auto_tag(10).has_value());
    ASSERT_TRUE(queue.add(job(1, 12)).has_value());
    ASSERT_TRUE(queue.add(job(1, 0)).has_value());
    ASSERT_TRUE(queue.add(job(1, 0)).has_value());
    EXPECT_EQ(order_of(queue), "12 11 13") << "a tag that another has is passed over";
    EXPECT_FALSE(queue.add(job(1, 12)).has_value());
    ASSERT_TRUE(queue.set_last_auto_tag(Queue::MAX_TAG - 1).has_value());
    EXPECT_TRUE(queue.add(job(1, 0)).has_value());
    EXPECT_FALSE(queue.add(job(1, 0)).has_value()) << "no tag is left";
}

TEST(ScheduleQueue, WhatIsOutOfRangeIsRefused) {
    Queue queue;
    Job bad = job(1, 0);
    bad.zone = 10;
    EXPECT_FALSE(queue.add(bad).has_value());
    bad = job(1, 0);
    bad.feed_percent = -1;
    EXPECT_FALSE(queue.add(bad).has_value());
    bad = job(1, 0);
    bad.tool = -1;
    EXPECT_FALSE(queue.add(bad).has_value());
    EXPECT_FALSE(queue.add(job(1, -4)).has_value());
    EXPECT_FALSE(queue.add(job(1, 0, "")).has_value());
    EXPECT_TRUE(queue.jobs().empty());
}

TEST(ScheduleQueue, TheChecksumTellsTheOrder) {
    Queue one, other;
    EXPECT_EQ(one.checksum(), 0U);
    ASSERT_TRUE(one.add(job(1, 1)).has_value() && one.add(job(1, 2)).has_value());
    ASSERT_TRUE(other.add(job(1, 2)).has_value() && other.add(job(1, 1)).has_value());
    EXPECT_NE(one.checksum(), other.checksum());
    EXPECT_TRUE(other.set_priority(2, 2));
    EXPECT_EQ(one.checksum(), other.checksum());
}

}  // namespace
}  // namespace mw::schedule
