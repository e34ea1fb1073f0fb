// SPDX-License-Identifier: GPL-2.0-or-later
// Conditions and loops in isolation: a program of O words and settings, without an executor.
#include <string>

#include <gtest/gtest.h>

#include "gcode/interpreter/flow/jumps.hh"

namespace mw::gcode::detail {
namespace {

class NothingKept final : public BuiltIns {
  public:
    bool isBuiltInName(std::string_view) const override { return false; }
    std::optional<double> built_in(std::string_view) const override { return std::nullopt; }
    double built_in(int) const override { return 0; }
};

/// Runs a program of settings and jumps, and records each G1 that it reaches.
class JumpRun {
  public:
    explicit JumpRun(const std::string &text) : program_("test", text, names_) { here.program = &program_; }

    /// The lines with G1 in execution order; at the end an error with its line.
    std::string trace(int most = 1000) {
        std::string out;
        for (int steps = 0; here.next <= program_.count_lines(); ++steps) {
            if (steps == most) {
                return out + "...";
            }
            here.line = here.next;
            const BlockView view = program_.block(here.next++);
            if (!run(view)) {
                return out + "line " + std::to_string(fault.line > 0 ? fault.line : here.line) + ": " +
                       fault.message;
            }
            out += view.block->word_count > 0 ? std::to_string(here.line) + " " : "";
        }
        return out;
    }

    Place here;
    std::vector<LoopTurn> turns;
    Fault fault;
    Parameters parameters;

  private:
    bool run(const BlockView &view) {
        for (int i = 0; i < view.block->setting_count; ++i) {
            const Setting &setting =
                view.arena->settings[view.block->first_setting + static_cast<unsigned>(i)];
            double index = 0, value = 0;
            evaluator_.value(*view.arena, setting.index, index);
            evaluator_.value(*view.arena, setting.value, value);
            parameters.set(static_cast<int>(index), value);
        }
        if (view.block->error != NO_ID) {
            const SyntaxError &error = view.arena->errors[view.block->error];
            return fault.set(error.message, error.column);
        }
        if (view.block->oword == NO_ID) {
            return true;
        }
        const int line = here.line;
        LoopTurn turn;
        const bool done =
            run_jump(view, view.arena->owords[view.block->oword], here, {evaluator_, names_, fault}, turn) &&
            check_jumped_over(line, here, fault);
        if (turn.first != 0) {
            turns.push_back(turn);
        }
        return done;
    }

