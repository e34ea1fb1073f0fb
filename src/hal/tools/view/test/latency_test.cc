// SPDX-License-Identifier: GPL-2.0-or-later
#include <filesystem>

#include "components/test/bench.hh"
#include "hal/tools/view/latency.hh"

namespace mw::hal::view {
namespace {

TEST(LatencySlot, CountsDeviationsFromThePeriod) {
    static LatencySlot slot;
    slot.period_ns = 1000;
    slot.bin_ns = 10;
    for (const std::int64_t interval : {1000, 1005, 995, 1500, 1'000'000, -20'000}) {
        count_interval(slot, interval);
    }
    EXPECT_EQ(slot.intervals.load(), 6U);
    EXPECT_EQ(slot.bins[LATENCY_BINS / 2].load(), 2U);      // 0 and 5
    EXPECT_EQ(slot.bins[LATENCY_BINS / 2 - 1].load(), 1U);  // -5
    EXPECT_EQ(slot.bins[LATENCY_BINS / 2 + 50].load(), 1U);
    EXPECT_EQ(slot.above.load(), 1U);
    EXPECT_EQ(slot.below.load(), 1U);
    EXPECT_EQ(slot.min_ns.load(), -20'000);
    EXPECT_EQ(slot.max_ns.load(), 1'000'000);
}

TEST(Latency, VirtualThreadsAreExact) {
    runtime::VirtualScheduler clock;
    InstanceOptions options;
    options.name = "latency-test";
    options.scheduler = &clock;
    auto host = LocalHost::create(options);
    ASSERT_TRUE(host);
    const std::vector<LatencyThread> threads{{"base", 50'000, 100}, {"servo", 1'000'000, 1000}};
    const Result<> started = start_latency(**host, threads);
    ASSERT_TRUE(started) << started.error().str();
    clock.run_until(100'000'000);
    const auto figures = read_latency((*host)->hal(), threads);
    ASSERT_TRUE(figures);
    ASSERT_EQ(figures->size(), 2U);
    EXPECT_NEAR(static_cast<double>((*figures)[0].intervals), 1999, 1);
    EXPECT_NEAR(static_cast<double>((*figures)[1].intervals), 99, 1);
    for (const LatencyFigures &f : *figures) {
        EXPECT_EQ(f.jitter_ns(), 0);
        EXPECT_EQ(f.bins[LATENCY_BINS / 2], f.intervals);
    }
    EXPECT_NE(latency_table(*figures).find("servo       1000000"), std::string::npos);
    EXPECT_NE(latency_bars((*figures)[1]).find("0.0 us"), std::string::npos);
    const auto path = std::filesystem::temp_directory_path() / ("lat" + std::to_string(::getpid()) + ".png");
    EXPECT_TRUE(draw_latency(*figures, "note", path));
    EXPECT_TRUE(std::filesystem::remove(path));
}

TEST(Latency, PeriodsHaveUnits) {
    EXPECT_EQ(parse_period("25us").value_or(0), 25'000);
    EXPECT_EQ(parse_period("1ms").value_or(0), 1'000'000);
    EXPECT_EQ(parse_period("0.001s").value_or(0), 1'000'000);
    EXPECT_EQ(parse_period("25000").value_or(0), 25'000);
    for (const char *bad : {"", "us", "10", "5s", "x", "1hs", "-1ms", "nan"}) {
        EXPECT_FALSE(parse_period(bad)) << bad;
    }
}

}  // namespace
}  // namespace mw::hal::view
