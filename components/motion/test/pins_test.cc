// SPDX-License-Identifier: GPL-2.0-or-later
// The pin tables of the motion controller, of the running module and of the manual page agree.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "machine/io/tool_offset_pin_tables.hh"
#include "motion/hal/pin_tables.hh"
#include "runtime/virtual_scheduler.hh"
#include "tests/support/pin_page.hh"

namespace mw::motion {
namespace {

using testing::PinText;
using testing::replaced;

std::vector<PinText> rows() {
    return testing::pin_texts([](auto &&show) {
        pins::for_each(show);
        sdk::for_each_pin(io::pins::TOOL_OFFSET, show);
    });
}

/// Every pin of a machine with these counts, by name.
std::map<std::string, PinText> expected(const std::map<std::string, int> &counts,
                                        const std::set<int> &unlocked, int first_extra) {
    std::map<std::string, PinText> out;
    for (const PinText &row : rows()) {
        const std::string scope = row.name.substr(0, row.name.find_first_of("NL"));
        const bool is_unlock = row.name == "joint.N.unlock" || row.name == "joint.N.is-unlocked";
        const auto found = counts.find(scope);
        const int count = found == counts.end() ? 1 : found->second;
        for (int i = 0; i < count; ++i) {
            const std::string two = (i < 10 ? "0" : "") + std::to_string(i);
            std::string name = replaced(row.name, "NN", two);
            name = replaced(name, "N", std::to_string(i));
            name = i < MAX_AXES ? replaced(name, "L", std::string(1, geometry::AXIS_LETTERS_LOWER[i])) : name;
            const bool of_switchable = row.name == "motion.switchkins-type";
            const bool of_others = row.name == "joint.N.posthome-cmd" && i < first_extra;
            if ((!is_unlock || unlocked.contains(i)) && !of_switchable && !of_others) {
                out[name] = row;
            }
        }
    }
    return out;
}

TEST(MotmodPins, EveryRowOfTheTablesIsAPinAndEveryPinIsARow) {
    runtime::VirtualScheduler clock;
    hal::InstanceOptions options;
    options.scheduler = &clock;
    auto host = hal::LocalHost::create(options, {MW_MODULE_FOLDER});
    ASSERT_TRUE(host.has_value());
    ASSERT_TRUE((*host)->load_realtime("trivkins", {}).has_value());
    ASSERT_TRUE(
        (*host)
            ->load_realtime("motmod", {"num_joints=12", "num_spindles=2", "num_dio=11", "num_aio=3",
                                       "num_misc_error=2", "unlock_joints_mask=18", "num_extrajoints=3"})
            .has_value());
    const std::map<std::string, int> counts = {{"joint.", 12},
                                               {"spindle.", 2},
                                               {"axis.", MAX_AXES},
                                               {"motion.tooloffset.", MAX_AXES},
                                               {"motion.digital-in-", 11},
                                               {"motion.digital-out-", 11},
                                               {"motion.analog-in-", 3},
                                               {"motion.analog-out-", 3},
                                               {"motion.misc-error-", 2}};
    const std::map<std::string, PinText> wanted = expected(counts, {1, 4}, 9);
    std::size_t found = 0;
    for (const hal::PinInfo &pin : (*host)->hal().pins().list("*")) {
        if (pin.owner != "motmod" || pin.name.ends_with(".time")) {
            continue;
        }
        ++found;
        const auto row = wanted.find(pin.name);
        ASSERT_NE(row, wanted.end()) << pin.name << " is in no table";
        EXPECT_EQ(pin.type, row->second.type) << pin.name;
        EXPECT_EQ(pin.dir, row->second.dir) << pin.name;
        EXPECT_EQ(pin.value.as_number(), row->second.start) << pin.name;
    }
    EXPECT_EQ(found, wanted.size());
}

TEST(MotmodPins, SwitchableKinematicsHaveThePinOfTheirType) {
    runtime::VirtualScheduler clock;
    hal::InstanceOptions options;
    options.scheduler = &clock;
    auto host = hal::LocalHost::create(options, {MW_MODULE_FOLDER});
    ASSERT_TRUE(host.has_value());
    ASSERT_TRUE((*host)->load_realtime("xyzac-trt-kins", {}).has_value());
    ASSERT_TRUE((*host)->load_realtime("motmod", {"num_joints=5"}).has_value());
    const std::vector<hal::PinInfo> pins = (*host)->hal().pins().list("motion.switchkins-type");
    ASSERT_EQ(pins.size(), 1U);
    EXPECT_EQ(pins[0].type, hal::Type::FLOAT);
    EXPECT_EQ(pins[0].dir, hal::Dir::IN);
}

TEST(MotmodPins, TheManualPageHasEachRowAndNoOther) {
    std::vector<std::string> wanted;
    std::string section;
    for (const PinText &row : rows()) {
        wanted.push_back(testing::page_line(row));
        section += wanted.back() + '\n';
    }
    wanted.emplace_back("*servo-thread.threadbeat* s64 out: counts the cycles of the thread");
    EXPECT_EQ(testing::page_pins(MW_MOTMOD_PAGE), wanted) << "below '# PINS' the page is to have:\n"
                                                          << section;
}

TEST(MotmodPins, EveryRowSaysWhatThePinIsFor) {
    std::set<std::string> names;
    for (const PinText &row : rows()) {
        EXPECT_FALSE(row.doc.empty()) << row.name;
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " is in the tables twice";
        const bool is_measure = row.type == hal::Type::FLOAT && row.dir == hal::Dir::OUT;
        const bool plain = row.doc.find("external offsets") != std::string::npos ||
                           row.name.find("analog") != std::string::npos;
        EXPECT_TRUE(!is_measure || plain || !row.unit.empty()) << row.name << " has no unit";
    }
}

}  // namespace
}  // namespace mw::motion
