// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of loops in checks.
#include <gtest/gtest.h>

#include "gcode/interpreter/flow/loop_budget.hh"

namespace mw::gcode::detail {
namespace {

Settings with_budgets(std::uint64_t statements, std::uint64_t idle, double seconds) {
    Settings settings;
    settings.statement_budget = statements;
    settings.idle_budget = idle;
    settings.time_budget_s = seconds;
    return settings;
}

/// Number of statements accepted in a subroutine, at most 1000.
int count_taken(LoopBudget &budget) {
    int count = 0;
    while (count < 1000 && budget.take_statement(0)) {
        ++count;
    }
    return count;
}

TEST(LoopBudget, WithoutBudgetsNothingIsBounded) {
    LoopBudget budget(with_budgets(0, 0, 0));
    EXPECT_FALSE(budget.isBounded());
    EXPECT_EQ(count_taken(budget), 1000);
    budget.mark_progress(1e9);
    EXPECT_FALSE(budget.isSpent());
    EXPECT_FALSE(budget.isWatching());
}

TEST(LoopBudget, CountsAnewWhereTheProgramIsFurtherDown) {
    LoopBudget budget(with_budgets(10, 0, 0));
    EXPECT_EQ(count_taken(budget), 10);
    EXPECT_TRUE(budget.isSpent());
    EXPECT_TRUE(budget.take_statement(5));
    EXPECT_EQ(budget.furthest_line(), 5);
    EXPECT_EQ(count_taken(budget), 9) << "the statement in line 5 is one of them";
    EXPECT_FALSE(budget.take_statement(5)) << "the same line again is no progress";
    EXPECT_FALSE(budget.take_statement(4));
    EXPECT_TRUE(budget.take_statement(6));
}

TEST(LoopBudget, ProgressOfTheMachineRenewsTheIdleBudgetOnly) {
    LoopBudget budget(with_budgets(100, 10, 0));
    EXPECT_TRUE(budget.take_statement(1));
    for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(count_taken(budget), i == 0 ? 9 : 10) << i;
        budget.mark_progress(1);
    }
    // Rejected statements are counted, too, so the other budget is now exhausted.
    EXPECT_EQ(count_taken(budget), 1);
    EXPECT_TRUE(budget.isSpent());
}

TEST(LoopBudget, MachineTimeIsBounded) {
    LoopBudget budget(with_budgets(0, 0, 3600));
    EXPECT_TRUE(budget.take_statement(1));
    budget.mark_progress(2000);
    EXPECT_FALSE(budget.isSpent());
    EXPECT_TRUE(budget.isWatching()) << "more than half is used up";
    budget.mark_progress(2000);
    EXPECT_TRUE(budget.isSpent());
    EXPECT_EQ(budget.spend(), "1 hours of machine time");
}

TEST(LoopBudget, WhatIsSpentStaysSpentUntilTheRestart) {
    LoopBudget budget(with_budgets(10, 0, 0));
    count_taken(budget);
    EXPECT_EQ(budget.spend(), "10 statements");
    EXPECT_FALSE(budget.take_statement(99));
    budget.restart();
    EXPECT_TRUE(budget.take_statement(1));
}

TEST(LoopBudget, TheLongestLoopAroundALineIsTheOneThatDoesNotEnd) {
    LoopBudget budget(with_budgets(10, 0, 0));
    const Program *const none = nullptr;
    budget.note_pass({none, 1, 3, 9});
    budget.note_pass({none, 1, 5, 7});
    budget.note_pass({none, 2, 1, 20});
    const auto at6 = budget.loop_around(none, 1, 6);
    ASSERT_TRUE(at6);
    EXPECT_EQ(at6->first, 3);
    EXPECT_EQ(budget.loop_around(none, 2, 6)->last, 20);
    EXPECT_FALSE(budget.loop_around(none, 1, 10));
    EXPECT_FALSE(budget.loop_around(none, 0, 6));
    budget.restart();
    EXPECT_FALSE(budget.loop_around(none, 1, 6));
}

TEST(LoopBudget, TellsALoopWhosePassesAreAllTheSame) {
    const LoopPass pass{nullptr, 0, 3, 9};
    State state;
    Parameters same;
    LoopBudget budget(with_budgets(1000000, 0, 0));
    int passes = 0;
    while (passes < 1000 && !budget.isRepeating(pass, state, same)) {
        ++passes;
    }
    EXPECT_LT(passes, 1000);
    // A change of one number, one mode or one name is sufficient.
    for (int what = 0; what < 3; ++what) {
        Names names;
        State changing;
        Parameters parameters;
        LoopBudget other(with_budgets(1000000, 0, 0));
        for (int i = 0; i < 5000; ++i) {
            if (what == 0) {
                parameters.set(500, i);
            } else if (what == 1) {
                changing.feed = i;
            } else {
                parameters.set_named(names.intern("n"), false, i);
            }
            ASSERT_FALSE(other.isRepeating(pass, changing, parameters)) << what << " " << i;
        }
    }
}

}  // namespace
}  // namespace mw::gcode::detail
