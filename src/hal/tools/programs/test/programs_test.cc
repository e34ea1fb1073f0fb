// SPDX-License-Identifier: GPL-2.0-or-later
// halrun and halcmd as processes: their output, their end and the files that they leave.
#include "hal/tools/programs/test/programs.hh"

namespace mw::hal::tools {
namespace {

TEST_F(Programs, HalrunStreamsThroughComponentsInRealtime) {
    file("in.dat", "# x\n1 0\n-2 1\n-3.5 1\n");
    const std::string hal =
        file("a.hal", "loadrt threads name1=t period1=1000000\nloadrt abs\nloadrt not\n"
                      "loadrt streamer cfg=fb depth=100\nloadrt sampler cfg=fb depth=1000\n"
                      "net x streamer.0.pin.0 => abs.0.in\nnet y abs.0.out => sampler.0.pin.0\n"
                      "net b streamer.0.pin.1 => not.0.in\nnet c not.0.out => sampler.0.pin.1\n"
                      "addf streamer.0 t\naddf abs.0 t\naddf not.0 t\naddf sampler.0 t\n"
                      "loadusr -w halstreamer in.dat\nstart\nloadusr -w halsampler -t -n 4\n");
    const Ended ended = run({"halrun", "-f", hal});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "0 1.000000 1 \n1 2.000000 0 \n2 3.500000 0 \n3 3.500000 0 \n");
}

TEST_F(Programs, EveryFunctionOfALongThreadIsTimedInTurn) {
    std::string text = "loadrt threads name1=t period1=1000000\nloadrt and2 count=70\n";
    for (int i = 0; i < 70; ++i) {
        text += "addf and2." + std::to_string(i) + " t\n";
    }
    text += "start\nloadusr -w sh poll.sh\n";
    file("poll.sh",
         "i=0\nwhile halcmd -s show param and2.*tmax | grep -q ' 0 '; do i=$((i + 1)); [ $i -lt 1000 ]"
         " || exit 1; done\n");
    const Ended ended = run({"halrun", file("a.hal", text)});
    EXPECT_EQ(ended.status, 0) << ended.err << "a function was never timed";
}

TEST_F(Programs, HalrunFailsAtTheFirstErrorAndNamesIt) {
    const Ended ended = run({"halrun", file("a.hal", "loadrt threads\nloadrt nosuch\nshow pin\n")});
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "");
    EXPECT_NE(ended.err.find("a.hal:2:8: "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("nosuch"), std::string::npos) << ended.err;
    const Ended failed = run({"halrun", file("b.hal", "loadusr -w false\n")});
    EXPECT_EQ(failed.status, 1);
    EXPECT_NE(failed.err.find("program 'false' ended with status 1"), std::string::npos) << failed.err;
    EXPECT_EQ(run({"halrun", file("c.hal", "loadusr -w -i false\n")}).status, 0);
    EXPECT_EQ(run({"halrun", "none.hal"}).status, 1);
    EXPECT_EQ(run({"halrun", "-x"}).status, 1);
}

TEST_F(Programs, HalrunTakesIniValuesAndTheEnvironment) {
    file("m.ini", "[A]\nPERIOD = 500000\nNAMES = one,two\n");
    setenv("MW_TEST_WORD", "three", 1);
    const Ended ended =
        run({"halrun", "-s", "-i", "m.ini",
             file("a.hal", "loadrt threads name1=fast period1=[A]PERIOD\n"
                           "loadrt and2 names=[A](NAMES),$MW_TEST_WORD\nlist funct\nlist thread\n")});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "one three two \nfast \n");
}

TEST_F(Programs, HalcmdAttachesAndHalrunRefusesASecondOne) {
    const std::string hal =
        file("a.hal", "loadrt or2\nloadusr -w halcmd setp or2.0.in0 1\nloadusr -w halcmd getp or2.0.in0\n"
                      "loadusr -w halcmd -s show pin or2.0.in0\nloadusr -w -i halcmd net x or2.0.nosuch\n"
                      "loadusr -w halrun b.hal\n");
    file("b.hal", "show\n");
    const Ended ended = run({"halrun", hal});
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "TRUE\nor2 bit   IN TRUE or2.0.in0\n\n");
    EXPECT_NE(ended.err.find("pin 'or2.0.nosuch' does not exist"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("already running"), std::string::npos) << ended.err;
    const Ended alone = run({"halcmd", "show", "pin"});
    EXPECT_EQ(alone.status, 1);
    EXPECT_NE(alone.err.find("no realtime process is running"), std::string::npos) << alone.err;
}

TEST_F(Programs, NothingSurvivesAKilledHalrun) {
    const pid_t pid = start(
        {"halrun", file("a.hal", "loadrt threads\nstart\nloadusr -W user_component\n"
                                 "loadusr -w sh -c \"halcmd getp user_component.out > ready; sleep 60\"\n")});
    const auto isReady = [&] { return read_file((folder / "ready").string()).value_or("") == "TRUE\n"; };
    for (int i = 0; i < 1000 && !isReady(); ++i) {
        usleep(10000);
    }
    ASSERT_TRUE(isReady());
    int program = 0;
    {
        const auto host = HostClient::connect(instance);
        ASSERT_TRUE(host);
        program = (*host)->hal().components().find("user_component")->pid;
    }
    kill(pid, SIGKILL);
    (void)wait(pid);
    for (int i = 0; i < 1000 && (isHostAlive(instance) || kill(program, 0) == 0); ++i) {
        usleep(10000);
        // An orphan of this test's process group may remain a zombie if no process reads its status.
        const auto state = read_file("/proc/" + std::to_string(program) + "/stat").value_or("");
        if (!isHostAlive(instance) && state.find(") Z ") != std::string::npos) {
            break;
        }
    }
    EXPECT_FALSE(isHostAlive(instance));
    const auto state = read_file("/proc/" + std::to_string(program) + "/stat").value_or(") Z ");
    EXPECT_NE(state.find(") Z "), std::string::npos) << "the program was asked to end";
}

TEST_F(Programs, SignalsEndHalrunInOrder) {
    for (const int signal : {SIGTERM, SIGINT, SIGKILL}) {
        std::ofstream(folder / "b.hal") << "loadrt threads\nstart\nloadusr -w sleep 30\n";
        const pid_t pid = start({"halrun", "b.hal"});
        // Waits up to 10 s on a loaded computer; usually it takes some milliseconds.
        for (int i = 0; i < 1000 && !isHostAlive(instance); ++i) {
            usleep(10000);
        }
        usleep(50000);
        kill(pid, signal);
        const Ended ended = wait(pid);
        EXPECT_NE(ended.status, 0);
        for (int i = 0; i < 1000 && isHostAlive(instance); ++i) {
            usleep(10000);
        }
        EXPECT_FALSE(isHostAlive(instance)) << "signal " << signal;
    }
}

}  // namespace
}  // namespace mw::hal::tools
