// SPDX-License-Identifier: GPL-2.0-or-later
// The pin tables of the motion controller, the running module and the manual page say the same.
#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "motion/rt/pin_tables.hh"
#include "rtapi/virtual_scheduler.hh"

namespace mw::motion {
namespace {

struct Row {
    std::string name;  ///< as the manual page has it: joint.N.pos-cmd, motion.digital-in-NN, axis.L.pos-cmd
    hal::Type type = hal::Type::BIT;
    hal::Dir dir = hal::Dir::IN;
    double start = 0;
    std::string unit, doc;
};

std::string replaced(std::string text, const std::string &from, const std::string &to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

std::vector<Row> rows() {
    std::vector<Row> out;
    pins::for_each([&](const char *scope, const auto &row) {
        using Pin = std::remove_cvref_t<decltype(row)>;
        const std::string name = std::string(scope) + '.' + row.name;
        out.push_back({replaced(replaced(name, "#", "N"), "@", "L"),
                       static_cast<hal::Type>(sdk::type_of<typename Pin::Value>()),
                       static_cast<hal::Dir>(Pin::DIRECTION), static_cast<double>(row.start), row.unit,
                       row.doc});
    });
    return out;
}

/// Each pin of a machine with so many of everything, by name.
std::map<std::string, Row> expected(const std::map<std::string, int> &counts, const std::set<int> &unlocked) {
    std::map<std::string, Row> out;
    for (const Row &row : rows()) {
        const std::string scope = row.name.substr(0, row.name.find_first_of("NL"));
        const bool isUnlock = row.name == "joint.N.unlock" || row.name == "joint.N.is-unlocked";
        const auto found = counts.find(scope);
        const int count = found == counts.end() ? 1 : found->second;
        for (int i = 0; i < count; ++i) {
            const std::string two = (i < 10 ? "0" : "") + std::to_string(i);
            std::string name = replaced(row.name, "NN", two);
            name = replaced(name, "N", std::to_string(i));
            name = i < MAX_AXES ? replaced(name, "L", std::string(1, geom::AXIS_LETTERS_LOWER[i])) : name;
            if (!isUnlock || unlocked.contains(i)) {
                out[name] = row;
            }
        }
    }
    return out;
}

TEST(MotmodPins, EveryRowOfTheTablesIsAPinAndEveryPinIsARow_B6) {
    rtapi::VirtualScheduler clock;
    hal::HalOptions options;
    options.scheduler = &clock;
    auto host = hal::LocalHost::create(options, {MW_MODULE_FOLDER});
    ASSERT_TRUE(host.has_value());
    ASSERT_TRUE((*host)->load_realtime("trivkins", {}).has_value());
    ASSERT_TRUE((*host)
                    ->load_realtime("motmod", {"num_joints=12", "num_spindles=2", "num_dio=11", "num_aio=3",
                                               "num_misc_error=2", "unlock_joints_mask=18"})
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
    const std::map<std::string, Row> wanted = expected(counts, {1, 4});
    std::size_t found = 0;
    for (const hal::PinInfo &pin : (*host)->hal().pins("*")) {
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

/// The lines of the manual page, made from the tables.
std::vector<std::string> page_lines() {
    std::vector<std::string> lines;
    for (const Row &row : rows()) {
        std::string dir = hal::dir_name(row.dir);
        std::transform(dir.begin(), dir.end(), dir.begin(), [](char c) { return std::tolower(c); });
        std::string line = '*' + row.name + "* " + hal::type_name(row.type) + ' ' + replaced(dir, "/", "");
        const bool isBit = row.type == hal::Type::BIT;
        line += row.start == 0 ? "" : isBit ? " (default: TRUE)" : " (default: 1)";
        line += ": " + replaced(row.doc, "_", "\\_");
        lines.push_back(line + (row.unit.empty() ? "" : " \\[" + row.unit + "]") + "++");
    }
    lines.push_back("*servo-thread.threadbeat* s64 out: counts the cycles of the thread");
    return lines;
}

TEST(MotmodPins, TheManualPageHasEachRowAndNoOther_B6) {
    std::ifstream page(MW_MOTMOD_PAGE);
    ASSERT_TRUE(page.good()) << MW_MOTMOD_PAGE;
    std::vector<std::string> lines;
    bool isPins = false;
    for (std::string line; std::getline(page, line);) {
        isPins = line.starts_with("# ") ? line == "# PINS" : isPins;
        if (isPins && line.starts_with("*")) {
            lines.push_back(line);
        }
    }
    const std::vector<std::string> wanted = page_lines();
    std::string section;
    for (const std::string &line : wanted) {
        section += line + '\n';
    }
    EXPECT_EQ(lines, wanted) << "below '# PINS' the page is to have:\n" << section;
}

TEST(MotmodPins, EveryRowSaysWhatThePinIsFor_B6) {
    std::set<std::string> names;
    for (const Row &row : rows()) {
        EXPECT_FALSE(row.doc.empty()) << row.name;
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands in the tables twice";
        const bool isMeasure = row.type == hal::Type::FLOAT && row.dir == hal::Dir::OUT;
        const bool isPlain = row.doc.find("external offsets") != std::string::npos ||
                             row.name.find("analog") != std::string::npos;
        EXPECT_TRUE(!isMeasure || isPlain || !row.unit.empty()) << row.name << " has no unit";
    }
}

}  // namespace
}  // namespace mw::motion
