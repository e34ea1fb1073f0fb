// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/pci/pci_cards.hh"
#include "drivers/mesa/pci/pci_registers.hh"
#include "hal/core/test/machine.hh"

namespace mw::mesa::test {
namespace {

namespace fs = std::filesystem;

TEST(PciCards, AreKnownByTheirNumbers) {
    const auto name = [](PciIds ids) {
        const PciCard *card = find_pci_card(ids);
        return card == nullptr ? std::string_view("none") : card->hal_name;
    };
    EXPECT_EQ(name({0x10B5, 0x9030, 0x10B5, 0x3131}), "5i20");
    EXPECT_EQ(name({0x10B5, 0x9054, 0x10B5, 0x3315}), "5i23");
    EXPECT_EQ(name({0x10B5, 0x9056, 0x10B5, 0x3428}), "3x20");
    EXPECT_EQ(name({0x2718, 0x5125, 0x1234, 0x5678}), "5i25");
    EXPECT_EQ(name({0x2718, 0x6125, 0, 0}), "6i25");
    EXPECT_EQ(name({0x10B5, 0x9030, 0x10B5, 0x9030}), "none") << "another maker's card with the same bridge";
    EXPECT_EQ(name({0x10B5, 0x9054, 0x10B5, 0x3131}), "none");
    for (const PciCard &card : PCI_CARDS) {
        EXPECT_EQ(find_pci_card(card.ids), &card) << card.hal_name << ": no two cards have the same numbers";
    }
}

TEST(PciRegisters, AreWordsInMemory) {
    std::vector<std::uint32_t> memory(PCI_REGISTER_BYTES / 4);
    bool released = false;
    {
        PciRegisters registers(memory.data(), [&] { released = true; });
        const std::uint32_t written[] = {1, 2};
        EXPECT_TRUE(registers.write(0x1000, written));
        EXPECT_EQ(memory[0x400], 1U);
        EXPECT_EQ(memory[0x401], 2U);
        std::uint32_t read[2] = {};
        memory[0] = 7;
        EXPECT_TRUE(registers.read(0xFFFC, read));
        EXPECT_EQ(read[1], 7U) << "addresses wrap";
    }
    EXPECT_TRUE(released);
}

/// A folder that replaces /sys, with cards whose registers are files.
class PciMachine : public ::testing::Test {
  protected:
    PciMachine() { ::setenv("MILLWRIGHT_SYSFS", root.c_str(), 1); }
    ~PciMachine() override {
        ::unsetenv("MILLWRIGHT_SYSFS");
        fs::remove_all(root);
    }

    struct CardPlan {
        std::string address;
        PciIds ids;
        int region = 0;
        std::string model;  ///< empty: no firmware
    };
    void add_card(const CardPlan &plan) {
        const fs::path card = root / "bus/pci/devices" / plan.address;
        const auto hex = [](std::uint32_t number) {
            char text[16];
            std::snprintf(text, sizeof text, "0x%04x\n", number);
            return std::string(text);
        };
        write(card / "vendor", hex(plan.ids.vendor));
        write(card / "device", hex(plan.ids.device));
        write(card / "subsystem_vendor", hex(plan.ids.subsystem_vendor));
        write(card / "subsystem_device", hex(plan.ids.subsystem_device));
        write(card / "enable", "0");
        std::string resources;
        for (int i = 0; i < 6; ++i) {
            const bool small = i == 0 && plan.region != 0;
            resources += i == plan.region ? "0xf0000000 0xf000ffff 0x200\n"
                         : small          ? "0xe0000000 0xe00000ff 0x200\n"
                                          : "0x0 0x0 0x0\n";
        }
        write(card / "resource", resources);
        std::vector<std::uint32_t> registers(PCI_REGISTER_BYTES / 4);
        if (!plan.model.empty()) {
            const auto model = board::load_model(plan.model);
            const auto words = encode_idrom(model->idrom);
            for (const RegisterValue &one : *words) {
                registers[one.address / 4U] = one.value;
            }
        }
        const std::string name = "resource" + std::to_string(plan.region);
        write(card / name, {reinterpret_cast<const char *>(registers.data()), PCI_REGISTER_BYTES});
        if (plan.region != 0) {
            write(card / "resource0", std::string(256, '\0'));
        }
    }
    std::uint32_t word(const std::string &file, std::size_t address) {
        std::ifstream in(root / "bus/pci/devices" / file, std::ios::binary);
        in.seekg(static_cast<std::streamoff>(address));
        std::uint32_t value = 0;
        in.read(reinterpret_cast<char *>(&value), sizeof value);
        return value;
    }
    static void write(const fs::path &file, const std::string &text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }

