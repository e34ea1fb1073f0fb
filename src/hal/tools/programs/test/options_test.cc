// SPDX-License-Identifier: GPL-2.0-or-later
// Options, programs started by HAL files, two passes, Tcl and the prompt.
#include <poll.h>
#include <pty.h>

#include "hal/tools/programs/test/programs.hh"

namespace mw::hal::tools {
namespace {

using Options = Programs;
using Loadusr = Programs;

TEST_F(Options, KeepGoingRunsAllAndFailsAtTheEnd) {
    const Ended ended = run({"halrun", "-k", file("a.hal", "bogus\nnewsig a bit\nnewsig a bit\nlist sig\n")});
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "a \n");
    EXPECT_NE(ended.err.find("a.hal:1:1: unknown command 'bogus'"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("a.hal:3:8: there is a signal 'a' already"), std::string::npos) << ended.err;
}

TEST_F(Options, HowMuchIsSaid) {
    const std::string hal = file("a.hal", "newsig a bit\nsets a 1\nlinkps x y\n");
    EXPECT_EQ(run({"halrun", "-Q", hal}).err, "");
    EXPECT_EQ(run({"halrun", "-Q", hal}).status, 1);
    const Ended quiet = run({"halrun", "-q", hal});
    EXPECT_EQ(quiet.out, "");
    EXPECT_NE(quiet.err.find("a.hal:3:10: signal 'y' does not exist"), std::string::npos) << quiet.err;
    EXPECT_EQ(run({"halrun", "-v", hal}).out, hal + ":2:1: Signal 'a' set to 1\n");
    const Ended all = run({"halrun", "-V", hal});
    EXPECT_NE(all.out.find(hal + ":2:1: sets a 1\n"), std::string::npos) << all.out;
    EXPECT_NE(run({"halrun", "-e", hal}).err.find("(2)<echo>: sets a 1"), std::string::npos);
}

TEST_F(Options, ScriptAnswersHaveNoTitles) {
    const std::string hal = file("a.hal", "newsig a bit\nshow sig\n");
    EXPECT_EQ(run({"halrun", "-s", hal}).out, "bit    FALSE  a\n\n");
    EXPECT_EQ(run({"halrun", "-skR", "-f", hal}).out, "bit    FALSE  a\n\n") << "options may share a dash";
}

TEST_F(Options, WrongOnesAreRefused) {
    const Ended unknown = run({"halrun", "-x"});
    EXPECT_EQ(unknown.status, 1);
    EXPECT_NE(unknown.err.find("unknown option -x"), std::string::npos);
    EXPECT_NE(run({"halrun", "-i"}).err.find("option -i needs the name of an INI file"), std::string::npos);
    EXPECT_NE(run({"halrun", "-i", "nosuch.ini", "a.hal"}).err.find("nosuch.ini"), std::string::npos);
    EXPECT_NE(run({"halcmd", "-U"}).err.find("belong to halrun"), std::string::npos);
    EXPECT_NE(run({"halcmd", "show", "pin"}).err.find("no realtime process is running"), std::string::npos);
    EXPECT_NE(run({"halrun", "nosuch.hal"}).err.find("HAL file 'nosuch.hal' not found"), std::string::npos);
}

TEST_F(Options, HelpKnowsEveryCommand) {
    const Ended ended = run({"halcmd", "-h"});
    EXPECT_EQ(ended.status, 0);
    for (const char *word : {"usage: halcmd", "loadrt", "linkpp", "initf", "unecho", "  -R  "}) {
        EXPECT_NE(ended.out.find(word), std::string::npos) << word;
    }
    EXPECT_NE(run({"halcmd", "-h", "net"}).out.find("net SIGNAL PIN..."), std::string::npos);
    EXPECT_NE(run({"halcmd", "-h", "nett"}).err.find("did you mean 'net'?"), std::string::npos);
    EXPECT_EQ(run({"halrun", "-h"}).status, 0);
    EXPECT_EQ(run({"haltcl", "-h"}).status, 0);
    EXPECT_EQ(run({"halcmd_twopass", "-h"}).status, 0);
}

TEST_F(Options, OverlongNamesSaySo) {
    const std::string longest(127, 'x');
    const Ended ended =
        run({"halrun", "-k",
             file("a.hal", "newsig " + longest + " bit\nnewsig " + longest + "y bit\nlist sig\n")});
    EXPECT_EQ(ended.out, longest + " \n");
    EXPECT_NE(ended.err.find("has 128 characters, 1 to 127 are allowed"), std::string::npos) << ended.err;
}

TEST_F(Loadusr, WaitsUntilReadyAndEndsProgramsInOrder) {
    const Ended ended =
        run({"halrun",
             file("a.hal", "loadusr -W user_component\nloadusr -Wn other user_component other late\n"
                           "list comp\ngetp other.out\nunloadusr other\nwaitusr other\nlist comp\n"
                           "unload user_component\nwaitusr user_component\nlist comp\nunloadusr all\n")});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "other user_component \nTRUE\nuser_component \n\n");
}

TEST_F(Loadusr, AProgramThatDoesNotHearSigtermIsKilled) {
    const Ended ended = run(
        {"halrun", file("a.hal", "loadusr -Wn deaf user_component deaf deaf\nunloadusr all\nlist comp\n")});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "\n");
    EXPECT_NE(ended.err.find("component 'deaf' (process "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("has not ended at SIGTERM: killed"), std::string::npos) << ended.err;
}

TEST_F(Loadusr, AProgramWithoutAComponentEndsWithTheOthers) {
    file("nap.sh", "echo $$ > nap.tmp\nmv nap.tmp nap.pid\nexec sleep 1000\n");
    file("look.sh", "while [ ! -s nap.pid ]; do sleep 0.01; done\ncat nap.pid\n");
    const Ended ended = run({"halrun", file("a.hal", "loadusr sh nap.sh\nloadusr -w sh look.sh\n")});
    EXPECT_EQ(ended.status, 0) << ended.err;
    const pid_t pid = std::stoi("0" + ended.out);
    ASSERT_GT(pid, 1) << ended.out;
    EXPECT_EQ(::kill(pid, 0), -1) << "it would come up on a HAL that is gone";
}

TEST_F(Loadusr, StatusOfProgramsCountsUnlessIgnored) {
    const Ended ended = run({"halrun", "-k",
                             file("a.hal", "loadusr -w true\nloadusr -w false\nloadusr -wi false\n"
                                           "loadusr -i -w false\nloadusr -W true\n"

                                           "loadusr nosuchprogram\nloadusr -x true\nloadusr -Wn\n")});
    EXPECT_EQ(ended.status, 1);
    for (const char *text :
         {"a.hal:2:1: program 'false' ended with status 1\n",
          "a.hal:5:1: program 'true' ended with status 0 before its component 'true' was ready",
          "a.hal:6:1: cannot start 'nosuchprogram'", "a.hal:7:9: unknown option '-x' of loadusr",
          "a.hal:8:9: -Wn needs the name of a component"}) {
        EXPECT_NE(ended.err.find(text), std::string::npos) << text << ended.err;
    }
    EXPECT_EQ(ended.err.find("a.hal:1:"), std::string::npos);
    EXPECT_EQ(ended.err.find("a.hal:3:"), std::string::npos);
    EXPECT_EQ(ended.err.find("a.hal:4:"), std::string::npos);
}

TEST_F(Loadusr, ADeadComponentIsNamedWhereItIsMissed) {
    const Ended ended = run(
        {"halrun", "-k",
         file("a.hal",
              "loadusr -Wn victim user_component victim crash\nnet s victim.out\ngets s\nsetp victim.in 1\n"
              "waitusr victim\ngets s\nsetp victim.in 1\nstatus\n")});
    EXPECT_EQ(ended.out.substr(0, 11), "TRUE\nFALSE\n") << "the output took its safe value";
    EXPECT_NE(ended.err.find("component 'victim' died: its process "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("parameter or pin 'victim.in' does not exist (component 'victim' died"),
              std::string::npos)
        << ended.err;
    EXPECT_NE(ended.out.find("HAL components that died:\n  victim (process "), std::string::npos)
        << ended.out;
}

TEST_F(Options, AnIniFileRunsInTwoPasses) {
    file("a.hal", "loadrt and2 names=x\nnet s x.out y.in0\nshow sig\n");
    file("b.hal", "loadrt and2 names=y\nsetp y.in1 [SEC]VALUE\ngetp y.in1\n");
    const std::string ini =
        file("t.ini", "[HAL]\nTWOPASS = on\nHALFILE = a.hal\nHALFILE = b.hal\nHALCMD = list sig\n"
                      "[SEC]\nVALUE = 1\n");
    const Ended ended = run({"halrun", "t.ini"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "twopass:invoked with <> options\ntwopass:found ./a.hal\ntwopass:found ./b.hal\n"
                         "Signals:\nType                  Value  Name     (linked to)\n"
                         "bit                   FALSE  s\n"
                         "                                 <== x.out\n"
                         "                                 ==> y.in0\n\nTRUE\ns \n");
    const Ended attached = run({"halrun", file("c.hal", "loadusr -w halcmd_twopass t.ini\nlist comp\n")});
    EXPECT_EQ(attached.status, 0) << attached.err;
    EXPECT_EQ(attached.out, ended.out + "and2 \n");
    const Ended plain = run({"halrun", file("p.ini", "[HAL]\nHALFILE = a.hal\n")});
    EXPECT_NE(plain.err.find("can only be run when it has [HAL]TWOPASS"), std::string::npos) << plain.err;
}

TEST_F(Options, TclFilesAndSessions) {
    if (!std::filesystem::exists(std::string(MW_TEST_BIN) + "/../lib/tcl/libmillwright_haltcl.so")) {
        GTEST_SKIP() << "built without Tcl";
    }
    const std::string tcl =
        file("a.tcl", "loadrt and2 count=[lindex $argv 0]\nputs [llength [hal list pin *.out]]\n");
    const Ended ended = run({"halrun", tcl, "3"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "3\n");
    const Ended bad = run({"halrun", file("b.tcl", "\nsetp nosuch 1\n")});
    EXPECT_EQ(bad.status, 1);
    EXPECT_NE(bad.err.find("b.tcl:2: parameter or pin 'nosuch' does not exist"), std::string::npos)
        << bad.err;
    const Ended attached = run({"halrun", file("c.hal", "loadrt or2\nloadusr -w haltcl d.tcl one\n")});
    EXPECT_NE(attached.err.find("d.tcl"), std::string::npos) << "it does not exist";
    file("d.tcl", "puts \"$argv [hal list comp or*]\"\n");
    EXPECT_EQ(run({"halrun", "c.hal"}).out, "one or2 \n");
}

TEST_F(Options, AfterAFailedFileInputIsReadWhenAskedFor) {
    file("a.hal", "newsig a bit\nbogus\n");
    file("in.txt", "list sig\n");
    const Ended ended = run({"sh", "-c", "halrun -I -f a.hal < in.txt"});
    EXPECT_EQ(ended.out, "a \n");
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(run({"sh", "-c", "halrun < in.txt"}).status, 0);
    EXPECT_EQ(run({"sh", "-c", "halcmd -f < in.txt; halrun -U"}).out, "\n") << "a separate realtime process";
}

TEST_F(Options, WhatWasLeftRunningIsEnded) {
    EXPECT_EQ(run({"halcmd", "loadrt", "and2"}).status, 0);
    EXPECT_EQ(run({"halcmd", "list", "comp"}).out, "and2 \n");
    EXPECT_NE(run({"halrun", "nothing.hal"}).err.find("is already running"), std::string::npos);
    EXPECT_EQ(run({"halrun", "-U"}).status, 0);
    EXPECT_EQ(run({"halrun", "-U"}).status, 0) << "nothing to do";
    EXPECT_EQ(run({"halcmd", "list", "comp"}).status, 1);
}

/// halrun at a terminal.
class Prompt : public Programs {
  protected:
    void open_terminal() {
        setenv("XDG_STATE_HOME", folder.c_str(), 1);
        setenv("TERM", "xterm", 1);
        pid = forkpty(&terminal, nullptr, nullptr, nullptr);
        if (pid == 0) {
            execlp("halrun", "halrun", nullptr);
            _exit(127);
        }
        await("halcmd: ");
    }
    /// Reads until `text` arrives, and discards everything up to its end.
    void await(const std::string &text) {
        pollfd input{terminal, POLLIN, 0};
        while (seen.find(text) == std::string::npos && ::poll(&input, 1, 10000) > 0) {
            char bytes[512];
            const ssize_t got = ::read(terminal, bytes, sizeof bytes);
            if (got <= 0) {
                break;
            }
            seen.append(bytes, static_cast<std::size_t>(got));
        }
        const std::size_t at = seen.find(text);
        ASSERT_NE(at, std::string::npos) << "wanted " << text << ", got " << seen;
        seen.erase(0, at + text.size());
    }
    void type(const std::string &keys) {
        ASSERT_EQ(::write(terminal, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    }
    /// Exit status of halrun, which must be ending.
    int close_terminal() {
        int status = -1;
        for (int i = 0; i < 1000 && waitpid(pid, &status, WNOHANG) == 0; ++i) {
            usleep(10000);
        }
        ::close(terminal);
        return status;
    }

    pid_t pid = 0;
    int terminal = -1;
    std::string seen;
};

TEST_F(Prompt, CompletesRecallsAndGoesOnAfterMistakes) {
    open_terminal();
    type("loadr\tand2\n");
    await("halcmd: ");
    type("setp and2.0.i\t\t");
    await("and2.0.in0  and2.0.in1");
    type("1 1\n");
    await("1 1\r\n");
    await("halcmd: ");
    type("bogus\n");
    await("unknown command 'bogus'\r\nhalcmd: ");
    type("getp and2.0.in1\n");
    await("TRUE\r\nhalcmd: ");
    // Recalls the last line and replaces its end.
    type("\x1b[A\b0\n");
    await("FALSE\r\nhalcmd: ");
    type("newsig two\\\n");
    await("      > ");
    type("lines bit\n");
    await("halcmd: ");
    type("list sig\n");
    await("twolines \r\nhalcmd: ");
    type("exit\n");
    EXPECT_EQ(close_terminal(), 0);
    open_terminal();
    type("\x1b[A\x1b[A\n");
    await("list sig\r\n");
    await("halcmd: ");
    type("\x04");
    EXPECT_EQ(close_terminal(), 0) << "the end of input ends it";
}

}  // namespace
}  // namespace mw::hal::tools
