// SPDX-License-Identifier: GPL-2.0-or-later
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {
namespace {

using Registers = std::map<std::uint16_t, std::uint32_t>;

Idrom small_idrom() {
    Idrom idrom;
    idrom.header = {.type = 3,
                    .modules_offset = 0x40,
                    .pins_offset = 0x1C0,
                    .board_name = "MESA7I76",
                    .fpga_size = 9,
                    .fpga_pins = 144,
                    .io_ports = 2,
                    .io_width = 34,
                    .port_width = 17,
                    .clock_low_hz = 100'000'000,
                    .clock_high_hz = 200'000'000,
                    .instance_strides = {4, 0x40},
                    .register_strides = {0x100, 0x100}};
    idrom.modules = {{Gtag::WATCHDOG, 0, false, 1, 0x0C00, 3, 0, 0, 0},
                     {Gtag::IO_PORT, 0, false, 2, 0x1000, 5, 0, 0, 0x1F},
                     {Gtag::PWM, 1, true, 3, 0x4000, 5, 0, 0, 3},
                     {Gtag::SMART_SERIAL, 0, false, 1, 0x5A00, 6, 0, 1, 0x3C}};
    idrom.pins.resize(34);
    idrom.pins[1] = {0x81, Gtag::PWM, 2, Gtag::IO_PORT};
    return idrom;
}

Registers registers_of(const Idrom &idrom, std::uint16_t offset = 0x0400) {
    Registers registers;
    const auto encoded = encode_idrom(idrom, offset);
    EXPECT_TRUE(encoded.has_value()) << encoded.error().str();
    for (const RegisterValue &one : *encoded) {
        EXPECT_FALSE(registers.contains(one.address)) << "two values for one register";
        registers[one.address] = one.value;
    }
    return registers;
}

RegisterReader reader_of(const Registers &registers) {
    return [&registers](std::uint16_t address, int count) -> Result<std::vector<std::uint32_t>> {
        std::vector<std::uint32_t> words;
        for (int i = 0; i < count; ++i) {
            const auto one = registers.find(static_cast<std::uint16_t>(address + 4 * i));
            words.push_back(one == registers.end() ? 0 : one->second);
        }
        return words;
    };
}

std::string error_of(const Registers &registers, const CardShape &card = {}) {
    const auto idrom = decode_idrom(reader_of(registers), card);
    return idrom.has_value() ? "" : idrom.error().message;
}

std::string error_of(const Idrom &idrom, const CardShape &card = {}) {
    return error_of(registers_of(idrom), card);
}

TEST(Idrom, WhatIsEncodedIsDecoded) {
    for (const std::uint16_t offset : std::initializer_list<std::uint16_t>{0x0400, 0x0800}) {
        const Registers registers = registers_of(small_idrom(), offset);
        const auto idrom = decode_idrom(reader_of(registers), {.ports = 2, .port_width = 17});
        ASSERT_TRUE(idrom.has_value()) << idrom.error().str();
        EXPECT_EQ(*idrom, small_idrom());
    }
}

// The words are written by hand, to detect an error that encoder and decoder share.
TEST(Idrom, TheRegistersHaveTheKnownLayout) {
    const Registers registers = registers_of(small_idrom());
    EXPECT_EQ(registers.at(0x0100), 0x55AACAFEU);
    EXPECT_EQ(registers.at(0x0104), 0x54534F48U) << "HOST";
    EXPECT_EQ(registers.at(0x0108), 0x32544F4DU) << "MOT2";
    EXPECT_EQ(registers.at(0x010C), 0x0400U);
    EXPECT_EQ(registers.at(0x040C), 0x4153454DU) << "MESA";
    EXPECT_EQ(registers.at(0x0440), 0x01010002U);
    EXPECT_EQ(registers.at(0x0444), 0x00030C00U);
    EXPECT_EQ(registers.at(0x0458), 0x03020106U) << "three PWM of version 1 on ClockHigh";
    EXPECT_EQ(registers.at(0x0468), 0x10065A00U) << "instance stride 1";
    EXPECT_EQ(registers.at(0x0470), 0U) << "the end of the list";
    EXPECT_EQ(registers.at(0x05C0), 0x03000000U);
    EXPECT_EQ(registers.at(0x05C4), 0x03020681U);
}

// The texts that LinuxCNC 2.9 prints for the patterns 0 to 14 of its hm2_test (from running it).
TEST(Idrom, TheErrorsHaveTheTextsThatUsersKnow) {
    const CardShape card{.ports = 1, .port_width = 24};
    Registers registers = registers_of(small_idrom());
    registers[0x0100] = 0;
    EXPECT_EQ(error_of(registers), "invalid cookie, got 0x00000000, expected 0x55AACAFE");
    registers = registers_of(small_idrom());
    registers[0x0104] = 0x01020304;
    EXPECT_EQ(error_of(registers),
              "invalid config name, got '" + std::string(8, '?') + "', expected 'HOSTMOT2'");
    Idrom idrom = small_idrom();
    idrom.header.type = 0;
    EXPECT_EQ(error_of(idrom), "invalid IDROM type 0, expected 2 or 3, aborting load");
    idrom.header.type = 0x1234;
    EXPECT_EQ(error_of(idrom), "invalid IDROM type 4660, expected 2 or 3, aborting load");
    idrom.header.type = 2;
    idrom.header.port_width = 0;
    EXPECT_EQ(error_of(idrom, card),
              "invalid IDROM PortWidth 0, this board has 24 pins per connector, aborting load");
    idrom.header.port_width = 29;
    EXPECT_EQ(error_of(idrom, card),
              "invalid IDROM PortWidth 29, this board has 24 pins per connector, aborting load");
    idrom.header.port_width = 24;
    for (const std::uint32_t ports : {0U, 2U}) {
        idrom.header.io_ports = ports;
        EXPECT_EQ(error_of(idrom, card), "IDROM IOPorts is " + std::to_string(ports) +
                                             " but llio num_ioport_connectors is 1, driver and firmware are "
                                             "inconsistent, aborting driver load");
    }
    idrom.header.io_ports = 1;
    idrom.header.io_width = 99;
    EXPECT_EQ(error_of(idrom, card),
              "IDROM IOWidth is 99, but IDROM IOPorts is 1 and IDROM PortWidth is 24 (inconsistent "
              "firmware), aborting driver load");
    idrom.header.io_width = 24;
    idrom.header.clock_low_hz = 12345;
    EXPECT_EQ(error_of(idrom, card), "IDROM ClockLow is 12345, that's too low, aborting driver load");
    idrom.header.clock_low_hz = 2'000'000;
    idrom.header.clock_high_hz = 0;
    EXPECT_EQ(error_of(idrom, card), "IDROM ClockHigh is 0, that's too low, aborting driver load");
}

TEST(Idrom, PinsWithoutAnIoPortAreRejected) {
    Idrom idrom = small_idrom();
    idrom.pins[0].primary = Gtag::NONE;
    EXPECT_EQ(error_of(idrom), "pin 0 primary tag is 0 (end-of-list sentinel), expected 34 pins!");
    idrom = small_idrom();
    idrom.modules[1].instances = 1;
    EXPECT_TRUE(error_of(idrom).starts_with("hm2_set_pin_source: invalid pin number 17\n"
                                            "hm2_set_pin_direction_immediate: invalid pin number 17\n"
                                            "hm2_set_pin_source: invalid pin number 18\n"));
    idrom.modules.clear();
    EXPECT_TRUE(error_of(idrom).starts_with("hm2_set_pin_source: invalid pin number 0\n"));
    EXPECT_TRUE(error_of(idrom).ends_with("hm2_set_pin_direction_immediate: invalid pin number 33"));
}

TEST(Idrom, LimitsAreChecked) {
    Idrom idrom = small_idrom();
    idrom.header.port_width = 18;
    EXPECT_EQ(error_of(idrom),
              "invalid IDROM PortWidth 18, expected one of 17, 19, 21, 24, 27, 29, 30, 32, aborting load");
    idrom = small_idrom();
    idrom.header.io_ports = 9;
    idrom.header.io_width = 153;
    EXPECT_EQ(error_of(idrom), "IDROM IOWidth is 153, at most 144 pins are possible, aborting driver load");
    idrom = small_idrom();
    idrom.header.pins_offset = 0x400;
    idrom.modules.resize(48, idrom.modules[0]);
    EXPECT_EQ(error_of(idrom), "");
    idrom.modules.resize(49, idrom.modules[0]);
    EXPECT_EQ(error_of(idrom), "IDROM lists more than 48 modules, aborting driver load");
}

TEST(Idrom, AModuleOutsideOfTheRegistersIsRejected) {
    Idrom idrom = small_idrom();
    idrom.modules[2].base_address = 0xFF00;
    EXPECT_EQ(error_of(idrom), "module descriptor 2 (gtag 6 at 0xFF00) has its last register at 0x10308, "
                               "outside of the register space, aborting driver load");
    Registers registers = registers_of(small_idrom());
    registers[0x0440] = 0x01030002;
    EXPECT_EQ(error_of(registers), "module descriptor 0 (gtag 2 at 0x0C00) has clock 3, expected 1 "
                                   "(ClockLow) or 2 (ClockHigh), aborting driver load");
    registers = registers_of(small_idrom());
    registers[0x0444] = 0x20030C00;
    EXPECT_EQ(error_of(registers), "module descriptor 0 (gtag 2 at 0x0C00) uses register stride 0 and "
                                   "instance stride 2, expected 0 or 1, aborting driver load");
    registers = registers_of(small_idrom());
    registers[0x010C] = 0xFFFFFFF0;
    EXPECT_EQ(error_of(registers), "IDROM refers to 16 registers at 0x10000, outside of the register space");
}

TEST(Idrom, AnErrorOfTheBusIsPassedOn) {
    const auto idrom = decode_idrom(
        [](std::uint16_t, int) -> Result<std::vector<std::uint32_t>> { return fail("no answer"); });
    ASSERT_FALSE(idrom.has_value());
    EXPECT_EQ(idrom.error().message, "no answer");
}

TEST(Idrom, EncodingChecksThatThePartsFit) {
    Idrom idrom = small_idrom();
    idrom.header.pins_offset = 0x60;
    EXPECT_EQ(encode_idrom(idrom).error().message,
              "The pins at offset 0x60 overlap 4 modules at offset 0x40.");
    idrom.header.modules_offset = 0x20;
    EXPECT_EQ(encode_idrom(idrom).error().message,
              "The modules at offset 0x20 overlap the header of the IDROM.");
    idrom = small_idrom();
    EXPECT_FALSE(encode_idrom(idrom, 0xFF00).has_value());
}

// Random changes of single registers: a description is rejected, or it can be encoded.
TEST(Idrom, AChangedDescriptionIsRejectedOrConsistent) {
    std::mt19937 random(39);
    const Registers good = registers_of(small_idrom());
    int rejected = 0;
    for (int i = 0; i < 20'000; ++i) {
        Registers registers = good;
        for (auto changes = 1 + random() % 3; changes > 0; --changes) {
            auto one = registers.begin();
            std::advance(one, random() % registers.size());
            one->second = random() % 2 == 0 ? static_cast<std::uint32_t>(random())
                                            : one->second ^ (1U << (random() % 32));
        }
        const auto idrom = decode_idrom(reader_of(registers));
        if (!idrom.has_value()) {
            ++rejected;
            EXPECT_FALSE(idrom.error().message.empty());
            continue;
        }
        EXPECT_EQ(idrom->pins.size(), idrom->header.io_ports * idrom->header.port_width);
        EXPECT_LE(idrom->modules.size(), static_cast<std::size_t>(MAX_MODULES));
        EXPECT_GE(idrom->header.clock_low_hz, 1'000'000U);
    }
    EXPECT_GT(rejected, 1000);
    EXPECT_LT(rejected, 19'000);
}

}  // namespace
}  // namespace mw::mesa
