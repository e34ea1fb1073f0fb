// SPDX-License-Identifier: GPL-2.0-or-later
// The questions about a new machine, and invalid answers (J1). tests/e2e/first_steps.py tests that the files
// run.
#include <algorithm>

#include <gtest/gtest.h>

#include "machine/setup/files.hh"

namespace mw::setup {
namespace {

std::string faults_text(const Planned &planned) {
    std::string text;
    for (const Fault &fault : planned.faults) {
        text += fault.key + ": " + fault.text + '\n';
    }
    return text;
}

bool isAsked(const Answers &given, std::string_view key) {
    const auto asked = questions(given);
    return std::ranges::find(asked, key, &Question::key) != asked.end();
}

TEST(Setup, PresetsOfEachMachineHold) {
    for (const std::string_view kind : KINDS) {
        for (const char *units : {"mm", "inch"}) {
            for (const char *drives : {"simulated", "stepper"}) {
                for (const char *switches : {"none", "home", "home_and_limits"}) {
                    const auto planned = plan_of({{"kind", std::string(kind)},
                                                  {"units", units},
                                                  {"drives", drives},
                                                  {"switches", switches}});
                    EXPECT_EQ(faults_text(planned), "")
                        << kind << ' ' << units << ' ' << drives << ' ' << switches;
                }
            }
        }
    }
}

TEST(Setup, AsksWhatTheMachineHas) {
    EXPECT_TRUE(isAsked({}, "z.max"));
    EXPECT_FALSE(isAsked({}, "x.step_pin"));
    EXPECT_TRUE(isAsked({{"drives", "stepper"}}, "x.step_pin"));
    EXPECT_FALSE(isAsked({{"drives", "stepper"}}, "y2.step_pin"));
    EXPECT_TRUE(isAsked({{"kind", "gantry"}, {"drives", "stepper"}}, "y2.step_pin"));
    EXPECT_FALSE(isAsked({{"kind", "lathe"}}, "y.max"));
    EXPECT_TRUE(isAsked({{"kind", "foam"}}, "foam.width"));
    EXPECT_TRUE(isAsked({{"kind", "foam"}}, "u.max"));
    EXPECT_FALSE(isAsked({}, "x.home"));
    EXPECT_TRUE(isAsked({{"switches", "home"}}, "x.home"));
    EXPECT_FALSE(isAsked({{"spindle", "none"}}, "spindle.max"));
}

TEST(Setup, EachWrongAnswerIsTold) {
    struct Wrong {
        Answers given;
        const char *told;
    };
    const Wrong cases[] = {
        {{{"kind", "robot"}},
         "kind: 'robot' is not one of mill, router, gantry, lathe, foam, plasma, mill4, mill5\n"},
        {{{"x.maxx", "1"}}, "x.maxx: this machine type has no such key; did you mean x.max?\n"},
        {{{"x.max", "3,5"}}, "x.max: '3,5' is not a number\n"},
        {{{"x.speed", "0"}}, "x.speed: 0 is out of range: 0.001 to 100000\n"},
        {{{"x.min", "295"}}, "x.max: the travel is 5, but must be at least 10\n"},
        {{{"name", "a#b"}}, "name: a name has 1 to 60 characters without []#;=\\\"\n"},
        {{{"name", "a\nb"}}, "name: a name has 1 to 60 characters without []#;=\\\"\n"},
        {{{"switches", "home"}, {"x.home_speed", "50"}},
         "x.home_speed: exceeds the maximum speed of the axis\n"},
        {{{"drives", "stepper"}, {"x.way_per_turn", "0"}}, "x.way_per_turn: a travel of 0 is not possible\n"},
        {{{"drives", "stepper"}, {"x.step_pin", "2.5"}}, "x.step_pin: '2.5' is not a whole number\n"},
        {{{"drives", "stepper"}, {"x.step_pin", "4"}}, "y.step_pin: pin 4 is used by x.step_pin already\n"},
        {{{"drives", "stepper"}, {"x.step_pin", "12"}},
         "x.step_pin: pin 12 is no output: 1 to 9, 14, 16 and 17 are\n"},
        {{{"drives", "stepper"}, {"pin.estop", "9"}},
         "pin.estop: pin 9 is no input: 10, 11, 12, 13 and 15 are\n"},
    };
    for (const Wrong &wrong : cases) {
        EXPECT_EQ(faults_text(plan_of(wrong.given)), wrong.told);
    }
}

TEST(Setup, StepsThatCannotBeMadeAreRefused) {
    // 200 * 16 / 5 mm = 640 steps per mm; at 40 mm/s plus 5 % that is 26880 per second; a base period of
    // 30000 ns permits 16667.
    const auto planned = plan_of({{"drives", "stepper"}, {"y.microsteps", "16"}});
    ASSERT_EQ(planned.faults.size(), 1U) << faults_text(planned);
    EXPECT_EQ(planned.faults[0].key, "y.speed");
    EXPECT_NE(planned.faults[0].text.find("26880"), std::string::npos) << planned.faults[0].text;
    EXPECT_NE(planned.faults[0].text.find("16667"), std::string::npos) << planned.faults[0].text;
}

TEST(Setup, FilesAreThoseThatTheIniNames) {
    const auto planned = plan_of({{"drives", "stepper"}, {"kind", "gantry"}, {"switches", "home"}});
    ASSERT_EQ(faults_text(planned), "");
    const auto files = machine_files(planned.plan);
    std::vector<std::string> names;
    for (const File &file : files) {
        names.push_back(file.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"machine.ini", "motion.hal", "board.hal", "motors.hal",
                                               "switches.hal", "spindle.hal", "coolant.hal", "estop.hal",
                                               "tool_change.hal", "threads.hal", "simulated_wires.hal",
                                               "tool.tbl", "nc_files/first_program.ngc"}));
    const std::string &ini = files[0].text;
    EXPECT_NE(ini.find("COORDINATES = X Y Y Z\n"), std::string::npos);
    EXPECT_NE(ini.find("KINEMATICS = trivkins coordinates=XYYZ kinstype=BOTH\n"), std::string::npos);
    EXPECT_NE(ini.find("[JOINT_3]\n"), std::string::npos);
    EXPECT_EQ(ini.find("[JOINT_4]\n"), std::string::npos);
}

}  // namespace
}  // namespace mw::setup
