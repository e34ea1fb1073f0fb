// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "kinematics/linear_solve.hh"

namespace mw::kinematics {
namespace {

TEST(LinearSolve, FindsTheSolutionWhateverTheOrderOfTheRows) {
    const Square<3> m{Row<3>{0, 2, 1}, Row<3>{3, 0, 0}, Row<3>{0, 0, -4}};
    Row<3> right{8, 3, -8};  // right side for x = 1, 3, 2
    EXPECT_NEAR(solve(m, right), 0.5, 1e-15);
    EXPECT_NEAR(right[0], 1, 1e-15);
    EXPECT_NEAR(right[1], 3, 1e-15);
    EXPECT_NEAR(right[2], 2, 1e-15);
}

TEST(LinearSolve, TellsTheSignOfTheDeterminant) {
    const auto turn_of = [](const Square<3> &m) {
        Row<3> right{};
        int turn = 7;
        solve(m, right, turn);
        return turn;
    };
    EXPECT_EQ(turn_of({Row<3>{1, 0, 0}, Row<3>{0, 1, 0}, Row<3>{0, 0, 1}}), 1);
    EXPECT_EQ(turn_of({Row<3>{0, 1, 0}, Row<3>{1, 0, 0}, Row<3>{0, 0, 1}}), -1) << "two rows swapped";
    EXPECT_EQ(turn_of({Row<3>{0, 1, 0}, Row<3>{0, 0, 2}, Row<3>{3, 0, 0}}), 1) << "all three";
    EXPECT_EQ(turn_of({Row<3>{0, 2, 1}, Row<3>{3, 0, 0}, Row<3>{0, 0, -4}}), 1) << "24";
    EXPECT_EQ(turn_of({Row<3>{1, 2, 3}, Row<3>{4, 5, 6}, Row<3>{7, 8, 10}}), -1) << "-3";
    EXPECT_EQ(turn_of({Row<3>{1, 2, 3}, Row<3>{2, 4, 6}, Row<3>{7, 8, 10}}), 0);
}

TEST(LinearSolve, SaysWhenThereIsNone) {
    Row<2> right{1, 2};
    EXPECT_EQ(solve(Square<2>{Row<2>{1, 2}, Row<2>{2, 4}}, right), 0);
    EXPECT_EQ(solve(Square<2>{Row<2>{1, NAN}, Row<2>{2, 4}}, right), 0);
}

}  // namespace
}  // namespace mw::kinematics
