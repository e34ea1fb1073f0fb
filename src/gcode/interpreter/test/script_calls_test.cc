// SPDX-License-Identifier: GPL-2.0-or-later
// Scripts as call levels, with a script host of a few C++ functions.
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode {
namespace {

using test::Machine;
using Calls = std::vector<std::string>;
using Function = std::function<ScriptOutcome(const ScriptArguments &)>;

const ScriptOutcome DONE{};

ScriptOutcome failed(std::string message) {
    return {ScriptOutcome::Kind::FAILED, 0, std::move(message)};
}

/// Shared by the test and the host, which the interpreter creates.
struct Scripted {
    std::map<std::string, Function> functions;  ///< functions of both modules by name
    std::map<std::string, std::function<Result<double>()>> parameters;
    std::function<ScriptOutcome()> text;  ///< for ;py, lines
    Function rest;                        ///< continuation of a function that waits
    InterpreterView *view = nullptr;
    int ended_waiting = 0;  ///< number of suspended scripts that were ended
    bool open_failing = false;

    /// Returns the error if the block failed, else whether it reached a synchronisation point.
    std::string execute(std::string_view block) {
        const auto done = view->execute(block, 7);
        return !done ? done.error().message : *done ? "done" : "waiting";
    }
};

class Suspended final : public SuspendedScript {
  public:
    explicit Suspended(Scripted &scripted) : scripted_(scripted) {}
    ~Suspended() override { scripted_.ended_waiting += resumed_ ? 0 : 1; }
    ScriptOutcome resume() override {
        resumed_ = true;
        return scripted_.rest({});
    }

  private:
    Scripted &scripted_;
    bool resumed_ = false;
};

class Host final : public ScriptHost {
  public:
    explicit Host(Scripted &scripted) : scripted_(scripted) {}

    Result<> load(const ScriptSettings &, InterpreterView &view) override {
        scripted_.view = &view;
        return scripted_.open_failing ? fail("the top-level script is broken") : Result<>();
    }
    Result<> begin() override { return {}; }
    bool hasFunction(ScriptModule, std::string_view name) const override {
        return scripted_.functions.contains(std::string(name));
    }
    ScriptOutcome call(ScriptModule, const std::string &name, const ScriptArguments &arguments,
                       std::unique_ptr<SuspendedScript> &rest) override {
        ScriptOutcome outcome = scripted_.functions.at(name)(arguments);
        if (outcome.kind == ScriptOutcome::Kind::WAITING) {
            rest = std::make_unique<Suspended>(scripted_);
        }
        return outcome;
    }
    ScriptOutcome run_text(std::string_view) override { return scripted_.text(); }
    std::vector<std::string> named_parameters() const override {
        std::vector<std::string> out;
        for (const auto &[name, value] : scripted_.parameters) {
            out.push_back(name);
        }
        return out;
    }
    Result<double> named_parameter(const std::string &name) override {
        return scripted_.parameters.at(name)();
    }

  private:
    Scripted &scripted_;
};

Settings with_scripts(Scripted &scripted, std::vector<RemapLine> remaps = {}) {
    Settings settings;
    settings.scripts.top_level = "toplevel";
    settings.remaps = std::move(remaps);
    settings.make_script_host = [&scripted]() -> Result<std::unique_ptr<ScriptHost>> {
        return std::make_unique<Host>(scripted);
    };
    return settings;
}

TEST(ScriptCalls, AnOWordMayBeAScriptsFunction) {
    Scripted scripted;
    scripted.functions["double"] = [](const ScriptArguments &arguments) {
        return ScriptOutcome{ScriptOutcome::Kind::VALUE, 2 * arguments.positional.at(0), {}};
    };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("#1=5\no<double> call [21]\n(print,#<_value> #<_value_returned> #1)\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.calls.at(0), "print42.000000 1.000000 5.000000");
}

TEST(ScriptCalls, ARemappedCodeRunsPrologSubroutineAndEpilogInThisOrder) {
    Scripted scripted;
    Calls order;
    scripted.functions["before"] = [&](const ScriptArguments &arguments) {
        order.push_back("before " + arguments.words.at(0).first);
        return scripted.execute("(print,prolog #<p>)") == "done" ? DONE : failed("?");
    };
    scripted.functions["after"] = [&](const ScriptArguments &) {
        order.push_back("after");
        return scripted.execute("(print,epilog #<_value>)") == "done" ? DONE : failed("?");
    };
    Machine machine(with_scripts(scripted, {"M400 argspec=P ngc=m400 prolog=before epilog=after"}));
    machine.write("m400.ngc", "o<m400> sub\n(print,body #<_remap_level>)\no<m400> endsub [9]\n");
    EXPECT_EQ(machine.run("M400 P3 G0 X1\n(print,then)\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(order, (Calls{"before p", "after"}));
    const Calls want = {"printprolog 3.000000", "printbody 1.000000", "printepilog 9.000000", "printthen"};
    EXPECT_EQ(Calls(machine.record.calls.begin(), machine.record.calls.begin() + 4), want);
    EXPECT_EQ(machine.record.lines.size(), 1u) << "the rest of the block comes after the epilog";
}

TEST(ScriptCalls, AFunctionThatFailsEndsItsBlockAndTheRestIsNotRun) {
    Scripted scripted;
    scripted.functions["bad"] = [&](const ScriptArguments &) {
        EXPECT_EQ(scripted.execute("G0 X5"), "done");
        return failed("no such tool");
    };
    Machine machine(with_scripts(scripted, {"M400 py=bad"}));
    EXPECT_EQ(machine.run("M400 G0 X1\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "no such tool");
    EXPECT_EQ(machine.interpreter->error().line_text, "O <bad> call ");
    ASSERT_EQ(machine.record.lines.size(), 1u) << "what the script has executed stays, the rest is not run";
    EXPECT_EQ(machine.record.lines[0].end[0], 5);
    EXPECT_EQ(machine.interpreter->call_level(), 0);
    EXPECT_EQ(machine.interpreter->execute("(print,#<_remap_level>)"), Step::FILE_END);
    EXPECT_EQ(machine.record.calls.back(), "print0.000000");
}

TEST(ScriptCalls, ANumberIsNoAnswerOfARemappedCode) {
    Scripted scripted;
    scripted.functions["number"] = [](const ScriptArguments &) {
        return ScriptOutcome{ScriptOutcome::Kind::VALUE, 3, {}};
    };
    Machine machine(with_scripts(scripted, {"M400 py=number"}));
    EXPECT_EQ(machine.run("M400\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("returned the number 3"), std::string::npos) << machine.error();
}

TEST(ScriptCalls, ABlockThatFailsIsTheScriptsToHandle) {
    Scripted scripted;
    std::string told;
    scripted.functions["tries"] = [&](const ScriptArguments &) {
        told = scripted.execute("G1 X[1/0] F1");
        return DONE;
    };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("o<tries> call\nG0 X1\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(told, "Attempt to divide by zero");
    EXPECT_EQ(machine.record.lines.size(), 1u);
}

TEST(ScriptCalls, BlocksOfScriptsCallSubroutinesAndLoop) {
    Scripted scripted;
    scripted.functions["runs"] = [&](const ScriptArguments &) {
        EXPECT_EQ(scripted.execute("o<inner> call [2]"), "done");
        EXPECT_EQ(scripted.execute("(print,level #<_call_level> line #<_line>)"), "done");
        return DONE;
    };
    Machine machine(with_scripts(scripted));
    machine.write("inner.ngc",
                  "o<inner> sub\no1 repeat [#1]\n(print,in #<_call_level>)\no1 endrepeat\no<inner> endsub\n");
    EXPECT_EQ(machine.run("o2 repeat [2]\no<runs> call\no2 endrepeat\n(print,out)\n"), Step::PROGRAM_END)
        << machine.error();
    const Calls once = {"printin 2.000000", "printin 2.000000", "printlevel 1.000000 line 7.000000"};
    Calls want = once;
    want.insert(want.end(), once.begin(), once.end());
    want.push_back("printout");
    EXPECT_EQ(Calls(machine.record.calls.begin(), machine.record.calls.begin() + 7), want);
}

TEST(ScriptCalls, AWaitingScriptEndsTheStepAndGoesOnWithTheNext) {
    Scripted scripted;
    scripted.functions["waits"] = [&](const ScriptArguments &) {
        EXPECT_EQ(scripted.execute("M66 P0 L0"), "waiting");
        EXPECT_NE(scripted.execute("G0 X1").find("synchronisation point is due"), std::string::npos);
        return ScriptOutcome{ScriptOutcome::Kind::WAITING, 0, {}};
    };
    scripted.rest = [&](const ScriptArguments &) {
        EXPECT_EQ(scripted.execute("(print,got #5399)"), "done");
        return DONE;
    };
    Machine machine(with_scripts(scripted));
    machine.mill.state.input_value = 1;
    EXPECT_EQ(machine.run("o<waits> call\n(print,then)\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(machine.record.calls.at(1), "printgot 1.000000");
    EXPECT_EQ(machine.record.calls.at(2), "printthen");
    EXPECT_EQ(scripted.ended_waiting, 0);
}

TEST(ScriptCalls, WhatAScriptLeavesUnderWayIsRunBeforeItsCallEnds) {
    Scripted scripted;
    scripted.functions["hasty"] = [&](const ScriptArguments &) {
        EXPECT_EQ(scripted.execute("o<inner> call"), "waiting");
        return ScriptOutcome{ScriptOutcome::Kind::VALUE, 6, {}};  // the function does not wait
    };
    Machine machine(with_scripts(scripted));
    machine.write("inner.ngc", "o<inner> sub\nM66 P0 L0\n(print,rest)\no<inner> endsub\n");
    EXPECT_EQ(machine.run("o<hasty> call\n(print,then #<_value>)\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(machine.record.calls.at(1), "printrest");
    EXPECT_EQ(machine.record.calls.at(2), "printthen 6.000000");
}

TEST(ScriptCalls, AnAbortEndsAWaitingScript) {
    Scripted scripted;
    scripted.functions["waits"] = [&](const ScriptArguments &) {
        return ScriptOutcome{ScriptOutcome::Kind::WAITING, 0, {}};
    };
    Machine machine(with_scripts(scripted));
    ASSERT_TRUE(machine.interpreter->begin());
    machine.interpreter->open_text("text", "o<waits> call\nG0 X1\n");
    EXPECT_EQ(machine.interpreter->step(), Step::SYNC);
    EXPECT_EQ(machine.interpreter->call_level(), 1);
    machine.interpreter->abort();
    EXPECT_EQ(scripted.ended_waiting, 1);
    EXPECT_EQ(machine.interpreter->call_level(), 0);
    EXPECT_EQ(machine.interpreter->step(), Step::OK) << "the line behind the call";
    EXPECT_EQ(machine.record.lines.size(), 1u);
}

TEST(ScriptCalls, AnEndInAScriptsBlockEndsTheProgram) {
    Scripted scripted;
    scripted.functions["ends"] = [&](const ScriptArguments &) {
        scripted.execute("M2");
        EXPECT_NE(scripted.execute("G0 X1").find("the program has ended"), std::string::npos);
        return DONE;
    };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("o<ends> call\nG0 X2\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_TRUE(machine.record.lines.empty());
    EXPECT_EQ(machine.interpreter->call_level(), 0);
}

TEST(ScriptCalls, ScriptsThatCallEachOtherAreBounded) {
    Scripted scripted;
    int calls = 0;
    scripted.functions["again"] = [&](const ScriptArguments &) {
        ++calls;
        const std::string told = scripted.execute("o<again> call");
        return told == "done" ? DONE : failed(told);
    };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("o<again> call\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "Scripts call each other more than 40 deep");
    EXPECT_EQ(calls, 40);
    EXPECT_EQ(machine.interpreter->call_level(), 0);
}

TEST(ScriptCalls, AParametersFunctionMayOnlyLook) {
    Scripted scripted;
    std::string told;
    scripted.parameters["_mine"] = [&]() -> Result<double> {
        told = scripted.execute("G0 X1");
        return 4;
    };
    scripted.parameters["_bad"] = []() -> Result<double> { return fail("cannot tell"); };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("(print,#<_mine>)\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(machine.record.calls.at(0), "print4.000000");
    EXPECT_EQ(told, "the function of a named parameter cannot execute blocks");
    EXPECT_EQ(machine.run("G0 X[1 + #<_bad>]\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "cannot tell");
    EXPECT_EQ(machine.interpreter->error().what.place.column, 10);
    EXPECT_EQ(machine.run("#<_mine>=1\n"), Step::FAILED) << "it is read only";
}

TEST(ScriptCalls, ALabelAloneInAScriptsBlockIsPassed) {
    Scripted scripted;
    std::string told;
    scripted.functions["labels"] = [&](const ScriptArguments &) {
        told = scripted.execute("O123");
        return DONE;
    };
    Machine machine(with_scripts(scripted));
    EXPECT_EQ(machine.run("o<labels> call\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(told, "done");
}

TEST(ScriptCalls, AHostThatCannotBeLoadedIsTold) {
    Scripted scripted;
    scripted.open_failing = true;
    Settings settings = with_scripts(scripted);
    settings.scripts.place = {"machine.ini", 12, 1};
    Machine machine(settings);
    const Result<> begun = machine.interpreter->begin();
    ASSERT_FALSE(begun);
    EXPECT_EQ(begun.error().message, "the top-level script is broken");
    EXPECT_EQ(begun.error().place.line, 12);
}

TEST(ScriptCalls, ARemapMustNameFunctionsThatAreThere) {
    Scripted scripted;
    Machine machine(with_scripts(scripted, {"M400 py=nowhere"}));
    const Result<> begun = machine.interpreter->begin();
    ASSERT_FALSE(begun);
    EXPECT_NE(begun.error().message.find("'nowhere' is not a Python function"), std::string::npos);
}

}  // namespace
}  // namespace mw::gcode
