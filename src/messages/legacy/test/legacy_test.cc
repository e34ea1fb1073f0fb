// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "messages/legacy/status_table.hh"
#include "messages/legacy/units.hh"

namespace mw::legacy {
namespace {

template <class Table>
std::multiset<std::string> names_in(const Table &table, const char *Names::*member) {
    std::multiset<std::string> names;
    for_each_row(table, [&](const auto &one) {
        if (isNamed(one.names.*member)) {
            names.insert(one.names.*member);
        }
    });
    return names;
}

TEST(LegacyTable, EachClientHasANameOnce) {
    for (const auto member : {&Names::python, &Names::python_int, &Names::rsh, &Names::tcl}) {
        for (const auto &names :
             {names_in(STATUS, member), names_in(JOINT_STATUS, member), names_in(SPINDLE_STATUS, member)}) {
            for (const std::string &name : names) {
                EXPECT_EQ(names.count(name), 1U) << name;
            }
        }
    }
    EXPECT_GT(names_in(STATUS, &Names::python).size(), 70U);
}

TEST(LegacyTable, EachRowHasAMeaningAndAClientAndAFormWhereItIsWritten) {
    const auto check = [](const auto &one) {
        const Names &names = one.names;
        const bool written = isNamed(names.rsh) || isNamed(names.tcl);
        EXPECT_TRUE(written || isNamed(names.python) || isNamed(names.python_int)) << one.doc;
        EXPECT_FALSE(written && one.form == Form::NONE) << one.doc;
        EXPECT_FALSE(isNamed(names.python) && isNamed(names.python_int)) << one.doc;
        EXPECT_FALSE(isNamed(names.tcl_order) && !isNamed(names.rsh)) << one.doc;
        EXPECT_TRUE(isNamed(one.doc));
    };
    for_each_row(STATUS, check);
    for_each_row(JOINT_STATUS, check);
    for_each_row(SPINDLE_STATUS, check);
}

TEST(LegacyForms, TheSameValueInEachDialect) {
    const auto all = [](Form form, const auto &value) {
        return text(form, Dialect::RSH, value) + " " + text(form, Dialect::OLD_RSH, value) + " " +
               text(form, Dialect::TCL, value);
    };
    EXPECT_EQ(all(Form::ON_OFF, true), "ON ON on");
    EXPECT_EQ(all(Form::SWITCH, true), "ON 1 1");
    EXPECT_EQ(all(Form::SWITCH, false), "OFF 0 0");
    EXPECT_EQ(all(Form::TELEOP, true), "ON YES 1");
    EXPECT_EQ(all(Form::YES_NO, false), "NO 0 0");
    EXPECT_EQ(all(Form::DIGIT, true), "1 1 1");
    EXPECT_EQ(all(Form::HOMED, true), "YES YES homed");
    EXPECT_EQ(all(Form::HOMED, false), "NO NO not");
    EXPECT_EQ(all(Form::PERCENT, 0.755), "75.500000 76 76");
    EXPECT_EQ(all(Form::NUMBER, 7), "7 7 7");
    EXPECT_EQ(all(Form::BITS, std::uint32_t{0xa0}), "0x000000a0 160 160");
    EXPECT_EQ(all(Form::WORD, messages::Mode::MDI), "MDI MDI mdi");
    EXPECT_EQ(all(Form::NUMBER, messages::Kinematics::BOTH), "4 4 4");
    EXPECT_EQ(all(Form::WORD, std::string("MAXHARD")), "MAXHARD MAXHARD maxhard");
    EXPECT_EQ(all(Form::PATH, std::string("/A.ngc")), "/A.ngc /A.ngc /A.ngc");
    EXPECT_EQ(all(Form::PATH, std::string()), "NONE NONE none");
}

TEST(LegacyUnits, SpeedsOfOperatorsArePerMinuteAndOverridesPercent) {
    EXPECT_DOUBLE_EQ(per_second(600), 10);
    EXPECT_DOUBLE_EQ(factor(120), 1.2);
    EXPECT_DOUBLE_EQ(percent(1.2), 120);
    EXPECT_EQ(name_of_length(1), "MM");
    EXPECT_EQ(name_of_length(0.03937), "INCH");
    EXPECT_EQ(name_of_length(3), "CUSTOM");
    EXPECT_EQ(name_of_angle(0.01745), "RAD");
}

TEST(LegacyTable, APositionOfProgramsHasNoOffsets) {
    const auto status = std::make_unique<Status>();
    status->offsets.g5x[geometry::AXIS_X] = 10;
    status->offsets.g92[geometry::AXIS_Y] = 1;
    status->offsets.tool[geometry::AXIS_Z] = 5;
    status->offsets.rotation_xy_deg = 90;
    geometry::Pose machine;
    machine[geometry::AXIS_X] = 10;
    machine[geometry::AXIS_Y] = 3;
    const geometry::Pose program = program_position(*status, machine);
    EXPECT_NEAR(program[geometry::AXIS_X], 3, 1e-12);
    EXPECT_NEAR(program[geometry::AXIS_Y], -1, 1e-12);
    EXPECT_NEAR(program[geometry::AXIS_Z], -5, 1e-12);
}

}  // namespace
}  // namespace mw::legacy
