// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "machine/config/ini_keys.hh"
#include "machine/config/loaded_config.hh"
#include "machine/config/machine_config.hh"
#include "motion/interface/parameters.hh"

namespace mw::machine {
namespace {

constexpr const char *GOOD =
    "[TRAJ]\nCOORDINATES = X Z\nLINEAR_UNITS = inch\n[KINS]\nKINEMATICS = trivkins coordinates=XZ\n"
    "JOINTS = 2\n[HAL]\nHALFILE = LIB:core_sim.hal\n"
    "[AXIS_X]\nMIN_LIMIT = -1\nMAX_LIMIT = 2\n[AXIS_Z]\nMAX_VELOCITY = 3\n"
    "[JOINT_0]\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\n"
    "[JOINT_1]\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\n";

struct Config {
    explicit Config(const std::string &text)
        : ini(ini::IniFile::parse(text, "m.ini", sink)), reader(ini, sink),
          machine(read_machine_config(reader)) {}
    bool says(const std::string &text) const {
        return std::any_of(sink.all().begin(), sink.all().end(),
                           [&](const auto &d) { return d.str().find(text) != std::string::npos; });
    }
    double parameter(motion::Parameter which, int index) const {
        for (const auto &p : machine.parameters) {
            if (p.parameter == static_cast<std::uint16_t>(which) && p.index == index) {
                return p.value;
            }
        }
        return -1;
    }

