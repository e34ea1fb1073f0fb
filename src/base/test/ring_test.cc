// SPDX-License-Identifier: GPL-2.0-or-later
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "base/patient_read.hh"
#include "base/seqlock.hh"
#include "base/spsc_ring.hh"

namespace mw {
namespace {

TEST(SpscRing, RefusesWhenFullAndKeepsOrder) {
    SpscRing<int, 4> ring;
    for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(ring.push(i));
    }
    EXPECT_FALSE(ring.push(4));
    int value = -1;
    for (int i = 0; i < 4; ++i) {
        ASSERT_TRUE(ring.pop(value));
        EXPECT_EQ(value, i);
    }
    EXPECT_FALSE(ring.pop(value));
}

TEST(SpscRing, TwoThreadsLoseNothing) {
    auto ring = std::make_unique<SpscRing<int, 64>>();
    constexpr int COUNT = 100000;
    std::thread producer([&ring] {
        for (int i = 0; i < COUNT;) {
            i += ring->push(i) ? 1 : 0;
        }
    });
    int value = 0;
    for (int expected = 0; expected < COUNT;) {
        if (ring->pop(value)) {
            ASSERT_EQ(value, expected);
            ++expected;
        }
    }
    producer.join();
}

TEST(Seqlock, ReadersNeverSeeAMixture) {
    struct Snapshot {
        std::int64_t a[5];
    };
    auto lock = std::make_unique<Seqlock<Snapshot>>();
    std::atomic<bool> done{false};
    std::jthread writer([&] {
        for (std::int64_t i = 0; i < 50000; ++i) {
            lock->write({{i, i, i, i, i}});
        }
        done = true;
    });
    // At least one read after the last write, independent of scheduling.
    Snapshot seen{};
    for (bool last = false; !last;) {
        last = done;
        ASSERT_TRUE(read_patiently(*lock, seen, std::chrono::seconds(10)));
        for (const std::int64_t v : seen.a) {
            ASSERT_EQ(v, seen.a[0]);
        }
    }
    EXPECT_EQ(seen.a[0], 49999);
}

}  // namespace
}  // namespace mw
