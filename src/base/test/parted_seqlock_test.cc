// SPDX-License-Identifier: GPL-2.0-or-later
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "base/parted_seqlock.hh"
#include "base/patient_read.hh"

namespace mw {
namespace {

using namespace std::chrono_literals;

struct Picture {
    std::int64_t head[2] = {7, 7};
    std::int64_t rows[3] = {1, 2, 3};
    std::int64_t tail[4] = {};
};
constexpr int HEAD = 0, ROWS = 1, TAIL = 4;
constexpr PartStarts<5> STARTS{0, 16, 24, 32, 40};
using Parted = PartedSeqlock<Picture, STARTS>;

constexpr PartMask bit(int part) {
    return part_range(part, 1);
}

TEST(PartedSeqlock, AReaderKeepsWhatItHadBeforeTheFirstWrite) {
    const Parted lock;
    Parted::Copy copy;
    EXPECT_TRUE(lock.read(copy));
    EXPECT_EQ(copy.fresh, 0U);
    EXPECT_EQ(copy.value.head[0], 7);
}

TEST(PartedSeqlock, TheFirstWriteTellsAllAndLaterOnesWhatIsNamed) {
    Parted lock;
    Parted::Copy copy;
    Picture picture;
    picture.rows[2] = 30;
    lock.write(picture, bit(HEAD));
    ASSERT_TRUE(lock.read(copy));
    EXPECT_EQ(copy.fresh, Parted::ALL);
    EXPECT_EQ(copy.value.rows[2], 30);
    ASSERT_TRUE(lock.read(copy));
    EXPECT_EQ(copy.fresh, 0U) << "nothing new";

    picture.rows[1] = 20;
    picture.tail[3] = 9;
    lock.write(picture, lock.changed(picture, Parted::ALL));
    ASSERT_TRUE(lock.read(copy));
    EXPECT_EQ(copy.fresh, bit(ROWS + 1) | bit(TAIL));
    EXPECT_EQ(copy.value.rows[1], 20);
    EXPECT_EQ(copy.value.tail[3], 9);
}

TEST(PartedSeqlock, AReaderThatHasMissedWritesGetsTheirPartsTogether) {
    Parted lock;
    Parted::Copy late, always;
    Picture picture;
    lock.write(picture);
    ASSERT_TRUE(lock.read(late) && lock.read(always));
    for (int i = 0; i < 3; ++i) {
        picture.rows[i] = 100 + i;
        lock.write(picture, bit(ROWS + i));
        ASSERT_TRUE(lock.read(always));
        EXPECT_EQ(always.fresh, bit(ROWS + i));
    }
    ASSERT_TRUE(lock.read(late));
    EXPECT_EQ(late.fresh, part_range(ROWS, 3));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(late.value.rows[i], 100 + i);
        EXPECT_EQ(always.value.rows[i], 100 + i);
    }
}

/// Each write moves one unit from a row to the next, and every few writes publish all rows. Rows of different
/// writes have a different sum.
TEST(PartedSeqlock, ReadersNeverSeePartsOfDifferentWrites) {
    auto lock = std::make_unique<Parted>();
    Picture picture;
    picture.rows[0] = picture.rows[1] = picture.rows[2] = 0;
    lock->write(picture);
    std::atomic<bool> done{false};
    std::jthread writer([&] {
        for (std::int64_t i = 0; i < 60000; ++i) {
            const auto from = static_cast<int>(i % 3);
            const int to = (from + 1) % 3;
            --picture.rows[from];
            ++picture.rows[to];
            lock->write(picture, i % 7 == 0 ? Parted::ALL : bit(ROWS + from) | bit(ROWS + to));
        }
        done = true;
    });
    Parted::Copy often, seldom;
    std::uint64_t reads = 0;
    for (bool last = false; !last; ++reads) {
        last = done;
        ASSERT_TRUE(read_patiently(*lock, often, 10s));
        ASSERT_EQ(often.value.rows[0] + often.value.rows[1] + often.value.rows[2], 0);
        if (reads % 5 == 0 || last) {
            ASSERT_TRUE(read_patiently(*lock, seldom, 10s));
            ASSERT_EQ(seldom.value.rows[0] + seldom.value.rows[1] + seldom.value.rows[2], 0);
        }
    }
    writer.join();
    EXPECT_EQ(often.value.rows[0], picture.rows[0]);
    EXPECT_EQ(seldom.value.rows[1], picture.rows[1]);
    EXPECT_EQ(seldom.sequence, 2 * 60001U);
}

}  // namespace
}  // namespace mw
