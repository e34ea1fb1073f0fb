// SPDX-License-Identifier: GPL-2.0-or-later
// The files that clients with the authority to operate may use, and jogs of clients that end.
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "machine/task/sequencer/confinement.hh"
#include "machine/task/states/jog_guard.hh"
#include "machine/task/test/task_rig.hh"
#include "messages/mailbox/memory.hh"

namespace mw::task {
namespace {

using mailbox::Authority;

std::string text_of(const fs::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// A program folder, and a machine file and a secret file outside it.
class ConfinementTest : public testing::Test {
  protected:
    ConfinementTest() {
        fs::remove_all(root);
        fs::create_directories(programs / "logs");
        std::ofstream(root / "secret") << "root:hash\n";
        std::ofstream(programs / "part.ngc") << "M2\n";
        confinement.program_folders = {programs.string()};
        confinement.program_extensions = {".ngc", ".py"};
    }
    ~ConfinementTest() override { fs::remove_all(root); }
    /// The reason why a log cannot be opened; empty if it can.
    std::string refusal(const std::string &path, bool appending = false) const {
        const auto opened = open_log(confinement, path, appending);
        if (opened.has_value()) {
            ::close(*opened);
        }
        return opened.has_value() ? "" : opened.error().message;
    }

    fs::path root = fs::temp_directory_path() / ("mw_confinement_" + std::to_string(::getpid()));
    fs::path programs = root / "nc_files";
    Confinement confinement;
};

TEST_F(ConfinementTest, LogsAreWrittenIntoTheProgramFolderAndNowhereElse) {
    EXPECT_EQ(refusal("probe.txt"), "");
    EXPECT_EQ(refusal("logs/probe.csv"), "");
    EXPECT_EQ(refusal((programs / "logs/whole.LOG").string()), "");
    for (const std::string path :
         {"../out.txt", "logs/../../out.txt", "/tmp/mw_confinement_out.txt", "", ".", "logs"}) {
        EXPECT_NE(refusal(path), "") << path;
        EXPECT_NE(refusal(path, true), "") << path;
    }
    EXPECT_FALSE(fs::exists(root / "out.txt"));
    EXPECT_FALSE(fs::exists("/tmp/mw_confinement_out.txt"));
}

TEST_F(ConfinementTest, ALogIsNoProgramNoHiddenFileAndNoFileOfTheMachine) {
    std::ofstream(programs / "history.txt") << "kept";
    confinement.kept_files = {(programs / "history.txt").string()};
    std::ofstream(programs / "run.txt") << "kept";
    fs::permissions(programs / "run.txt", fs::perms::owner_all);
    for (const std::string path : {"part.ngc", "M101", ".profile.txt", ".ssh/keys.txt", "machine.ini",
                                   "tool.tbl", "tool.py", "history.txt", "run.txt"}) {
        EXPECT_NE(refusal(path), "") << path;
        EXPECT_NE(refusal(path, true), "") << path;
    }
    EXPECT_EQ(text_of(programs / "part.ngc"), "M2\n");
    EXPECT_EQ(text_of(programs / "history.txt"), "kept");
    EXPECT_EQ(text_of(programs / "run.txt"), "kept");
    confinement.program_extensions.emplace_back(".txt");  // [FILTER]: a text file that is executed
    EXPECT_NE(refusal("probe.txt"), "");
}

TEST_F(ConfinementTest, NoLinkLeadsALogOut) {
    fs::create_symlink(root / "secret", programs / "link.txt");
    fs::create_directory_symlink(root, programs / "up");
    fs::create_hard_link(root / "secret", programs / "twin.txt");
    ASSERT_EQ(::mkfifo((programs / "pipe.txt").c_str(), 0600), 0);
    for (const std::string path : {"link.txt", "up/secret.txt", "twin.txt", "pipe.txt"}) {
        EXPECT_NE(refusal(path), "") << path;
    }
    EXPECT_EQ(text_of(root / "secret"), "root:hash\n");
    EXPECT_FALSE(fs::exists(root / "secret.txt"));
}

TEST_F(ConfinementTest, ProgramsAreThoseOfTheProgramFolder) {
    EXPECT_TRUE(check_program(confinement, (programs / "part.ngc").string()).has_value());
    EXPECT_TRUE(check_program(confinement, (programs / "logs/../part.ngc").string()).has_value());
    fs::create_symlink(root / "secret", programs / "link.ngc");
    fs::create_directory_symlink(root, programs / "up");
    for (const fs::path &path :
         {root / "secret", programs / "../secret", programs / "link.ngc", programs / "up/secret",
          programs / ".hidden", programs, fs::path("/proc/self/environ"), fs::path("/etc/shadow")}) {
        const auto checked = check_program(confinement, path.string());
        ASSERT_FALSE(checked.has_value()) << path;
        EXPECT_EQ(checked.error().str().find("hash"), std::string::npos);
    }
    confinement.program_folders.clear();
    EXPECT_FALSE(check_program(confinement, (programs / "part.ngc").string()).has_value());
}

/// A second client that may only operate.
class RightsTest : public TaskTest {
  protected:
    RightsTest() : TaskTest(confined()) {
        operating.limit_authority(Authority::OPERATE);
        fs::create_directory(folder / "nc_files");
        std::ofstream(folder / "outside.ngc") << "(secret) G1 Q9 X\n";
    }
    static Settings confined() {
        Settings settings;
        settings.confinement.program_folders = {(made_folder() / "nc_files").string()};
        settings.interpreter.subroutine_path.clear();
        return settings;
    }
    Progress ask_as(client::Client &sender, const Command &command) {
        const auto posted = sender.post(command);
        for (int i = 0; i < 2500 && sender.outcome(*posted).progress == Progress::STARTED; ++i) {
            cycle();
        }
        why = sender.outcome(*posted).reason;
        return sender.outcome(*posted).progress;
    }
    fs::path program(const std::string &text, const std::string &name = "nc_files/p.ngc") const {
        std::ofstream(folder / name) << text;
        return folder / name;
    }
    Progress run(client::Client &opener, client::Client &starter, const fs::path &path) {
        EXPECT_EQ(ask_as(client, SetMode{Mode::AUTO}), Progress::DONE);
        const Progress opened = ask_as(opener, OpenProgram{path.string()});
        return opened == Progress::DONE ? ask_as(starter, RunProgram{}) : opened;
    }
    Progress mdi(client::Client &sender, const std::string &line) {
        EXPECT_EQ(ask_as(client, SetMode{Mode::MDI}), Progress::DONE);
        return ask_as(sender, Mdi{line});
    }

    client::Client operating = *client::Client::join(mailbox.segment());
    std::string why;
};

TEST_F(RightsTest, OperateOpensProgramsOfTheProgramFolderOnlyAndReadsNothingOfOthers) {
    ASSERT_EQ(ask_as(client, SetMode{Mode::AUTO}), Progress::DONE);
    EXPECT_EQ(ask_as(operating, OpenProgram{program("M2\n").string()}), Progress::DONE) << why;
    EXPECT_EQ(ask_as(operating, OpenProgram{(folder / "outside.ngc").string()}), Progress::REFUSED);
    EXPECT_EQ(why.find("secret"), std::string::npos) << why;
    EXPECT_NE(why.find("program folder"), std::string::npos) << why;
    EXPECT_EQ(ask_as(operating, LoadCompensation{0, (folder / "outside.ngc").string()}), Progress::REFUSED);
    EXPECT_EQ(why.find("secret"), std::string::npos) << why;
    EXPECT_EQ(ask_as(client, OpenProgram{(folder / "outside.ngc").string()}), Progress::DONE) << why;
}

TEST_F(RightsTest, MdiOfOperateWritesLogsIntoTheProgramFolderOnly) {
    const fs::path outside = folder / "token.txt";
    EXPECT_EQ(mdi(operating, "(LOGOPEN," + outside.string() + ")"), Progress::FAILED);
    EXPECT_EQ(mdi(operating, "(LOGAPPEND," + outside.string() + ")"), Progress::FAILED);
    EXPECT_EQ(mdi(operating, "(PROBEOPEN " + outside.string() + ")"), Progress::FAILED);
    EXPECT_FALSE(fs::exists(outside));
    EXPECT_EQ(mdi(operating, "(LOGOPEN,probe.txt)"), Progress::DONE) << why;
    EXPECT_TRUE(fs::exists(folder / "nc_files/probe.txt"));
    EXPECT_EQ(mdi(client, "(LOGOPEN," + outside.string() + ")"), Progress::DONE) << why;
    EXPECT_TRUE(fs::exists(outside));
}

TEST_F(RightsTest, ARunHasTheLeastOfWhoOpenedAndWhoStartedIt) {
    const fs::path outside = folder / "token.txt";
    const fs::path path = program("(LOGOPEN," + outside.string() + ")\nM2\n");
    EXPECT_EQ(run(operating, client, path), Progress::FAILED);
    EXPECT_EQ(run(client, operating, path), Progress::FAILED);
    EXPECT_EQ(run(operating, operating, path), Progress::FAILED);
    EXPECT_FALSE(fs::exists(outside));
    EXPECT_EQ(run(client, client, path), Progress::DONE) << why;
    EXPECT_TRUE(fs::exists(outside));
}

TEST_F(RightsTest, AStepThatBeginsARunHasTheSameRights) {
    const fs::path outside = folder / "token.txt";
    const fs::path path = program("(LOGOPEN," + outside.string() + ")\nM2\n");
    ASSERT_EQ(ask_as(client, SetMode{Mode::AUTO}), Progress::DONE);
    ASSERT_EQ(ask_as(client, OpenProgram{path.string()}), Progress::DONE);
    EXPECT_NE(ask_as(operating, StepProgram{}), Progress::DONE);
    cycles(20);
    EXPECT_FALSE(fs::exists(outside));
}

TEST_F(RightsTest, WaitingLinesOfMdiKeepTheirSendersRights) {
    const fs::path outside = folder / "token.txt";
    ASSERT_EQ(ask_as(client, SetMode{Mode::MDI}), Progress::DONE);
    const auto first = client.post(Mdi{"G4 P0.05"});
    const auto second = operating.post(Mdi{"(LOGOPEN," + outside.string() + ")"});
    for (int i = 0; i < 500 && operating.outcome(*second).progress == Progress::STARTED; ++i) {
        cycle();
    }
    EXPECT_EQ(client.outcome(*first).progress, Progress::DONE);
    EXPECT_EQ(operating.outcome(*second).progress, Progress::FAILED);
    EXPECT_FALSE(fs::exists(outside));
}

TEST_F(RightsTest, OperateRunsNoLinesOfPython) {
    EXPECT_EQ(mdi(operating, ";py,print(1)"), Progress::FAILED);
    EXPECT_NE(why.find("role operate"), std::string::npos) << why;
    EXPECT_EQ(run(operating, client, program(";py,print(1)\nM2\n")), Progress::FAILED);
    EXPECT_NE(why.find("role operate"), std::string::npos) << why;
}

TEST_F(RightsTest, NamesOfSubroutinesDoNotLeadOut) {
    const std::string whole = (folder / "outer").string(), up = "nc_files/../outer";
    std::string text;
    for (const std::string &name : {whole, up, std::string("outer")}) {
        text += "o<" + name + "> sub\no<" + name + "> endsub\n";
    }
    program(text + "M2\n", "outer.ngc");
    EXPECT_NE(mdi(operating, "o<" + up + "> call"), Progress::DONE);
    EXPECT_NE(mdi(operating, "o<" + whole + "> call"), Progress::DONE);
    EXPECT_EQ(mdi(operating, "o<outer> call"), Progress::DONE) << why;
    EXPECT_EQ(mdi(client, "o<" + up + "> call"), Progress::DONE) << why;
}

TEST_F(RightsTest, APlaceThatIsUsedAgainDoesNotKeepItsRights) {
    {
        client::Client gone = *client::Client::join(mailbox.segment());
        gone.limit_authority(Authority::OPERATE);
    }
    cycles(2);
    client::Client next = *client::Client::join(mailbox.segment());
    EXPECT_EQ(ask_as(next, OpenProgram{(folder / "outside.ngc").string()}), Progress::DONE) << why;
    next.limit_authority(Authority::OPERATE);
    next.limit_authority(Authority::CONFIGURE);
    EXPECT_EQ(ask_as(next, OpenProgram{(folder / "outside.ngc").string()}), Progress::REFUSED)
        << "authority is never given back";
}

/// Tests with jogs of processes that the test runs, stops and ends.
class JogGuardTest : public testing::Test {
  protected:
    using State = JogGuard::State;
    static constexpr std::uint64_t OWNER = std::uint64_t{77} << 42;
    void move(bool moving) { motion.joint[1].vel_cmd = moving ? 2.0 : 0.0; }
    std::string stopped() {
        std::string all;
        for (const JogGuard::Left &left : guard.step(motion)) {
            const auto *stop = std::get_if<JogStop>(&left.stop);
            all += (stop != nullptr ? "stop " + std::to_string(stop->index) : "vector") + ": " + left.text +
                   '\n';
        }
        return all;
    }

    State state = State::RUNNING;
    int forgotten = 0;
    motion::Status motion;
    JogGuard guard{{[this](std::uint64_t) { return state; }, [this](std::uint64_t) { ++forgotten; }}};
};

TEST_F(JogGuardTest, AJogEndsWithItsClientsProcess) {
    guard.note(JogContinuous{true, 1, 2.0}, OWNER);
    move(true);
    EXPECT_EQ(stopped(), "") << "its client lives";
    state = State::ENDED;
    EXPECT_EQ(stopped(), "stop 1: Jog of joint 1 stopped: its client, process 77, has ended.\n");
    EXPECT_EQ(stopped(), "") << "once";
    EXPECT_EQ(forgotten, 1);
}

TEST_F(JogGuardTest, AJogEndsWhenItsClientIsSuspended) {
    guard.note(JogContinuous{true, 1, 2.0}, OWNER);
    move(true);
    state = State::STOPPED;
    EXPECT_EQ(stopped(), "stop 1: Jog of joint 1 stopped: its client, process 77, is suspended.\n");
}

TEST_F(JogGuardTest, AVectorOfVelocitiesIsAJog) {
    SetTeleopVector vector;
    vector.velocity[0] = 1;
    guard.note(vector, OWNER);
    motion.axis[0].velocity = 1;
    state = State::ENDED;
    EXPECT_EQ(stopped(), "vector: Jog of all axes stopped: its client, process 77, has ended.\n");
}

TEST_F(JogGuardTest, WhatHasEndedOrBelongsToAnotherIsLeftAlone) {
    const auto begin = [&] {
        guard.note(JogContinuous{true, 1, 2.0}, OWNER);
        move(true);
        EXPECT_EQ(stopped(), "");
    };
    begin();
    guard.note(JogStop{true, 1}, 0);
    begin();
    guard.note(JogContinuous{true, 1, 2.0}, 0);  // a pin of halui takes over the jog
    begin();
    guard.note(JogIncrement{true, 1, 2.0, 1.0}, OWNER);
    begin();
    guard.note(AbortAll{}, OWNER);
    begin();
    move(false);  // the joint is at its limit
    EXPECT_EQ(stopped(), "");
    move(true);  // the joint is jogged by a wheel
    state = State::ENDED;
    EXPECT_EQ(stopped(), "");
}

TEST_F(JogGuardTest, AJogThatNeverMovedIsNotReported) {
    guard.note(JogContinuous{true, 1, 2.0}, OWNER);
    state = State::ENDED;
    EXPECT_EQ(stopped(), "stop 1: \n");
}

}  // namespace
}  // namespace mw::task