    fs::path root = fs::path(::testing::TempDir()) / ("mw_pci_" + std::to_string(::getpid()));
    hal::TestMachine machine;
};

TEST_F(PciMachine, LoadsEachCardWithItsConfiguration) {
    add_card({"0000:02:00.0", {0x2718, 0x5125, 0x2718, 0x5125}, 0, "5i25"});
    add_card({"0000:01:00.0", {0x10B5, 0x9030, 0x10B5, 0x3131}, 5, "5i20"});
    add_card({"0000:03:00.0", {0x8086, 0x1234, 0, 0}, 0, ""});
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    ASSERT_EQ(machine.load("hm2_pci", {"config=num_encoders=2 num_stepgens=1,num_stepgens=3"}), "ok")
        << machine.messages.all();
    EXPECT_EQ(machine.hal().pins().list("hm2_5i20.0.stepgen.*.position-cmd").size(), 1U);
    EXPECT_EQ(machine.hal().pins().list("hm2_5i20.0.encoder.*.count").size(), 2U);
    EXPECT_EQ(machine.hal().pins().list("hm2_5i25.0.stepgen.*.position-cmd").size(), 3U);
    EXPECT_EQ(machine.hal().pins().list("hm2_5i20.0.led.*").size(), 8U);
    EXPECT_EQ(machine.hal().pins().list("hm2_5i25.0.led.*").size(), 2U);
    EXPECT_EQ(machine.hal().params().list("hm2_5i20.0.io_error").size(), 1U);
    for (const unsigned descriptor : {0x28U, 0x2CU, 0x30U, 0x34U}) {
        EXPECT_EQ(word("0000:01:00.0/resource0", descriptor), 2U) << "the bridge is made ready";
    }
    EXPECT_EQ(word("0000:02:00.0/resource0", 0x0C00), 0U) << "no register is written by the load";
}

TEST_F(PciMachine, ACycleReadsAndWritesAndAFaultStopsIt) {
    add_card({"0000:02:00.0", {0x2718, 0x6125, 0, 0}, 0, "6i25"});
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    ASSERT_EQ(machine.load("threads2"), "ok");
    ASSERT_EQ(machine.load("hm2_pci"), "ok") << machine.messages.all();
    ASSERT_TRUE(machine.hal().threads().add_function("hm2_6i25.0.read", "fast"));
    ASSERT_TRUE(machine.hal().threads().add_function("hm2_6i25.0.write", "fast"));
    ASSERT_TRUE(machine.hal().threads().start());
    const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            machine.clock.step();
        }
    };
    run(4);
    EXPECT_EQ(word("0000:02:00.0/resource0", 0x0E00), 0x5A000000U) << "the watchdog is reset";
    EXPECT_EQ(machine.value("hm2_6i25.0.bus-error").as_number(), 0.0);
    // The card is removed: everything reads as ones.
    const fs::path file = root / "bus/pci/devices/0000:02:00.0/resource0";
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out.write(std::string(PCI_REGISTER_BYTES, '\xFF').data(), PCI_REGISTER_BYTES);
    out.close();
    run(20);
    EXPECT_EQ(machine.value("hm2_6i25.0.bus-error-exceeded").as_number(), 1.0);
    EXPECT_EQ(machine.value("hm2_6i25.0.bus-error-total").as_number(), 5.0);
    EXPECT_EQ(machine.value("hm2_6i25.0.io_error").as_number(), 1.0);
    const std::string all = machine.messages.all();
    const auto count = [&](const std::string &text) {
        int found = 0;
        for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) {
            ++found;
        }
        return found;
    };
    EXPECT_EQ(count("the board does not answer: it reads 0xffffffff"), 1) << all;
    EXPECT_EQ(count("all traffic with the board is stopped"), 1) << all;
}

TEST_F(PciMachine, ACardWithoutFirmwareIsRejected) {
    add_card({"0000:02:00.0", {0x2718, 0x5124, 0, 0}, 0, ""});
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    EXPECT_NE(machine.load("hm2_pci"), "ok");
    EXPECT_NE(machine.messages.all().find("The board 5i24 at PCI 0000:02:00.0 has no HostMot2 firmware"),
              std::string::npos)
        << machine.messages.all();
    EXPECT_TRUE(machine.hal().pins().list("hm2_5i24.*").empty());
}

TEST_F(PciMachine, AMachineWithoutACardIsAnError) {
    fs::create_directories(root / "bus/pci/devices");
    ASSERT_EQ(machine.load("hostmot2"), "ok");
    EXPECT_NE(machine.load("hm2_pci"), "ok");
    EXPECT_NE(machine.messages.all().find("there is no Mesa card on PCI"), std::string::npos);
}

}  // namespace
}  // namespace mw::mesa::test
