// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hal/script/commands.hh"
#include "hal/script/completion.hh"
#include "hal/script/session.hh"
#include "hal/script/test/session_fixture.hh"

namespace mw::hal::script {
namespace {

TEST_F(SessionTest, SetsAndReadsValues) {
    EXPECT_EQ(
        run("setp board.in0 TRUE\ngetp board.in0\nboard.value = 4.2e1\ngetp board.value\nptype board.value\n"
            "setp board.gain -.5\ngetp board.gain\nsetp board.word 0xff\ngetp board.word"),
        "TRUE\n42\nfloat\n-0.5\n255\n");
    EXPECT_EQ(run("newsig s s32\nsets s -3\ngets s\nstype s"), "-3\ns32\n");
}

TEST_F(SessionTest, FirstFailureEndsAFileUnlessItKeepsGoing) {
    EXPECT_EQ(run("newsig a bit\nbogus\nnewsig b bit").find("test.hal:2:1: unknown command 'bogus'"), 0U);
    EXPECT_FALSE(last_result.has_value());
    EXPECT_FALSE(host->hal().signals().find("b").has_value());
    options.keepsGoing = true;
    run("bogus\nnewsig b bit\nbogus2");
    EXPECT_FALSE(last_result.has_value());
    EXPECT_TRUE(host->hal().signals().find("b").has_value());
}

TEST_F(SessionTest, ErrorsNamePlaceExpectationAndNearestName) {
    EXPECT_EQ(run("\n  net x board.outt"),
              "test.hal:2:9: pin 'board.outt' does not exist (did you mean 'board.out'?)\n");
    EXPECT_EQ(run("setp board.gian 1"),
              "test.hal:1:6: parameter or pin 'board.gian' does not exist (did you mean 'board.gain'?)\n");
    EXPECT_EQ(run("setpp board.gain 1"), "test.hal:1:1: unknown command 'setpp' (did you mean 'setp'?)\n");
    EXPECT_EQ(run("board.gain=1"),
              "test.hal:1:1: unknown command 'board.gain=1' (an assignment needs blanks around '=')\n");
    EXPECT_EQ(run("setp board.gain 1 2"),
              "test.hal:1:19: setp needs 2 arguments, 3 given (setp NAME VALUE)\n");
    EXPECT_EQ(run("newsig q float4").find("test.hal:1:10: unknown signal type 'float4'"), 0U);
    EXPECT_EQ(run("addf f t"), "test.hal:1:6: function 'f' does not exist\n");
    EXPECT_EQ(
        run("net board.in0 board.in1").find("test.hal:1:5: signal name 'board.in0' is the name of a pin"),
        0U);
    EXPECT_EQ(run("setp board.in0 2").find("test.hal:1:16: "), 0U);
}

TEST_F(SessionTest, ACommandOfMegabytesIsAnErrorWithItsLine) {
    std::string text = "newsig a bit\n";
    for (int i = 0; i < 100'000; ++i) {
        text += "setp \\\n";
    }
    EXPECT_EQ(run(text).find("test.hal:2:1: a command with its continuation lines has 500000 characters"),
              0U);
}

TEST_F(SessionTest, NetTakesArrowsAndPinsKeepTheirValueWhenUnlinked) {
    EXPECT_EQ(run("setp board.in0 1\nnet a <= board.out => board.in0\nunlinkp board.in0\ngetp board.in0\n"
                  "unlinkp board.out\nsetp board.in1 1\nnet b board.in1\ngets b"),
              "FALSE\nTRUE\n");
    EXPECT_EQ(run("setp board.out 1").find("test.hal:1:16: "), 0U) << "outputs are not set";
    EXPECT_EQ(run("setp board.in1 0").find("test.hal:1:16: "), 0U) << "linked pins neither";
    EXPECT_EQ(run("linkpp board.in0 board.io\nshow sig board.in0"),
              "Signals:\nType                  Value  Name     (linked to)\n"
              "bit                   FALSE  board.in0\n"
              "                                 ==> board.in0\n"
              "                                 <=> board.io\n\n");
    EXPECT_NE(output.warnings.find("linkpp command is deprecated"), std::string::npos);
}

TEST_F(SessionTest, ShowHasTheColumnsThatScriptsCut) {
    run("setp board.value 2.5\nsetp board.word 10");
    EXPECT_EQ(run("show pin board.v* board.w*").substr(0, 62),
              "Component Pins:\nOwner   Type  Dir                 Value  Name\n");
    EXPECT_NE(output.answers.find("float IN                    2.5  board.value\n"), std::string::npos);
    EXPECT_NE(output.answers.find("u32   IN             0x0000000A  board.word\n"), std::string::npos);
    options.is_script = true;
    EXPECT_EQ(run("show pin board.v* board.w*"),
              "board float IN 2.5 board.value\nboard u32   IN 10 board.word\n\n");
    EXPECT_EQ(run("show param"), "board float RW 0 board.gain\n\n");
}

TEST_F(SessionTest, ListSortsAndShowsAliases) {
    EXPECT_EQ(run("alias pin board.in0 zebra\nlist pin board.* zebra"),
              "board.in1 board.io board.out board.value board.word zebra \n");
    EXPECT_EQ(run("list pin -tfloat"), "board.value \n");
    EXPECT_EQ(run("list sig nothing*"), "\n");
    EXPECT_EQ(run("getp board.in0\ngetp zebra"), "FALSE\nFALSE\n") << "both names work";
    EXPECT_EQ(run("unalias pin zebra\nlist pin *in0"), "board.in0 \n");
}

TEST_F(SessionTest, LocksForbidAndStatusTells) {
    EXPECT_EQ(run("lock tune\nstatus lock"), "HAL locking status:\n  current lock value 3 (03)\n"
                                             "  HAL_LOCK_LOAD    - loading of new components is locked\n"
                                             "  HAL_LOCK_CONFIG  - link and addf is locked\n");
    EXPECT_NE(run("net x board.in0"), "");
    EXPECT_EQ(run("setp board.in0 1"), "");
    EXPECT_EQ(run("unlock\nstatus lock"),
              "HAL locking status:\n  current lock value 0 (00)\n  HAL_LOCK_NONE - nothing is locked\n");
}

TEST_F(SessionTest, SavedStateRestoresTheSame) {
    run("net a board.out => board.in0\nnewsig lone u32\nsetp board.gain 1.25\nalias pin board.in1 second");
    const std::string saved = run("save");
    EXPECT_NE(saved.find("alias pin board.in1 second\n"), std::string::npos) << saved;
    EXPECT_NE(saved.find("newsig lone u32  \n"), std::string::npos);
    EXPECT_NE(saved.find("net a board.out => board.in0\n"), std::string::npos);
    EXPECT_NE(saved.find("setp board.gain                 1.25\n"), std::string::npos);
    run("delsig all\nunalias pin second\nsetp board.gain 0");
    EXPECT_EQ(run(saved), "");
    EXPECT_EQ(run("save"), saved);
    EXPECT_EQ(run("save linka"), "# links\nlinkps board.in0 <== a\nlinkps board.out ==> a\n");
}

TEST_F(SessionTest, SourceFindsFilesBesideTheCallerAndInTheLibrary) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("mw-session-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "lib");
    std::ofstream(folder / "outer.hal") << "source inner.hal\nsource LIB:part.hal\nquit\nbogus\n";
    std::ofstream(folder / "inner.hal") << "newsig inner bit\n";
    std::ofstream(folder / "lib" / "part.hal") << "newsig part bit\n";
    std::ofstream(folder / "bad.hal") << "\nnewsig part bit\n";
    options.library = {(folder / "lib").string()};
    EXPECT_EQ(run("source " + (folder / "outer.hal").string()), "");
    EXPECT_TRUE(host->hal().signals().find("inner").has_value());
    EXPECT_TRUE(host->hal().signals().find("part").has_value());
    const std::string errors = run("source " + (folder / "bad.hal").string());
    EXPECT_EQ(errors.find((folder / "bad.hal").string() + ":2:8: "), 0U) << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << "told once: " << errors;
    EXPECT_NE(run("source LIB:pard.hal").find("did you mean 'LIB:part.hal'?"), std::string::npos);
    EXPECT_EQ(run("source no.hal").find("test.hal:1:1: HAL file 'no.hal' not found"), 0U);
    std::filesystem::remove_all(folder);
}

TEST_F(SessionTest, LeftOutProgramsGetPlaceholders) {
    options.has_placeholders = true;
    std::string started;
    programs.add_part("known", [&](const ProgramRequest &request) {
        started = request.component;
        return Result<>{};
    });
    EXPECT_EQ(run("loadusr -W /some/where/known --option\nloadusr -Wn panel pyvcp -c panel file.xml\n"
                  "net early panel.button\nnet a board.out => panel.lamp board.in0\nsetp panel.level 3\n"
                  "net early board.in1\nunlinkp panel.other\ngetp panel.lamp"),
              "FALSE\n");
    EXPECT_EQ(started, "known");
    EXPECT_EQ(host->hal().pins().find("panel.button")->signal, "early")
        << "linked once the signal's type was known";
    ASSERT_EQ(left_out.size(), 1U);
    EXPECT_EQ(
        left_out[0],
        "not started: pyvcp -c panel file.xml; pins without effect: panel.button, panel.lamp, panel.level");
    EXPECT_NE(run("net b other.pin"), "") << "unknown pins of no component stay errors";
}

TEST_F(SessionTest, UnderTheVirtualClockNoProgramIsStarted) {
    EXPECT_EQ(run("loadusr -w /bin/false\nloadusr -Wn"), "test.hal:2:9: -Wn needs the name of a component\n");
    EXPECT_EQ(run("loadusr -x prog").find("test.hal:1:9: unknown option '-x'"), 0U);
}

TEST_F(SessionTest, CompletionOffersWhatThePositionDemands) {
    using Words = std::vector<std::string>;
    run("net s board.out\nnewsig word u32\nalias param board.gain boost\n");
    TextOutput out;
    Session session(*host, programs, out, options);
    EXPECT_EQ(completions(session, "unlo"), (Words{"unload", "unloadrt", "unloadusr", "unlock"}));
    EXPECT_EQ(common_beginning(completions(session, "unlo")), "unlo");
    EXPECT_EQ(common_beginning(completions(session, "loadr")), "loadrt");
    EXPECT_EQ(completions(session, "net "), (Words{"s", "word"}));
    EXPECT_EQ(completions(session, "net s => board."), (Words{"board.in0", "board.in1", "board.io"}))
        << "of the signal's type, and not linked";
    EXPECT_EQ(completions(session, "net new board.value "), (Words{"board.value"}));
    EXPECT_EQ(completions(session, "setp b"),
              (Words{"board.in0", "board.in1", "board.io", "board.value", "board.word", "boost"}))
        << "no outputs, no linked pins";
    EXPECT_EQ(completions(session, "unlinkp "), (Words{"board.out"}));
    EXPECT_EQ(completions(session, "getp bo").size(), 7U);
    EXPECT_EQ(completions(session, "newsig x s"), (Words{"s32", "s64"}));
    EXPECT_EQ(completions(session, "alias p"), (Words{"param", "pin"}));
    EXPECT_EQ(completions(session, "alias param "), (Words{"boost"}));
    EXPECT_EQ(completions(session, "show s"), (Words{"sig"}));
    EXPECT_EQ(completions(session, "show sig w"), (Words{"word"}));
    EXPECT_EQ(completions(session, "list comp b"), (Words{"board"}));
    EXPECT_EQ(completions(session, "help sta"), (Words{"start", "status"}));
    EXPECT_EQ(completions(session, "start "), (Words{}));
    EXPECT_EQ(completions(session, "nosuch "), (Words{}));
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "mw_completion";
    std::filesystem::create_directories(folder / "sub");
    std::ofstream(folder / "some.hal") << "";
    std::ofstream(folder / "some.txt") << "";
    EXPECT_EQ(completions(session, "source " + (folder / "s").string()),
              (Words{(folder / "some.hal").string(), (folder / "sub/").string()}));
    std::filesystem::remove_all(folder);
}

TEST_F(SessionTest, EveryCommandHasHelpAndAWorkingSynopsis) {
    for (const CommandSpec &spec : commands()) {
        EXPECT_FALSE(spec.help.empty()) << spec.name;
        EXPECT_EQ(spec.help.back(), '.') << spec.name;
        EXPECT_EQ(run("help " + std::string(spec.name)).find(spec.name), 0U);
    }
}

TEST_F(SessionTest, PrintAndEchoGoToTheNotes) {
    run("print \"hello there\"\necho\nunecho");
    EXPECT_EQ(output.notes, "test.hal:1: HALCMD MSG: \"hello there\"\n(3)<echo>: unecho\n");
}

// The signal must be detected if it arrived before the wait.
TEST_F(SessionTest, AStopIsSeenAlsoByAWaitThatBeginsAfterIt) {
    const volatile std::sig_atomic_t stop = SIGINT;
    SystemProgramHost system(host->hal(), &stop);
    ProgramRequest request;
    request.argv = {"sleep", "600"};
    request.wait = ProgramRequest::Wait::UNTIL_END;
    const auto started = system.start(request);
    ASSERT_FALSE(started.has_value());
    EXPECT_NE(started.error().message.find("stopped while waiting for 'sleep'"), std::string::npos);
}

TEST_F(SessionTest, TheStatusOfAProgramIsTheResultOfItsWait) {
    SystemProgramHost system(host->hal());
    ProgramRequest request;
    request.argv = {"true"};
    request.wait = ProgramRequest::Wait::UNTIL_END;
    EXPECT_TRUE(system.start(request).has_value());
    request.argv = {"false"};
    EXPECT_FALSE(system.start(request).has_value());
}

}  // namespace
}  // namespace mw::hal::script
