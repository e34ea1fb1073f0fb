// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters in isolation: undo of a failed block, and values saved by calls.
#include <random>

#include <gtest/gtest.h>

#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {
namespace {

class ParametersTest : public ::testing::Test {
  protected:
    Names names;
    NameId a = names.intern("a"), b = names.intern("b"), shared = names.intern("_shared");
    Parameters parameters;
};

TEST_F(ParametersTest, RollbackTakesBackWhatTheBlockHasSet) {
    parameters.set(100, 1);
    parameters.set_named(a, false, 2);
    parameters.set_named(shared, true, 3);
    parameters.commit();
    parameters.set(100, 10);
    parameters.set(100, 11);
    parameters.set_named(a, false, 20);
    parameters.set_named(a, false, 21);
    parameters.set_named(shared, true, 30);
    parameters.set_named(b, false, 40);
    parameters.rollback();
    EXPECT_EQ(parameters.get(100), 1);
    EXPECT_EQ(parameters.named(a, false), 2);
    EXPECT_EQ(parameters.named(shared, true), 3);
    EXPECT_EQ(parameters.named(b, false), std::nullopt) << "it did not exist before";
}

TEST_F(ParametersTest, RollbackLeavesWhatWasCommitted) {
    parameters.set(100, 1);
    parameters.commit();
    parameters.rollback();
    EXPECT_EQ(parameters.get(100), 1);
    parameters.set(100, 2);
    parameters.rollback();
    parameters.rollback();
    EXPECT_EQ(parameters.get(100), 1);
}

/// Rolling back any block of settings restores the values before it exactly.
TEST_F(ParametersTest, RollbackIsExact) {
    constexpr unsigned SEED = 3;
    std::mt19937 random(SEED);
    const auto below = [&random](unsigned limit) { return static_cast<unsigned>(random() % limit); };
    std::vector<NameId> ids;
    for (int i = 0; i < 6; ++i) {
        ids.push_back(names.intern(std::string(1, static_cast<char>('p' + i))));
    }
    for (int round = 0; round < 2000; ++round) {
        const Parameters::Values before = parameters.values();
        for (unsigned left = below(8); left > 0; --left) {
            const double value = below(100);
            switch (below(3)) {
            case 0: parameters.set(static_cast<int>(1 + below(20)), value); break;
            case 1: parameters.set_named(ids[below(6)], false, value); break;
            default: parameters.set_named(ids[below(6)], true, value); break;
            }
        }
        if (below(2) == 0) {
            parameters.commit();
            continue;
        }
        parameters.rollback();
        // The memory for globals may have grown; globals that are not set have no value.
        Parameters::Values after = parameters.values();
        while (after.globals.size() > before.globals.size()) {
            ASSERT_EQ(after.globals.back(), std::nullopt);
            after.globals.pop_back();
        }
        ASSERT_EQ(after.numbers, before.numbers) << "seed " << SEED << " round " << round;
        ASSERT_EQ(after.locals, before.locals) << "seed " << SEED << " round " << round;
        ASSERT_EQ(after.globals, before.globals) << "seed " << SEED << " round " << round;
    }
}

TEST_F(ParametersTest, ACallHasItsOwnNamesAndArguments) {
    parameters.set(1, 5);
    parameters.set(30, 6);
    parameters.set(31, 7);
    parameters.set_named(a, false, 1);
    parameters.commit();
    parameters.push_call();
    EXPECT_EQ(parameters.depth(), 2);
    EXPECT_EQ(parameters.named(a, false), std::nullopt);
    std::array<double, ARGUMENT_COUNT> given{};
    given[0] = 50;
    parameters.set_arguments(given);
    EXPECT_EQ(parameters.get(1), 50);
    EXPECT_EQ(parameters.get(30), 0) << "what is not given is 0";
    parameters.set(31, 70);
    parameters.set_named(a, false, 10);
    parameters.commit();
    parameters.pop_call(false);
    EXPECT_EQ(parameters.get(1), 5);
    EXPECT_EQ(parameters.get(30), 6);
    EXPECT_EQ(parameters.get(31), 70) << "#31 and on belong to all";
    EXPECT_EQ(parameters.named(a, false), 1);
}

TEST_F(ParametersTest, AFanucCallSharesTheCallersArguments) {
    parameters.set(1, 5);
    parameters.push_call();
    parameters.set(1, 50);
    parameters.pop_call(true);
    EXPECT_EQ(parameters.get(1), 50);
}

TEST_F(ParametersTest, ManyArgumentsAreKeptAsideWithTheirCall) {
    parameters.set(31, 7);
    parameters.set(40, 8);
    parameters.set(41, 9);
    parameters.commit();
    parameters.push_call();
    parameters.keep_aside(40);
    const std::vector<double> given(40, 1.5);
    parameters.set_arguments(given);
    parameters.set(41, 90);
    parameters.push_call();  // an inner call with few arguments has none of them to restore
    parameters.set(31, 2.5);
    parameters.pop_call(false);
    EXPECT_EQ(parameters.get(31), 2.5);
    parameters.pop_call(false);
    EXPECT_EQ(parameters.get(31), 7);
    EXPECT_EQ(parameters.get(40), 8);
    EXPECT_EQ(parameters.get(41), 90);
}

TEST_F(ParametersTest, ALevelThatIsUsedAgainHoldsNothingOld) {
    parameters.push_call();
    parameters.set_named(a, false, 1);
    parameters.keep_aside(40);
    parameters.commit();
    parameters.pop_call(false);
    parameters.set(31, 5);
    parameters.push_call();
    EXPECT_EQ(parameters.named(a, false), std::nullopt);
    parameters.pop_call(false);
    EXPECT_EQ(parameters.get(31), 5);
}

TEST_F(ParametersTest, ScriptsSeeTheNamesOfEveryLevel) {
    parameters.set(1, 5);
    parameters.set_named(a, false, 1);
    parameters.set_named(shared, true, 2);
    parameters.push_call();
    parameters.set_named(b, false, 3);
    using Values = std::vector<std::pair<NameId, double>>;
    EXPECT_EQ(parameters.locals(0), (Values{{a, 1}}));
    EXPECT_EQ(parameters.locals(1), (Values{{b, 3}}));
    EXPECT_EQ(parameters.globals(), (Values{{shared, 2}}));
    EXPECT_EQ(parameters.saved_arguments(1)[0], 5);
}

}  // namespace
}  // namespace mw::gcode::detail
