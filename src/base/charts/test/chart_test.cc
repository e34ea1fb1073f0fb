// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/charts/chart.hh"

namespace mw::charts {
namespace {

class ChartTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() /
                 ("chart" + std::to_string(::getpid()) +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::string read(const std::string &name) const {
        std::ifstream in(folder / name);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    std::filesystem::path folder;
};

TEST(Ticks, AreRoundAndInside) {
    EXPECT_EQ(round_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(round_ticks(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
    const std::vector<double> fine = round_ticks(0.13, 0.31, 2);
    ASSERT_EQ(fine.size(), 2U);
    EXPECT_NEAR(fine[1], 0.3, 1e-12);
}

TEST_F(ChartTest, StripsShowEveryCurve) {
    StripChart chart;
    chart.title = "capture";
    for (int i = 0; i < 100; ++i) {
        chart.times_s.push_back(i * 0.001);
    }
    chart.curves = {{"siggen.0.sine", std::vector<double>(100, 0.5), false},
                    {"and2.0.out", std::vector<double>(100, 1.0), true},
                    {"broken", std::vector<double>(100, NAN), false}};
    chart.trigger_s = 0.05;
    ASSERT_TRUE(draw_strips(chart, folder / "a.svg"));
    // Names are drawn as glyphs. Each strip has a frame, so more curves make a taller picture.
    const std::string three = read("a.svg");
    EXPECT_NE(three.find("<svg"), std::string::npos);
    chart.curves.pop_back();
    ASSERT_TRUE(draw_strips(chart, folder / "b.svg"));
    EXPECT_LT(read("b.svg").size(), three.size());
    ASSERT_TRUE(draw_strips(chart, folder / "a.png"));
    EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
}

TEST_F(ChartTest, BadPathsAreRefused) {
    EXPECT_NE(draw_strips({}, folder / "a.gif").error().str().find(".png or .svg"), std::string::npos);
    EXPECT_FALSE(draw_strips({}, folder / "no" / "such" / "a.png"));
    EXPECT_FALSE(draw_histograms({}, folder / "no" / "such" / "a.svg"));
}

TEST_F(ChartTest, HistogramsStandBelowEachOther) {
    Histogram histogram{"servo", -5, 1, "us", {0, 1, 10, 1000, 3}, 1, 2};
    // Bytes 20 to 23 of a PNG file: its height.
    const auto height = [this](const std::vector<Histogram> &all) {
        EXPECT_TRUE(draw_histograms(all, folder / "h.png"));
        const std::string png = read("h.png");
        EXPECT_EQ(png.substr(1, 3), "PNG");
        int value = 0;
        for (std::size_t i = 20; i < 24 && i < png.size(); ++i) {
            value = value * 256 + static_cast<unsigned char>(png[i]);
        }
        return value;
    };
    const int one = height({histogram}), two = height({histogram, histogram});
    EXPECT_GT(two, one);
    EXPECT_EQ(height({histogram, histogram, histogram}) - two, two - one);
    const std::string three_pictures = read("h.png");
    histogram.counts[3] = 0;
    ASSERT_TRUE(draw_histograms({histogram, histogram, histogram}, folder / "h.png"));
    EXPECT_NE(read("h.png"), three_pictures) << "the counts are drawn";
}

}  // namespace
}  // namespace mw::charts
