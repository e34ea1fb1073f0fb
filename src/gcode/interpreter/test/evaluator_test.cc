// SPDX-License-Identifier: GPL-2.0-or-later
// Values of expressions. The expected numbers are those that LinuxCNC prints for the same expressions.
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/syntax/parser.hh"

namespace mw::gcode::detail {
namespace {

/// #<_mode> has a value, #<_gone> has none; #5420 is 42.
class Kept final : public BuiltIns {
  public:
    bool isBuiltInName(std::string_view name) const override { return name == "_mode" || name == "_gone"; }
    std::optional<double> built_in(std::string_view name) const override {
        return name == "_mode" ? std::optional<double>(mode) : std::nullopt;
    }
    double built_in(int number) const override { return number == 5420 ? 42 : 0; }

    double mode = 7;
};

class Evaluation : public ::testing::Test {
  protected:
    /// The value of an expression, or its error as "column: message".
    std::string value_of(const std::string &expression) {
        Arena arena;
        const std::string before = "#1=[";
        const Block block = Parser(arena, names).parse_line(before + expression + "]", 1);
        if (block.error != NO_ID) {
            return "syntax: " + arena.errors[block.error].message;
        }
        fault.clear();
        double value = 0;
        if (!evaluator.value(arena, arena.settings[0].value, value)) {
            return fmt::format("{}: {}", fault.column - before.size(), fault.message);
        }
        return fmt::format("{:.10g}", value);
    }
    void set(std::string_view name, double value) {
        const NameId id = names.intern(name);
        parameters.set_named(id, evaluator.isGlobal(id), value);
    }

