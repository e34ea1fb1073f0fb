// SPDX-License-Identifier: GPL-2.0-or-later
// Compares the table of published values with the declaration of the status.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "base/text.hh"
#include "clients/publish/field_path.hh"
#include "clients/publish/readings.hh"

namespace mw::publish {
namespace {

TEST(PublishedTable, HasEachFieldOfTheStatusOrTheReasonWhyNot) {
    std::set<std::string> published, left_out;
    for (const Row &row : rows()) {
        for (const std::string &field : split_words(row.fields)) {
            published.insert(field);
        }
    }
    for (const NotPublished &one : not_published()) {
        EXPECT_TRUE(left_out.insert(one.field).second) << one.field << " is twice among those not published";
        EXPECT_NE(std::string(one.reason), "") << one.field;
    }
    std::set<std::string> used;
    for (const std::string &field : all_fields()) {
        const auto without = std::ranges::find_if(left_out, [&field](const std::string &part) {
            return field == part || field.starts_with(part + '.');
        });
        const bool isPublished = published.contains(field);
        EXPECT_NE(isPublished, without != left_out.end())
            << field << " must be in exactly one of the two tables";
        if (without != left_out.end()) {
            used.insert(*without);
        }
    }
    EXPECT_EQ(used, left_out) << "a part that is not published does not exist";
}

TEST(PublishedTable, NamesFieldsThatThereAre) {
    for (const Row &row : rows()) {
        for (const std::string &field : split_words(row.fields)) {
            EXPECT_TRUE(FieldPath::find(field).has_value()) << field;
        }
    }
    EXPECT_FALSE(FieldPath::find("task").has_value());
    EXPECT_FALSE(FieldPath::find("task.nothing").has_value());
    EXPECT_FALSE(FieldPath::find("").has_value());
}

TEST(PublishedTable, HasEachMetricAndEachDataItemOnce) {
    std::set<std::string> metrics, items;
    for (const Row &row : rows()) {
        EXPECT_TRUE(metrics.insert(row.metric).second) << row.metric;
        EXPECT_EQ(std::string(row.metric).find('#') != std::string::npos, row.each != Each::ONCE)
            << row.metric;
        EXPECT_GE(row.deadband, 0) << row.metric;
        EXPECT_EQ(row.calculate != nullptr, *row.doc != '\0') << row.metric;
        const std::string type = std::string(row.item.type) + ' ' + row.item.sub_type;
        if (row.item.component != Component::NONE) {
            EXPECT_TRUE(items.insert(std::to_string(static_cast<int>(row.item.component)) + type).second)
                << type;
            EXPECT_EQ(row.item.category == Category::SAMPLE && *row.item.units == '\0', false) << type;
        }
    }
}

TEST(PublishedTable, IsThePageOfTheReference) {
    const std::string page = published_page();
    EXPECT_NE(page.find("| Axes/#/Position | Double | machine units, degrees | 0.001 |"), std::string::npos)
        << page;
    EXPECT_NE(page.find("SAMPLE POSITION ACTUAL, MILLIMETER"), std::string::npos);
    EXPECT_NE(page.find("| motion.cycle | counts servo cycles |"), std::string::npos);
}

messages::MachineStatus mill() {
    messages::MachineStatus status;
    status.trajectory.axis_mask = 0b1011;  // X Y A
    status.trajectory.num_joints = 3;
    status.trajectory.num_spindles = 1;
    status.settings.joints[2].kind = messages::JointKind::ANGULAR;
    return status;
}

std::string unit(const Readings &readings, const std::string &name) {
    const auto found = std::ranges::find(readings.metrics(), name, &Metric::name);
    return found == readings.metrics().end() ? "absent" : found->unit;
}

TEST(PublishedReadings, FitTheAxesAndUnitsOfTheMachine) {
    messages::MachineStatus status = mill();
    Readings readings;
    readings.fit(status);
    EXPECT_EQ(unit(readings, "Axes/X/Position"), "mm");
    EXPECT_EQ(unit(readings, "Axes/A/Position"), "deg");
    EXPECT_EQ(unit(readings, "Axes/Z/Position"), "absent");
    EXPECT_EQ(unit(readings, "Joints/2/Max Velocity"), "deg/s");
    EXPECT_EQ(unit(readings, "Joints/3/Position"), "absent");
    EXPECT_EQ(unit(readings, "Motion/Feed Rate"), "mm/s");
    EXPECT_FALSE(readings.isOther(status));
    status.settings.linear_units = 1 / 25.4;
    EXPECT_TRUE(readings.isOther(status));
    readings.fit(status);
    EXPECT_EQ(unit(readings, "Axes/X/Position"), "in");
}

TEST(PublishedReadings, ReportAChangeByItsDeadband) {
    messages::MachineStatus status = mill();
    Readings readings({{"Axes/#/Position", 0.5}});
    readings.fit(status);
    static_cast<void>(readings.all(status));
    EXPECT_TRUE(readings.changes(status).empty());
    status.trajectory.isPositionValid = true;
    EXPECT_EQ(readings.changes(status).size(), 3U) << "all positions become known";
    status.trajectory.position_fb[0] = 0.4;
    EXPECT_TRUE(readings.changes(status).empty());
    status.trajectory.position_fb[0] = 0.5;
    const auto changes = readings.changes(status);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(readings.metrics()[changes[0].metric].name, "Axes/X/Position");
    EXPECT_EQ(changes[0].value, Value(0.5));
    EXPECT_TRUE(readings.changes(status).empty());
    status.task.state = messages::State::ON;
    EXPECT_EQ(readings.changes(status).size(), 2U) << "state, and what is executed";
}

TEST(PublishedReadings, CalculateWhatIsExecutedAndWhatIsWrong) {
    messages::MachineStatus status = mill();
    Readings readings;
    readings.fit(status);
    const auto value = [&](const std::string &name) {
        const auto found = std::ranges::find(readings.metrics(), name, &Metric::name);
        return std::get<std::string>(
            readings.all(status)[static_cast<std::size_t>(found - readings.metrics().begin())]);
    };
    EXPECT_EQ(value("Execution"), "STOPPED");
    status.task.state = messages::State::ON;
    EXPECT_EQ(value("Execution"), "READY");
    status.task.interp_state = messages::InterpState::WAITING;
    EXPECT_EQ(value("Execution"), "ACTIVE");
    status.task.waiting.what = messages::WaitFor::DIGITAL_INPUT;
    EXPECT_EQ(value("Execution"), "WAIT");
    status.trajectory.isPaused = true;
    EXPECT_EQ(value("Execution"), "FEED_HOLD");
    status.task.isPaused = true;
    EXPECT_EQ(value("Execution"), "INTERRUPTED");
    status.task.isStoppedByProgram = true;
    EXPECT_EQ(value("Execution"), "PROGRAM_STOPPED");
    EXPECT_EQ(value("Alarms/Drives"), "");
    status.joints[1].isFaulted = status.joints[2].isFerrorTripped = true;
    EXPECT_EQ(value("Alarms/Drives"), "Joint 1: amplifier fault. Joint 2: following error.");
    status.codes.g = {0, 10, 170, 591, -1};
    status.codes.g[3] = 591;
    std::fill(status.codes.g.begin() + 4, status.codes.g.end(), -1);
    EXPECT_EQ(value("Program/G Codes"), "G1 G17 G59.1");
}

TEST(PublishedText, IsValidForXmlAndProtobuf) {
    EXPECT_EQ(clean_text("Fräse 1"), "Fräse 1");
    EXPECT_EQ(clean_text("a\x01"
                         "b\nc"),
              "a\xEF\xBF\xBD"
              "b c");
    EXPECT_EQ(clean_text("\xC3"), "\xEF\xBF\xBD");
    EXPECT_EQ(clean_text("\xED\xA0\x80").find('\xED'), std::string::npos) << "a surrogate";
    EXPECT_EQ(clean_text("\xF0\x9F\x94\xA7"), "\xF0\x9F\x94\xA7");
}

}  // namespace
}  // namespace mw::publish
