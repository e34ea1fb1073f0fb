// SPDX-License-Identifier: GPL-2.0-or-later
// Checks that the judge of turned stock finds faults and accepts correct parts.
#include <gtest/gtest.h>

#include "tests/support/stock/lathe_stock.hh"

namespace mw::testing {
namespace {

/// A step: 5 high up to u 10, then a wall to 9, then flat to 20.
Contour step() {
    Contour contour;
    contour.strokes = {{{0, 5}, {10, 5}, false, {}, false},
                       {{10, 5}, {10, 9}, false, {}, false},
                       {{10, 9}, {20, 9}, false, {}, false}};
    return contour;
}

StockMove line(bool rapid, Place from, Place to) {
    return {rapid, {from, to, false, {}, false}};
}

class LatheStockTest : public ::testing::Test {
  protected:
    /// Cuts everything above the allowance of 0.5 except the flat after the step.
    void turn_step() {
        for (const double h : {10.0, 8.0, 6.0, 5.5}) {
            EXPECT_EQ(stock.cut(line(false, {-1, h}, {h > 9.6 ? 21.0 : 9.5, h}), rules), "") << h;
        }
        EXPECT_EQ(stock.cut({false, {{9.5, 9}, {10, 9.5}, true, {10, 9}, false}}, rules), "");
    }

    Contour contour = step();
    LatheStock stock{contour, 12.0, 1.0};
    CutRules rules{.allowance = 0.5, .step = 2.0, .skin = 0.0};
};

TEST_F(LatheStockTest, RapidMovesInMaterialAreFound) {
    EXPECT_EQ(stock.cut(line(true, {-2, 14}, {-1, 8}), rules), "");
    EXPECT_NE(stock.cut(line(true, {-1, 8}, {3, 11}), rules).find("rapid in stock"), std::string::npos);
    EXPECT_NE(stock.cut(line(true, {5, 13}, {5, 11}), rules).find("rapid in stock"), std::string::npos);
    EXPECT_EQ(stock.cut(line(true, {5, 13}, {9, 12}), rules), "");
}

TEST_F(LatheStockTest, LayersDeeperThanAskedAreFound) {
    EXPECT_EQ(stock.cut(line(false, {-1, 10}, {20, 10}), rules), "");
    EXPECT_EQ(stock.surface_at(15), 10.0);
    EXPECT_EQ(stock.cut(line(false, {-1, 8}, {9.4, 8}), rules), "");
    EXPECT_NE(stock.cut(line(false, {-1, 5.6}, {9, 5.6}), rules).find("layer 2.4"), std::string::npos);
    EXPECT_NE(stock.cut(line(false, {5, 13}, {5, 5.7}), rules).find("plunge"), std::string::npos);
}

TEST_F(LatheStockTest, GougesAndSpoiledAllowancesAreFound) {
    EXPECT_EQ(stock.cut(line(false, {-1, 10}, {21, 10}), rules), "");
    EXPECT_NE(stock.cut(line(false, {-1, 10}, {8, 5.4}), rules).find("gouge"), std::string::npos);
    EXPECT_NE(stock.cut(line(false, {-1, 8}, {9.6, 8}), rules).find("gouge"), std::string::npos);
    EXPECT_NE(stock.cut(line(false, {-1, 10}, {19.9, 9.4}), rules).find("gouge"), std::string::npos);
    EXPECT_NE(stock.cut(line(true, {5, 13}, {5, 4}), rules).find("gouge"), std::string::npos);
}

TEST_F(LatheStockTest, WorkNotDoneIsFound) {
    EXPECT_NE(stock.unfinished(0.5, false, 0.5), "");
    turn_step();
    EXPECT_NE(stock.unfinished(0.5, false, 0.5), "") << "the flat behind the step is 1 high";
    EXPECT_EQ(stock.cut(line(false, {10, 9.5}, {21, 9.5}), rules), "");
    EXPECT_EQ(stock.unfinished(0.5, false, 0.5), "");
    EXPECT_NE(stock.unfinished(0.0, false, 0.0), "");
}

TEST_F(LatheStockTest, TheSkinOfTheCycleBeforeMayGoInOnePass) {
    turn_step();
    CutRules finish{.allowance = 0.0, .step = 0.0, .skin = 0.5};
    EXPECT_EQ(stock.cut(line(false, {-1, 5}, {10, 5}), finish), "");
    EXPECT_NE(stock.cut(line(false, {10, 9}, {19, 9}), finish).find("layer"), std::string::npos)
        << "1 mm is left there";
}

TEST_F(LatheStockTest, ArcsAreCutWhereTheyAre) {
    const StockMove arc{false, {{-1, 11}, {3, 11}, true, {1, 11}, true}};
    rules.step = 3.5;
    EXPECT_EQ(stock.cut(arc, rules), "");
    EXPECT_NEAR(stock.surface_at(1.0), 9.0, 0.001);
    EXPECT_NEAR(stock.surface_at(2.0), 11.0 - std::sqrt(3.0), 0.02);  // the width of a column
}

TEST(Contour, DistancesAndHeightsAreThoseOfLinesAndArcs) {
    Contour contour;
    contour.strokes = {{{0, 5}, {2, 3}, true, {2, 5}, true}, {{2, 3}, {6, 3}, false, {}, false}};
    EXPECT_NEAR(contour.height(1.0), 5.0 - std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(contour.height(4.0), 3.0, 1e-12);
    EXPECT_NEAR(contour.distance({2, 4}), 1.0, 1e-12);
    EXPECT_NEAR(contour.distance({8, 3}), 2.0, 1e-12);
    EXPECT_LT(contour.clearance({3, 2.5}), 0.0);
    EXPECT_NEAR(contour.highest(), 5.0, 1e-12);
}

}  // namespace
}  // namespace mw::testing
