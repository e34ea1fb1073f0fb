// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of the I/O controller in HAL, and in their table and manual page.
#include <map>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "machine/io/pins.hh"
#include "runtime/virtual_scheduler.hh"
#include "tests/support/pin_page.hh"

namespace mw::io {
namespace {

using testing::PinText;

class IoPins : public ::testing::Test {
  protected:
    IoPins() {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options);
        EXPECT_TRUE(made.has_value());
        host = std::move(*made);
        EXPECT_TRUE(pins.create(hal()).has_value());
    }
    ~IoPins() override { pins.destroy(); }
    hal::Instance &hal() { return host->hal(); }
    void set(const std::string &name, const std::string &value) {
        EXPECT_TRUE(hal().values().set("iocontrol.0." + name, value).has_value()) << name;
    }
    double value(const std::string &name) { return hal().values().get("iocontrol.0." + name)->as_number(); }

    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;
    Pins pins;
};

std::vector<PinText> rows() {
    return testing::pin_texts([](auto &&show) { pins::for_each(show); });
}

TEST_F(IoPins, EachInputIsReadFromItsPinAlone) {
    const auto inputs = [this] {
        const Inputs in = pins.read();
        return std::vector<int>{in.emc_enable_in,
                                in.tool_prepared,
                                in.tool_changed,
                                !in.lube_level,
                                in.toolchanger_fault,
                                in.toolchanger_reason,
                                in.toolchanger_clear_fault,
                                in.emc_abort_ack,
                                in.start_change_ack};
    };
    EXPECT_EQ(inputs(), std::vector<int>(9, 0));
    const char *const NAMES[] = {"emc-enable-in",
                                 "tool-prepared",
                                 "tool-changed",
                                 "lube_level",
                                 "toolchanger-fault",
                                 "toolchanger-reason",
                                 "toolchanger-clear-fault",
                                 "emc-abort-ack",
                                 "start-change-ack"};
    for (std::size_t i = 0; i < std::size(NAMES); ++i) {
        const bool is_lube = NAMES[i] == std::string("lube_level");
        set(NAMES[i], is_lube ? "0" : "1");
        std::vector<int> wanted(9, 0);
        wanted[i] = 1;
        EXPECT_EQ(inputs(), wanted) << NAMES[i];
        set(NAMES[i], is_lube ? "1" : "0");
    }
}

TEST_F(IoPins, EachOutputIsWrittenToItsPinAlone) {
    const std::map<std::string, std::function<void(Outputs &)>> OUTPUTS = {
        {"user-enable-out", [](Outputs &o) { o.user_enable_out = true; }},
        {"user-request-enable", [](Outputs &o) { o.user_request_enable = true; }},
        {"coolant-mist", [](Outputs &o) { o.coolant_mist = true; }},
        {"coolant-flood", [](Outputs &o) { o.coolant_flood = true; }},
        {"lube", [](Outputs &o) { o.lube = true; }},
        {"tool-prepare", [](Outputs &o) { o.tool_prepare = true; }},
        {"tool-change", [](Outputs &o) { o.tool_change = true; }},
        {"emc-abort", [](Outputs &o) { o.emc_abort = true; }},
        {"emc-reason", [](Outputs &o) { o.emc_reason = 1; }},
        {"start-change", [](Outputs &o) { o.start_change = true; }},
        {"toolchanger-fault-ack", [](Outputs &o) { o.toolchanger_fault_ack = true; }},
        {"toolchanger-faulted", [](Outputs &o) { o.toolchanger_faulted = true; }},
        {"tool-prep-number", [](Outputs &o) { o.tool_prep_number = 1; }},
        {"tool-prep-pocket", [](Outputs &o) { o.tool_prep_pocket = 1; }},
        {"tool-prep-index", [](Outputs &o) { o.tool_prep_index = 1; }},
        {"tool-number", [](Outputs &o) { o.tool_number = 1; }},
        {"tool-from-pocket", [](Outputs &o) { o.tool_from_pocket = 1; }},
        {"state", [](Outputs &o) { o.state = 1; }}};
    for (const auto &[name, set_one] : OUTPUTS) {
        Outputs outputs;
        set_one(outputs);
        pins.write(outputs);
        for (const auto &[other, unused] : OUTPUTS) {
            EXPECT_EQ(value(other), other == name ? 1 : 0) << name << ' ' << other;
        }
    }
}

TEST_F(IoPins, EveryRowIsAPinAndEveryPinIsARow) {
    std::map<std::string, PinText> wanted;
    for (const PinText &row : rows()) {
        EXPECT_FALSE(row.doc.empty()) << row.name;
        EXPECT_TRUE(wanted.emplace(row.name, row).second) << row.name << " is in the table twice";
    }
    std::size_t found = 0;
    for (const hal::PinInfo &pin : hal().pins().list("*")) {
        if (pin.owner != "iocontrol") {
            continue;
        }
        ++found;
        const auto row = wanted.find(pin.name);
        ASSERT_NE(row, wanted.end()) << pin.name;
        EXPECT_EQ(pin.type, row->second.type) << pin.name;
        EXPECT_EQ(pin.dir, row->second.dir) << pin.name;
        EXPECT_EQ(pin.value.as_number(), row->second.start) << pin.name;
    }
    EXPECT_EQ(found, wanted.size());
}

TEST_F(IoPins, TheManualPageHasEachRowAndNoOther) {
    std::vector<std::string> wanted;
    std::string section;
    for (const PinText &row : rows()) {
        wanted.push_back(testing::page_line(row));
        section += wanted.back() + '\n';
    }
    EXPECT_EQ(testing::page_pins(MW_SOURCE_DIR "/docs/man/iocontrol.1.scd"), wanted)
        << "below '# PINS' the page is to have:\n"
        << section;
}

}  // namespace
}  // namespace mw::io
