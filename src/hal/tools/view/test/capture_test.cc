// SPDX-License-Identifier: GPL-2.0-or-later
// Records made under the virtual clock (requirement B7).
#include <cmath>

#include "components/test/bench.hh"
#include "hal/tools/view/capture.hh"

namespace mw::hal::view {
namespace {

using components::test::Bench;

constexpr const char *SIGGEN = "loadrt siggen\naddf siggen.0.update t\nsetp siggen.0.frequency 10\n"
                               "net wave siggen.0.sine\n";

CaptureRecord recorded(Bench &bench, Capture &capture, const CaptureRequest &request, int periods) {
    const Result<> begun = capture.begin(request);
    EXPECT_TRUE(begun) << begun.error().str();
    bench.pass(periods);
    EXPECT_EQ(capture.state(), CaptureState::DONE);
    auto record = capture.record();
    EXPECT_TRUE(record);
    return record.value_or(CaptureRecord{});
}

TEST(Capture, RecordsAtOnceWithoutTrigger) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture) << capture.error().str();
    const CaptureRecord record =
        recorded(bench, *capture, {{"wave", "siggen.0.square", "siggen.0.clock"}, 50}, 60);
    ASSERT_EQ(record.times_s.size(), 50U);
    ASSERT_EQ(record.columns.size(), 3U);
    EXPECT_EQ(record.types[2], Type::BIT);
    for (std::size_t i = 1; i < 50; ++i) {
        EXPECT_NEAR(record.times_s[i] - record.times_s[i - 1], 0.001, 1e-12);
        // A sine of 10 Hz and amplitude 1 changes by at most 2 pi 10 * 1 ms.
        EXPECT_LE(std::abs(record.columns[0][i] - record.columns[0][i - 1]), 0.0629);
    }
    EXPECT_TRUE(record.moved.empty());
}

TEST(Capture, TriggersAtTheEdgeWithWhatWasBefore) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "t");
    ASSERT_TRUE(capture);
    for (const TriggerKind kind : {TriggerKind::RISING, TriggerKind::FALLING}) {
        const CaptureRecord record =
            recorded(bench, *capture, {{"wave"}, 40, 1, kind, "wave", 0.5, 0.25}, 300);
        ASSERT_EQ(record.columns.size(), 1U);
        const std::vector<double> &wave = record.columns[0];
        EXPECT_EQ(record.times_s[10], 0.0);
        const bool rising = kind == TriggerKind::RISING;
        EXPECT_EQ(wave[9] > 0.5, !rising);
        EXPECT_EQ(wave[10] > 0.5, rising);
        EXPECT_NEAR(record.times_s[0], -0.010, 1e-12);
    }
}

TEST(Capture, LevelTriggersNeedNoEdge) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    const CaptureRecord above = recorded(
        bench, *capture, {{"siggen.0.cosine"}, 10, 1, TriggerKind::ABOVE, "siggen.0.cosine", -2.0, 0.5}, 10);
    EXPECT_EQ(above.times_s[5], 0.0);
    const CaptureRecord below =
        recorded(bench, *capture, {{"wave"}, 10, 1, TriggerKind::BELOW, "wave", -0.99, 0.0}, 200);
    EXPECT_LT(below.columns[0][0], -0.99);
}

TEST(Capture, EveryNthPeriodMakesALongerRecord) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    const CaptureRecord record = recorded(bench, *capture, {{"wave"}, 20, 5}, 100);
    EXPECT_NEAR(record.times_s[19], 19 * 0.005, 1e-12);
}

TEST(Capture, TriggerThatIsNoChannelBecomesOne) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    const CaptureRecord record =
        recorded(bench, *capture, {{"wave"}, 20, 1, TriggerKind::EITHER, "siggen.0.square", 0.0, 0.5}, 200);
    ASSERT_EQ(record.names, (std::vector<std::string>{"wave", "siggen.0.square"}));
    EXPECT_LT(record.columns[1][9] * record.columns[1][10], 0.0);
}

TEST(Capture, ForceEndsTheWaitAndCancelTheRecord) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    const CaptureRequest never{{"wave"}, 20, 1, TriggerKind::ABOVE, "wave", 99.0, 0.5};
    ASSERT_TRUE(capture->begin(never));
    bench.pass(100);
    EXPECT_EQ(capture->state(), CaptureState::WAITING);
    EXPECT_FALSE(capture->record());
    capture->force();
    bench.pass(20);
    EXPECT_EQ(capture->state(), CaptureState::DONE);
    ASSERT_TRUE(capture->begin(never));
    bench.pass(100);
    capture->cancel();
    bench.pass(1);
    EXPECT_EQ(capture->state(), CaptureState::IDLE);
}

TEST(Capture, SaysWhichNamesMoved) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    ASSERT_TRUE(capture->begin({{"siggen.0.sine", "siggen.0.cosine"}, 20}));
    bench.pass(5);
    bench.run("net other siggen.0.cosine\n");
    bench.pass(30);
    const auto record = capture->record();
    ASSERT_TRUE(record);
    EXPECT_EQ(record->moved, (std::vector<std::string>{"siggen.0.cosine"}));
}

TEST(Capture, RefusesWhatCannotBe) {
    Bench bench(SIGGEN);
    auto capture = Capture::open(*bench.host, "");
    ASSERT_TRUE(capture);
    EXPECT_NE(capture->begin({{"siggen.0.sin"}, 10}).error().str().find("did you mean 'siggen.0.sine'"),
              std::string::npos);
    EXPECT_FALSE(capture->begin({{}, 10}));
    EXPECT_FALSE(capture->begin({std::vector<std::string>(17, "wave"), 10}));
    EXPECT_FALSE(capture->begin({{"wave"}, 0}));
    EXPECT_FALSE(capture->begin({{"wave"}, 1U << 20U}));
    EXPECT_FALSE(capture->begin({{"wave"}, 10, 0}));
    EXPECT_FALSE(capture->begin({{"wave"}, 10, 1, TriggerKind::RISING, "wave", 0.0, 1.0}));
    EXPECT_FALSE(Capture::open(*bench.host, "no-thread"));
}

TEST(Capture, LeavesTheThreadAsItWas) {
    Bench bench(SIGGEN);
    const auto functions = [&] { return bench.hal().threads().list()[0].functions; };
    const auto before = functions();
    {
        auto capture = Capture::open(*bench.host, "");
        ASSERT_TRUE(capture);
        EXPECT_EQ(functions().size(), before.size() + 1);
    }
    EXPECT_EQ(functions(), before);
    bench.run("addf capture.sample t\n");
    {
        auto capture = Capture::open(*bench.host, "");
        ASSERT_TRUE(capture);
    }
    EXPECT_EQ(functions().size(), before.size() + 1);
}

TEST(Capture, CsvHasTimesAndEveryDigit) {
    CaptureRecord record{{"a", "b"}, {Type::FLOAT, Type::BIT}, {-0.001, 0.0}, {{0.1, 1.0 / 3.0}, {0, 1}}, {}};
    EXPECT_EQ(to_csv(record), "time_s,a,b\n-0.001000000,0.1,0\n0.000000000,0.3333333333333333,1\n");
}

}  // namespace
}  // namespace mw::hal::view