    Names names_;
    NothingKept kept_;
    Program program_;
    Evaluator evaluator_{parameters, names_, kept_, fault};
};

TEST(Jumps, AnIfTakesItsFirstTrueBranch) {
    const std::string text = "o1 if [#1 eq 1]\nG1\no1 elseif [#1 eq 2]\nG1\no1 elseif [#1 ge 2]\nG1\n"
                             "o1 else\nG1\no1 endif\nG1\n";
    const char *want[] = {"8 10 ", "2 10 ", "4 10 ", "6 10 "};
    for (int value = 0; value < 4; ++value) {
        JumpRun run(text);
        run.parameters.set(1, value);
        EXPECT_EQ(run.trace(), want[value]) << value;
        EXPECT_TRUE(run.turns.empty());
    }
}

TEST(Jumps, AnIfWithoutElseIsPassed) {
    EXPECT_EQ(JumpRun("o1 if [0]\nG1\no1 endif\nG1\n").trace(), "4 ");
    EXPECT_EQ(JumpRun("o1 if [0]\nG1\no1 elseif [0]\nG1\no1 endif\nG1\n").trace(), "6 ");
}

TEST(Jumps, WhileLooksFirstAndDoAfterwards) {
    JumpRun loop("#1=2\no1 while [#1 gt 0]\nG1\n#1=[#1-1]\no1 endwhile\nG1\n");
    EXPECT_EQ(loop.trace(), "3 3 6 ");
    ASSERT_EQ(loop.turns.size(), 2u);
    EXPECT_EQ(loop.turns[0].first, 2);
    EXPECT_EQ(loop.turns[0].last, 5);
    EXPECT_TRUE(loop.turns[0].conditional);
    EXPECT_EQ(JumpRun("o1 while [0]\nG1\no1 endwhile\nG1\n").trace(), "4 ");
    EXPECT_EQ(JumpRun("o1 do\nG1\no1 while [0]\nG1\n").trace(), "2 4 ");
    EXPECT_EQ(JumpRun("#1=3\no1 do\nG1\n#1=[#1-1]\no1 while [#1 gt 0]\n").trace(), "3 3 3 ");
}

TEST(Jumps, RepeatCountsAndRounds) {
    EXPECT_EQ(JumpRun("o1 repeat [3]\nG1\no1 endrepeat\nG1\n").trace(), "2 2 2 4 ");
    EXPECT_EQ(JumpRun("o1 repeat [1.6]\nG1\no1 endrepeat\nG1\n").trace(), "2 2 4 ");
    EXPECT_EQ(JumpRun("o1 repeat [0.4]\nG1\no1 endrepeat\nG1\n").trace(), "4 ");
    EXPECT_EQ(JumpRun("o1 repeat [-1]\nG1\no1 endrepeat\nG1\n").trace(), "4 ");
    EXPECT_EQ(JumpRun("o1 repeat [3000000000]\nG1\no1 endrepeat\n").trace(),
              "line 1: The count of this repeat is too large");
    JumpRun run("o1 repeat [2]\nG1\no1 endrepeat\n");
    EXPECT_EQ(run.trace(), "2 2 ");
    ASSERT_EQ(run.turns.size(), 1u);
    EXPECT_FALSE(run.turns[0].conditional);
    EXPECT_TRUE(run.here.repeats.empty());
}

TEST(Jumps, LoopsInLoopsCountAnew) {
    JumpRun run("o1 repeat [2]\no2 repeat [3]\nG1\no2 endrepeat\nG1\no1 endrepeat\n");
    EXPECT_EQ(run.trace(), "3 3 3 5 3 3 3 5 ");
    EXPECT_TRUE(run.here.repeats.empty());
}

TEST(Jumps, BreakAndContinueMeanTheLoopOfTheirLabel) {
    EXPECT_EQ(JumpRun("#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\n"
                      "o3 if [#1 ge 4]\no1 break\no3 endif\nG1 X1\no1 endwhile\n")
                  .trace(),
              "10 10 ");
    JumpRun outer("o1 while [1]\no2 repeat [5]\nG1\no1 break\no2 endrepeat\no1 endwhile\nG1\n");
    EXPECT_EQ(outer.trace(), "3 7 ");
    EXPECT_EQ(JumpRun("#1=0\no1 do\n#1=[#1+1]\nG1\no1 continue\nG1\no1 while [#1 lt 2]\n").trace(), "4 4 ");
}

TEST(Jumps, BreakAndContinueAreErrorsInRepeat) {
    EXPECT_EQ(JumpRun("o1 repeat [2]\nG1\no1 break\no1 endrepeat\n").trace(),
              "2 line 3: o1: break is for while and do loops, line 1 is a repeat");
    EXPECT_EQ(JumpRun("o1 repeat [2]\nG1\no1 continue\no1 endrepeat\n").trace(),
              "2 line 3: o1: continue is for while and do loops, line 1 is a repeat");
    EXPECT_EQ(JumpRun("o1 repeat [2]\nG1\no2 if [0]\no1 break\no2 endif\no1 endrepeat\n").trace(),
              "2 line 4: o1: break is for while and do loops, line 1 is a repeat")
        << "one that is jumped over as well";
}

TEST(Jumps, ARepeatLeftByAnOuterLoopCountsFromTheStart) {
    JumpRun run("#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\no2 repeat [2]\nG1\no3 if [#1 lt 3]\no1 continue\n"
                "o3 endif\no2 endrepeat\no1 endwhile\n");
    EXPECT_EQ(run.trace(), "5 5 5 5 ");
    EXPECT_TRUE(run.here.repeats.empty());
}

TEST(Jumps, WhatIsMissingIsNamed) {
    const struct {
        const char *text, *error;
    } cases[] = {
        {"o1 if [0]\nG1\n", "line 1: o1: there is no matching endif"},
        {"o1 endif\n", "line 1: o1: there is no matching if"},
        {"o1 else\no1 endif\n", "line 1: o1: there is no matching if"},
        {"o1 while [1]\nG1\n", "line 1: o1: there is no matching endwhile"},
        {"G1\no1 endwhile\n", "1 line 2: o1: there is no matching while"},
        {"o1 do\nG1\n", "line 1: o1: there is no matching while"},
        {"o1 repeat [2]\n", "line 1: o1: there is no matching endrepeat"},
        {"o1 endrepeat\n", "line 1: o1: there is no matching repeat"},
        {"o1 break\n", "line 1: o1: there is no matching while or do"},
        {"o1 if [1]\no2 endif\n", "line 2: o2: there is no matching if"},
    };
    for (const auto &one : cases) {
        EXPECT_EQ(JumpRun(one.text).trace(), one.error) << one.text;
    }
}

TEST(Jumps, AnOWordThatCannotBeReadIsTheLikelyReason) {
    JumpRun run("o1 if [0]\nG1\no1 edif\nG1\n");
    EXPECT_EQ(run.trace().substr(0, 12), "line 3: Unkn");
    JumpRun over("o1 if [0]\no2 nonsense\no1 endif\nG1\n");
    EXPECT_EQ(over.trace().substr(0, 12), "line 2: Unkn") << "it may have been the end that was meant";
    EXPECT_EQ(JumpRun("o1 if [1]\nG1\no1 endif\n").trace(), "2 ");
}

TEST(Jumps, AConditionThatFailsIsAnErrorOfItsLine) {
    EXPECT_EQ(JumpRun("o1 if [0]\no1 elseif [1/0]\no1 endif\n").trace(), "line 2: Attempt to divide by zero");
    EXPECT_EQ(JumpRun("G1\no1 while [#<x>]\no1 endwhile\n").trace(),
              "1 line 2: Named parameter #<x> not defined");
}

}  // namespace
}  // namespace mw::gcode::detail