    diagnostics::Sink sink;
    ini::IniFile ini;
    ini::IniReader reader;
    MachineConfig machine;
};

std::string replaced(std::string text, const std::string &from, const std::string &to) {
    const auto at = text.find(from);
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(MachineConfig, ExtraJointsAreTheLastOnesAndLimitNoAxis) {
    const std::string more =
        replaced(GOOD, "JOINTS = 2\n", "JOINTS = 3\n[EMCMOT]\nEMCMOT = motmod num_extrajoints=1\n") +
        "[JOINT_2]\nMAX_VELOCITY = 7\nMAX_ACCELERATION = 70\nMAX_LIMIT = 0.5\n";
    const Config c(more);
    ASSERT_FALSE(c.sink.hasErrors());
    EXPECT_EQ(c.machine.num_joints, 3);
    EXPECT_EQ(c.machine.axis_map.num_extra, 1);
    const motion::FoldedLimits limits = c.machine.limits();
    EXPECT_EQ(limits.joints.count, 2);
    EXPECT_EQ(limits.high[0], 2);
    EXPECT_EQ(limits.joint_jog[2].velocity, 7);
    const Config none(replaced(more, "num_extrajoints=1", "num_extrajoints=3"));
    EXPECT_TRUE(none.says("num_extrajoints=3 is not possible"));
}

constexpr const char *TURNING =
    "[TRAJ]\nCOORDINATES = X A\nLINEAR_UNITS = mm\n[KINS]\nKINEMATICS = trivkins coordinates=XA\nJOINTS = 2\n"
    "[EMCMOT]\nEMCMOT = motmod unlock_joints_mask=0x2\n[HAL]\nHALFILE = LIB:core_sim.hal\n"
    "[JOINT_0]\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\n"
    "[JOINT_1]\nTYPE = ANGULAR\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\nLOCKING_INDEXER = 1\n"
    "[AXIS_X]\nMIN_LIMIT = 0\nMAX_LIMIT = 10\n[AXIS_A]\nLOCKING_INDEXER_JOINT = 1\nWRAPPED_ROTARY = 1\n";

TEST(MachineConfig, WrappedAxesAndIndexersAreReadAndWhatDoesNotFitIsSaid) {
    const Config c(TURNING);
    ASSERT_FALSE(c.sink.hasErrors());
    EXPECT_FALSE(c.says("WRAPPED_ROTARY"));
    EXPECT_FALSE(c.says("LOCKING_INDEXER_JOINT"));
    EXPECT_EQ(c.parameter(motion::Parameter::AXIS_LOCKING_INDEXER_JOINT, geometry::AXIS_A), 1);
    EXPECT_EQ(c.machine.limits().indexer[geometry::AXIS_A], 1);
    EXPECT_TRUE(c.machine.task.interpreter.rotary.isWrapped(geometry::AXIS_A));
    EXPECT_EQ(c.machine.task.interpreter.rotary.indexer_joint(geometry::AXIS_A), 1);
    EXPECT_TRUE(Config(std::string(TURNING) + "MAX_LIMIT = 400\n").says("still limit the axis"));
    EXPECT_TRUE(Config(replaced(TURNING, "mask=0x2", "mask=0x1")).says("the axis never unlocks"));
    EXPECT_TRUE(Config(replaced(TURNING, "INDEXER_JOINT = 1", "INDEXER_JOINT = 0")).sink.hasErrors());
    EXPECT_TRUE(Config(replaced(TURNING, "INDEXER_JOINT = 1", "INDEXER_JOINT = 7")).sink.hasErrors());
    EXPECT_TRUE(
        Config(replaced(TURNING, "[AXIS_X]", "[AXIS_X]\nWRAPPED_ROTARY = 1")).says("only A, B and C"));
}

TEST(MachineConfig, AxesAndJointsAreDifferentThings) {
    const Config c(GOOD);
    ASSERT_FALSE(c.sink.hasErrors());
    EXPECT_EQ(c.machine.axis_mask, 5U);
    EXPECT_EQ(c.machine.num_joints, 2);
    EXPECT_EQ(c.machine.joint_of_axis[2], 1);
    EXPECT_EQ(c.machine.joint_of_axis[1], -1);
    EXPECT_FALSE(c.machine.metric);
    EXPECT_EQ(c.parameter(motion::Parameter::AXIS_MAX_LIMIT, 0), 2.0);
    EXPECT_EQ(c.parameter(motion::Parameter::JOINT_MAX_ACCELERATION, 1), 10.0);
}

TEST(MachineConfig, ATableOfScrewErrorsIsReadAndChecked) {
    std::string name = (std::filesystem::temp_directory_path() / "screw-XXXXXX").string();
    ::close(::mkstemp(name.data()));
    const auto with = [&](const std::string &lines, const std::string &table) {
        EXPECT_TRUE(write_file_atomically(name, table).has_value());
        return replaced(GOOD, "[JOINT_1]\n", "[JOINT_1]\nCOMP_FILE = " + name + "\n" + lines);
    };
    const Config good(with("COMP_FILE_TYPE = 0\n", "0 0.01 -0.01\n10 10.02 9.98\n"));
    ASSERT_FALSE(good.sink.hasErrors());
    ASSERT_EQ(good.machine.screw_tables.size(), 1U);
    ASSERT_EQ(good.machine.screw_tables[0].size(), 2U);
    EXPECT_EQ(good.machine.screw_tables[0][1].joint, 1);
    EXPECT_NEAR(good.machine.screw_tables[0][1].forward, -0.02, 1e-12);
    EXPECT_FALSE(good.says("COMP_FILE"));
    EXPECT_TRUE(Config(with("", "0 0 0\n")).says("[JOINT_1]COMP_FILE_TYPE is missing"));
    const Config bad(with("COMP_FILE_TYPE = 1\n", "0 0 0\n-1 0 0\n"));
    EXPECT_TRUE(bad.sink.hasErrors());
    EXPECT_TRUE(bad.says(name + ":2:1: "));
    EXPECT_TRUE(bad.says("the position -1 is not above 0"));
    EXPECT_TRUE(Config(with("COMP_FILE_TYPE = 2\n", "0 0 0\n")).sink.hasErrors());
    std::filesystem::remove(name);
    EXPECT_TRUE(
        Config(replaced(GOOD, "[JOINT_1]\n", "[JOINT_1]\nCOMP_FILE = " + name + "\n")).sink.hasErrors());
}

TEST(MachineConfig, ProbesInJogsAndExternalOffsetsAreSettingsOfMotion) {
    using motion::Parameter;
    const Config c(replaced(GOOD, "[AXIS_X]\n", "[AXIS_X]\nOFFSET_AV_RATIO = 0.2\n") +
                   "[TRAJ]\nNO_PROBE_JOG_ERROR = 1\nNO_PROBE_HOME_ERROR = 1\n");
    ASSERT_FALSE(c.sink.hasErrors());
    EXPECT_EQ(c.parameter(Parameter::TRAJ_NO_PROBE_JOG_ERROR, 0), 1);
    EXPECT_EQ(c.parameter(Parameter::TRAJ_NO_PROBE_HOME_ERROR, 0), 1);
    EXPECT_EQ(c.parameter(Parameter::AXIS_OFFSET_RATIO, 0), 0.2);
    EXPECT_EQ(c.parameter(Parameter::TRAJ_MM_PER_UNIT, 0), 25.4);
    EXPECT_DOUBLE_EQ(c.machine.limits().path.velocity[0], 0.8);
    EXPECT_DOUBLE_EQ(c.machine.limits().offset[0].velocity, 0.2);
    EXPECT_TRUE(Config(replaced(GOOD, "[AXIS_X]\n", "[AXIS_X]\nOFFSET_AV_RATIO = 0.95\n")).sink.hasErrors());
    std::string other = replaced(GOOD, "[AXIS_X]\n", "[AXIS_X]\nOFFSET_AV_RATIO = 0.2\n");
    EXPECT_TRUE(Config(replaced(other, "trivkins coordinates=XZ", "tablekins"))
                    .says("[AXIS_X]OFFSET_AV_RATIO has no effect"));
    other = replaced(GOOD, "[AXIS_X]\n", "[AXIS_X]\nMAX_VELOCITY = 1\nOFFSET_AV_RATIO = 0.2\n");
    const Config table(replaced(other, "trivkins coordinates=XZ", "tablekins"));
    EXPECT_DOUBLE_EQ(table.machine.limits().path.velocity[0], 1) << "the axis keeps all of its speed";
    for (const char *linear : {"corexykins", "matrixkins"}) {
        const Config with(replaced(other, "trivkins coordinates=XZ", linear));
        EXPECT_FALSE(with.says("OFFSET_AV_RATIO")) << linear;
        EXPECT_DOUBLE_EQ(with.machine.limits().offset[0].velocity, 0.2) << linear;
    }
    EXPECT_TRUE(Config(replaced(other, "trivkins coordinates=XZ", "rotatekins"))
                    .says("[AXIS_X]OFFSET_AV_RATIO has no effect"));
    other = replaced(GOOD, "[AXIS_Z]\n", "[AXIS_Z]\nOFFSET_AV_RATIO = 0.2\n");
    other = replaced(replaced(other, "trivkins coordinates=XZ", "rotatekins"), "JOINTS = 2", "JOINTS = 3");
    EXPECT_FALSE(Config(other).says("OFFSET_AV_RATIO"));
}

TEST(MachineConfig, SpeedOfRotaryAxesIsLimitedWhateverTheSpeedOfTheFirstJoint) {
    // Without trivial kinematics no joint belongs to one axis, so slow joints must not remove the limit.
    const Config c("[TRAJ]\nCOORDINATES = X Y Z A C\nMAX_ANGULAR_VELOCITY = 5\n[KINS]\n"
                   "KINEMATICS = tablekins\nJOINTS = 5\n[HAL]\nHALFILE = LIB:core_sim.hal\n"
                   "[JOINT_0]\nMAX_VELOCITY = 1\n[JOINT_3]\nMAX_VELOCITY = 4\n[JOINT_4]\nMAX_VELOCITY = 4\n");
    EXPECT_EQ(c.parameter(motion::Parameter::AXIS_MAX_VELOCITY, geometry::AXIS_C), 5.0);
    EXPECT_EQ(c.machine.limits().path.velocity[geometry::AXIS_C], 5.0);
}

TEST(MachineConfig, AnEmptyParameterFileIsTold) {
    std::string name = (std::filesystem::temp_directory_path() / "parameters-XXXXXX").string();
    ::close(::mkstemp(name.data()));
    const std::string text = std::string(GOOD) + "[RS274NGC]\nPARAMETER_FILE = " + name + "\n";
    EXPECT_TRUE(Config(text).says("is empty: all offsets and parameters begin at 0"));
    std::ofstream(name) << "5220\t1.0\n";
    EXPECT_FALSE(Config(text).says("is empty"));
    std::filesystem::remove(name);
    EXPECT_FALSE(Config(text).says("is empty")) << "a new machine has none yet";
}

TEST(MachineConfig, KeysWithoutEffectAreNamedAndErrorsWhenStrict) {
    for (const char *line :
         {"[TRAJ]\nPOSITION_FILE = p.txt\n", "[TRAJ]\nARC_BLEND_GAP_CYCLES = 4\n", "[TASK]\nTASK = mytask\n",
          "[RS274NGC]\nLOG_FILE = x\n", "[RS274NGC]\nNO_DOWNCASE_OWORD = 1\n"}) {
        Config c(std::string(GOOD) + line);
        EXPECT_FALSE(c.sink.hasErrors()) << line;
        c.reader.report_unknown(true);
        EXPECT_TRUE(c.sink.hasErrors()) << line;
        EXPECT_TRUE(c.says("has no effect: ")) << line;
    }
    Config usual(std::string(GOOD) +
                 "[TRAJ]\nTPMOD = tpmod\n[TASK]\nTASK = milltask\n[DISPLAY]\nDISPLAY = axis\n");
    usual.reader.report_unknown(true);
    EXPECT_FALSE(usual.sink.hasErrors());
    Config display(std::string(GOOD) + "[DISPLAY]\nMAX_FEED_OVERIDE = 2\n");
    display.reader.report_unknown(false);
    EXPECT_TRUE(display.says("did you mean MAX_FEED_OVERRIDE?"));
}

TEST(MachineConfig, KeysOfEachMultimessageAreKnown) {
    Config known(std::string(GOOD) + "[DISPLAY]\nMULTIMESSAGE_ID = VFD\nMULTIMESSAGE_VFD_NUMBER = 1\n"
                                     "MULTIMESSAGE_VFD_TYPE = okdialog\nMULTIMESSAGE_VFD_TITLE = t\n"
                                     "MULTIMESSAGE_VFD_TEXT = x\nMULTIMESSAGE_VFD_DETAILS = d\n"
                                     "MULTIMESSAGE_VFD_ICON = INFO\nMULTIMESSAGE_VFD_NUMBER = 2\n");
    known.reader.report_unknown(true);
    EXPECT_FALSE(known.sink.hasErrors());
    Config unknown(std::string(GOOD) + "[DISPLAY]\nMULTIMESSAGE_ID = VFD\nMULTIMESSAGE_VDF_TEXT = x\n");
    unknown.reader.report_unknown(true);
    EXPECT_TRUE(unknown.sink.hasErrors());
}

/// Minimum and maximum of M3, then of M4.
using SpindleRange = std::array<double, 4>;
SpindleRange range_of(const std::string &spindle) {
    const Config c(std::string(GOOD) + "[SPINDLE_0]\n" + spindle);
    EXPECT_FALSE(c.sink.hasErrors());
    return {c.parameter(motion::Parameter::SPINDLE_MIN_FORWARD, 0),
            c.parameter(motion::Parameter::SPINDLE_MAX_FORWARD, 0),
            c.parameter(motion::Parameter::SPINDLE_MIN_REVERSE, 0),
            c.parameter(motion::Parameter::SPINDLE_MAX_REVERSE, 0)};
}

TEST(MachineConfig, LimitsOfASpindleHoldInReverseUnlessItHasItsOwn) {
    constexpr double NONE = -1;
    EXPECT_EQ(range_of("INCREMENT = 5\n"), (SpindleRange{NONE, NONE, NONE, NONE}));
    EXPECT_EQ(range_of("MIN_VELOCITY = 100\nMAX_VELOCITY = 1000\n"), (SpindleRange{100, 1000, 100, 1000}));
    EXPECT_EQ(range_of("MIN_FORWARD_VELOCITY = 100\nMAX_FORWARD_VELOCITY = 1000\n"),
              (SpindleRange{100, 1000, 100, 1000}));
    EXPECT_EQ(range_of("MAX_VELOCITY = 1000\nMAX_REVERSE_VELOCITY = 0\n"),
              (SpindleRange{NONE, 1000, NONE, 0}));
    EXPECT_EQ(range_of("MAX_REVERSE_VELOCITY = 500\nMIN_VELOCITY = 100\nMIN_REVERSE_VELOCITY = 80\n"),
              (SpindleRange{100, NONE, 80, 500}));
    EXPECT_EQ(range_of("MAX_FORWARD_VELOCITY = 900\nMAX_VELOCITY = 1000\nMIN_FORWARD_VELOCITY = 90\n"
                       "MIN_VELOCITY = 100\n"),
              (SpindleRange{100, 900, 100, 900}))
        << "the narrower one";
    EXPECT_TRUE(Config(std::string(GOOD) + "[SPINDLE_0]\nMAX_FORWARD_VELOCITY = 900\nMAX_VELOCITY = 1000\n")
                    .says("MAX_VELOCITY and MAX_FORWARD_VELOCITY limit the same direction"));
}

TEST(MachineConfig, AnOverrideLimitThatLooksLikeAPercentageIsReported) {
    Config percent(std::string(GOOD) + "[DISPLAY]\nMAX_FEED_OVERRIDE = 120\nMAX_SPINDLE_1_OVERRIDE = 150\n");
    EXPECT_TRUE(percent.says("[DISPLAY]MAX_FEED_OVERRIDE = 120: the override may reach 12000 %"));
    EXPECT_TRUE(percent.says("[DISPLAY]MAX_SPINDLE_1_OVERRIDE = 150: the override may reach 15000 %"));
    EXPECT_TRUE(percent.says("1.0 is 100 %"));
    Config ratio(std::string(GOOD) + "[DISPLAY]\nMAX_FEED_OVERRIDE = 1.2\n");
    EXPECT_FALSE(ratio.says("the override may reach"));
}

TEST(MachineConfig, AFileOfAnOlderFormNamesUpdateIni) {
    Config version(std::string(GOOD) + "[EMC]\nVERSION = 1.0\n");
    EXPECT_TRUE(version.says("[EMC]VERSION = 1.0 is an older format"));
    EXPECT_TRUE(version.says("update_ini"));
    Config axes(std::string(GOOD) + "[AXIS_0]\nMAX_VELOCITY = 1\n");
    EXPECT_TRUE(axes.sink.hasErrors());
    EXPECT_TRUE(axes.says("section [AXIS_0] has the format before LinuxCNC 2.8"));
    EXPECT_TRUE(axes.says("update_ini"));
}

/// A new key is one row in a table (docs/developer/extending/ini_key.md).
TEST(IniKeys, EachIsDeclaredOnceWithItsMeaning) {
    std::set<std::pair<std::string_view, std::string_view>> seen;
    for (const ini::IniKey &key : all_ini_keys()) {
        EXPECT_TRUE(seen.emplace(key.section, key.name).second) << key.section << ' ' << key.name << " twice";
        EXPECT_FALSE(key.doc.empty()) << key.name;
        EXPECT_LE(key.lowest, key.highest) << key.name;
        if (key.kind == ini::IniKind::CHOICE) {
            const std::vector<std::string> words = split_words(key.words);
            EXPECT_NE(std::ranges::find(words, key.text), words.end()) << key.name << ": its default";
        }
        if (!key.required && key.kind == ini::IniKind::WHOLE) {
            EXPECT_GE(key.preset, key.lowest) << key.name;
            EXPECT_LE(key.preset, key.highest) << key.name;
        }
    }
    EXPECT_GT(seen.size(), 150U);
}

TEST(IniKeys, EveryKeyWithoutEffectIsToldWhereItIsSet) {
    int told = 0;
    for (const ini::IniKey &key : all_ini_keys()) {
        if (key.effect != ini::IniEffect::NONE) {
            continue;
        }
        std::string section(key.section);
        section = section == "JOINT_*" ? "JOINT_0" : section == "AXIS_*" ? "AXIS_X" : section;
        Config c(std::string(GOOD) + '[' + section + "]\n" + std::string(key.name) + " = odd\n");
        c.reader.report_unknown(false);
        EXPECT_TRUE(
            c.says('[' + section + ']' + std::string(key.name) + " has no effect: " + std::string(key.doc)))
            << key.name;
        ++told;
    }
    EXPECT_GT(told, 10);
}

TEST(IniKeys, TheReferencePageHasEachKey) {
    const std::string page = ini_reference();
    for (const ini::IniKey &key : all_ini_keys()) {
        EXPECT_NE(page.find(key.name), std::string::npos) << key.name;
    }
}

TEST(IniKeys, TheReferencePageHasKeysOfClients) {
    const std::array keys{ini::ini_whole("SHOP", "KEEP_DAYS", "d", 0, {0, 9}, "days that are kept")};
    EXPECT_NE(ini_reference(keys).find("## [SHOP]\n\n| key | value | default | |\n|---|---|---|---|\n"
                                       "| KEEP_DAYS | whole number [d], 0 to 9 | 0 | days that are kept |"),
              std::string::npos);
}

TEST(MachineConfig, TravelsThatCannotWorkAreSaidWithTheirPlace) {
    const Config outside(replaced(GOOD, "MAX_LIMIT = 2\n", "MAX_LIMIT = 2\nHOME = 3\n"));
    EXPECT_TRUE(outside.says("m.ini:12:8: warning: [AXIS_X]HOME = 3 is outside of MIN_LIMIT and MAX_LIMIT"));
    const Config equal(replaced(GOOD, "MAX_LIMIT = 2\n", "MAX_LIMIT = -1\n"));
    EXPECT_TRUE(equal.says("m.ini:10:13: warning: [AXIS_X]MIN_LIMIT and MAX_LIMIT are equal"));
}

TEST(MachineConfig, UnitsMayBeANumberPerMillimetre) {
    const Config metric(replaced(GOOD, "LINEAR_UNITS = inch", "LINEAR_UNITS = 1.0"));
    EXPECT_FALSE(metric.sink.hasErrors());
    EXPECT_TRUE(metric.machine.metric);
    EXPECT_TRUE(metric.says("is interpreted as mm"));
    const Config odd(replaced(GOOD, "LINEAR_UNITS = inch", "LINEAR_UNITS = 2"));
    EXPECT_TRUE(odd.sink.hasErrors());
}

TEST(MachineConfig, EachMissingPartIsOneErrorWithItsPlace) {
    const Config joint(replaced(GOOD, "[JOINT_1]", "[JOINT_7]"));
    EXPECT_TRUE(joint.says("section [JOINT_1] is missing"));
    const Config axis(replaced(GOOD, "[AXIS_X]", "[AXIS_Y]"));
    EXPECT_TRUE(axis.says("section [AXIS_X] is missing"));
    const Config kins(replaced(GOOD, "JOINTS = 2", "JOINT = 2"));
    EXPECT_TRUE(kins.says("[KINS]JOINTS is missing"));
    const Config hal(replaced(GOOD, "[HAL]", "[HALL]"));
    EXPECT_TRUE(hal.says("section [HAL] is missing"));
}

TEST(MachineConfig, ValuesOutOfRangeAreErrorsWithLineAndColumn) {
    const Config c(replaced(GOOD, "MAX_VELOCITY = 1\n", "MAX_VELOCITY = -1\n"));
    EXPECT_TRUE(c.says("m.ini:15:16: error: [JOINT_0]MAX_VELOCITY = -1 is out of range"));
    const Config comma(replaced(GOOD, "MAX_LIMIT = 2", "MAX_LIMIT = 2,5"));
    EXPECT_TRUE(comma.says("m.ini:11:13: error: [AXIS_X]MAX_LIMIT = '2,5' is not a number"));
    const Config letter(replaced(GOOD, "X Z", "X Q"));
    EXPECT_TRUE(letter.says("has the letter 'Q'"));
}

TEST(MachineConfig, OurOwnConfigurationsHaveNoFindings) {
    for (const char *name : {"mill_mm", "mill_inch", "lathe", "mill_xyza", "mill_xyzac", "gantry_xyyz"}) {
        diagnostics::Sink sink;
        const auto loaded =
            LoadedConfig::load(std::string(MW_SOURCE_DIR "/configs/sim/") + name + ".ini", sink);
        ASSERT_NE(loaded, nullptr) << name;
        loaded->reader.report_unknown(true);
        for (const auto &d : sink.all()) {
            ADD_FAILURE() << d.str();
        }
    }
}

}  // namespace
}  // namespace mw::machine