    Names names;
    Parameters parameters;
    Kept kept;
    Fault fault;
    Evaluator evaluator{parameters, names, kept, fault};
};

TEST_F(Evaluation, OperatorsGiveTheReferencesValues) {
    parameters.set(1, 2);
    const struct {
        const char *text, *value;
    } cases[] = {
        {"2 ** 3 ** 2", "64"},      {"-2 ** 2", "4"},       {"-#1 ** 2", "4"},
        {"1 or 1 and 0", "0"},      {"0 and 1 or 1", "1"},  {"1 xor 1 or 1", "1"},
        {"7 - 3 - 2", "2"},         {"100 / 10 * 2", "20"}, {"2 * 3 + 4 * 5 - 6 / 3", "24"},
        {"17 mod 5 * 2", "4"},      {"-7 mod 3", "2"},      {"7 mod -3", "1"},
        {"1 + 1 eq 2", "1"},        {"1 lt 2 eq 1", "1"},   {"3 gt 2 gt 1", "0"},
        {"2 eq 2 and 3 eq 3", "1"}, {"0.0001 and 1", "1"},  {"0 ** 0", "1"},
        {"2 ** -1", "0.5"},         {"2 - -3", "5"},        {"1 xor 0", "1"},
        {"1 xor 2", "0"},           {"0 or 0", "0"},        {"-8 ** 3", "-512"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(value_of(one.text), one.value) << one.text;
    }
}

TEST_F(Evaluation, OnlyEqAndNeHaveATolerance) {
    const struct {
        const char *text, *value;
    } cases[] = {
        {"1 eq 1.00009", "1"}, {"1 eq 1.00011", "0"}, {"1 eq 0.99991", "1"}, {"1 ne 1.00009", "0"},
        {"1 ne 1.00011", "1"}, {"1 ge 1.00005", "0"}, {"1.00005 gt 1", "1"}, {"1 le 0.99995", "0"},
        {"1 lt 1.00005", "1"}, {"1 ge 1", "1"},       {"1 le 1", "1"},       {"1 gt 1", "0"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(value_of(one.text), one.value) << one.text;
    }
}

TEST_F(Evaluation, FunctionsAreInDegreesAndRoundAsTheReference) {
    const struct {
        const char *text, *value;
    } cases[] = {
        {"sin[30]", "0.5"},      {"cos[60]", "0.5"},        {"tan[45]", "1"},        {"sin[-90]", "-1"},
        {"asin[1]", "90"},       {"acos[-1]", "180"},       {"acos[0.5]", "60"},     {"atan[1]/[1]", "45"},
        {"atan[1]/[-1]", "135"}, {"atan[-1]/[-1]", "-135"}, {"atan[-1]/[1]", "-45"}, {"atan[0]/[0]", "0"},
        {"atan[0]/[-1]", "180"}, {"fix[-2.5]", "-3"},       {"fix[2.8]", "2"},       {"fup[-2.5]", "-2"},
        {"fup[2.1]", "3"},       {"round[2.5]", "3"},       {"round[-2.5]", "-3"},   {"round[2.4]", "2"},
        {"abs[-3]", "3"},        {"ln[exp[2]]", "2"},       {"sqrt[16]", "4"},       {"exp[0]", "1"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(value_of(one.text), one.value) << one.text;
    }
}

TEST_F(Evaluation, WhatHasNoValueIsAnErrorAtItsColumn) {
    const struct {
        const char *text, *error;
    } cases[] = {
        {"1 + 2 / 0", "7: Attempt to divide by zero"},
        {"sqrt[-1]", "1: Negative argument to sqrt"},
        {"1 + ln[0]", "5: Zero or negative argument to ln"},
        {"asin[1.1]", "1: Argument to asin out of range"},
        {"acos[-1.1]", "1: Argument to acos out of range"},
        {"-2 ** 0.5", "4: Attempt to raise negative to non integer power"},
        {"exp[1000]", "1: The result of this function is not a finite number"},
        {"10 ** 400", "4: The result of this operation is not a finite number"},
        {"5 mod 0", "3: The result of this operation is not a finite number"},
        {"1 + #0", "5: Parameter number out of range"},
        {"#5603", "1: Parameter number out of range"},
        {"#1.5", "1: 1.5 is not the number of a parameter: it must be whole"},
        {"2 * #<nothing>", "5: Named parameter #<nothing> not defined"},
        {"#<_gone>", "1: Named parameter #<_gone> not defined"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(value_of(one.text), one.error) << one.text;
    }
}

TEST_F(Evaluation, TheFirstThatFailsIsTheError) {
    EXPECT_EQ(value_of("[1 / 0] + sqrt[-1]"), "4: Attempt to divide by zero");
    EXPECT_EQ(value_of("sqrt[ln[-1]]"), "6: Zero or negative argument to ln");
    EXPECT_EQ(value_of("0 and [1 / 0]"), "10: Attempt to divide by zero") << "both sides are computed";
}

TEST_F(Evaluation, NumbersNameParametersDirectlyAndThroughOthers) {
    parameters.set(2, 3);
    parameters.set(3, 30);
    EXPECT_EQ(value_of("#2"), "3");
    EXPECT_EQ(value_of("##2"), "30");
    EXPECT_EQ(value_of("#[1 + 2]"), "30");
    EXPECT_EQ(value_of("#2.00005"), "3") << "as whole as the language requires";
    EXPECT_EQ(value_of("#5602"), "0");
    EXPECT_EQ(value_of("#5420"), "42");
    EXPECT_EQ(value_of("-#2 + 1"), "-2");
}

TEST_F(Evaluation, NamesAreLocalUnlessTheyBeginWithAnUnderscore) {
    set("a", 1);
    set("_a", 2);
    EXPECT_EQ(value_of("#<a> * 10 + #<_a>"), "12");
    parameters.push_call();
    EXPECT_EQ(value_of("#<a>"), "1: Named parameter #<a> not defined");
    EXPECT_EQ(value_of("#<_a>"), "2");
    set("a", 5);
    set("_a", 6);
    EXPECT_EQ(value_of("#<a> * 10 + #<_a>"), "56");
    parameters.pop_call(false);
    EXPECT_EQ(value_of("#<a> * 10 + #<_a>"), "16") << "the caller's own is what it was";
}

TEST_F(Evaluation, KeptNamesAreReadOnlyAndAsked) {
    EXPECT_EQ(value_of("#<_mode>"), "7");
    kept.mode = 8;
    EXPECT_EQ(value_of("#<_Mode>"), "8");
    EXPECT_TRUE(evaluator.isReadOnly(names.intern("_mode")));
    EXPECT_FALSE(evaluator.isReadOnly(names.intern("_other")));
    EXPECT_FALSE(evaluator.isReadOnly(names.intern("mode")));
}

TEST_F(Evaluation, ExistsAsksWithoutFailing) {
    set("a", 0);
    EXPECT_EQ(value_of("exists[#<a>]"), "1");
    EXPECT_EQ(value_of("exists[#<b>]"), "0");
    EXPECT_EQ(value_of("exists[#<_mode>]"), "1");
    EXPECT_EQ(value_of("exists[#<_gone>]"), "0");
    EXPECT_EQ(value_of("exists[#5]"), "1");
    EXPECT_EQ(value_of("exists[#99999]"), "0");
    EXPECT_EQ(value_of("exists[#0]"), "0");
    parameters.push_call();
    EXPECT_EQ(value_of("exists[#<a>]"), "0") << "of this subroutine";
}

TEST_F(Evaluation, WholeNumbersMayBeNearlySo) {
    const auto whole = [this](const std::string &expression) -> std::string {
        Arena arena;
        Parser(arena, names).parse_line("#1=[" + expression + "]", 1);
        fault.clear();
        int value = 0;
        return evaluator.whole(arena, arena.settings[0].value, value) ? std::to_string(value) : fault.message;
    };
    EXPECT_EQ(whole("2.00005"), "2");
    EXPECT_EQ(whole("-2.99995"), "-3");
    EXPECT_EQ(whole("2.5"), "2.5 is not a whole number");
    EXPECT_EQ(whole("2.0002"), "2.0002 is not a whole number");
    EXPECT_EQ(whole("2000000000"), "2000000000 is not a whole number") << "too large for one";
}

}  // namespace
}  // namespace mw::gcode::detail
