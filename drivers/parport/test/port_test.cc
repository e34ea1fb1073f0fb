// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the levels of the connector's pins with the table of the registers, and the writes.
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/parport/port.hh"

namespace mw::parport {
namespace {

/// Records writes; the levels of the connector are derived from them by the electrical rules of the port.
struct Recorder final : PortAccess {
    std::vector<std::pair<Register, std::uint8_t>> writes;
    std::map<Register, std::uint8_t> inputs;
    int reads = 0;

    std::uint8_t read(Register reg) noexcept override {
        ++reads;
        return inputs[reg];
    }
    void write(Register reg, std::uint8_t value) noexcept override { writes.emplace_back(reg, value); }
    void select(Mode) noexcept override {}
    void release() noexcept override {}
    std::uint8_t last(Register reg) const {
        std::uint8_t value = 0;
        for (const auto &[one, byte] : writes) {
            value = one == reg ? byte : value;
        }
        return value;
    }
};

/// Index of a pin among the lines.
std::size_t index_of(const Lines &lines, int pin) {
    for (std::size_t i = 0; i < lines.count; ++i) {
        if (lines.line[i].pin == pin) {
            return i;
        }
    }
    ADD_FAILURE() << "no pin " << pin;
    return 0;
}

std::vector<int> pins_of(const Lines &lines) {
    std::vector<int> pins;
    for (const Line &line : lines.all()) {
        pins.push_back(line.pin);
    }
    std::ranges::sort(pins);
    return pins;
}

TEST(Parport, HasThePinsOfItsType) {
    const std::vector<int> all_outputs{1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17}, status{10, 11, 12, 13, 15};
    EXPECT_EQ(pins_of(outputs_of(Mode::OUT)), all_outputs);
    EXPECT_EQ(pins_of(outputs_of(Mode::EPP)), all_outputs);
    EXPECT_EQ(pins_of(outputs_of(Mode::IN)), (std::vector<int>{1, 14, 16, 17}));
    EXPECT_EQ(pins_of(outputs_of(Mode::CONTROL_IN)), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(pins_of(inputs_of(Mode::OUT)), status);
    EXPECT_EQ(pins_of(inputs_of(Mode::IN)), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15}));
    EXPECT_EQ(pins_of(inputs_of(Mode::CONTROL_IN)), (std::vector<int>{1, 10, 11, 12, 13, 14, 15, 16, 17}));
}

// Each output alone: the bits that raise it, from the table of the port.
TEST(Parport, EachOutputSetsItsBit) {
    const std::map<int, std::pair<std::uint8_t, std::uint8_t>> expected{
        // All pins low is control 0x0B: three of its lines are inverted.
        {2, {0x01, 0x0B}}, {3, {0x02, 0x0B}},  {4, {0x04, 0x0B}},  {5, {0x08, 0x0B}},
        {6, {0x10, 0x0B}}, {7, {0x20, 0x0B}},  {8, {0x40, 0x0B}},  {9, {0x80, 0x0B}},
        {1, {0x00, 0x0A}}, {14, {0x00, 0x09}}, {16, {0x00, 0x0F}}, {17, {0x00, 0x03}}};
    for (const auto &[pin, bytes] : expected) {
        Recorder recorder;
        Port port;
        port.begin(recorder, Mode::OUT, 0);
        EXPECT_EQ(recorder.last(Register::DATA), 0x00);
        EXPECT_EQ(recorder.last(Register::CONTROL), 0x0B);
        port.write(Levels{1} << index_of(port.outputs(), pin));
        EXPECT_EQ(recorder.last(Register::DATA), bytes.first) << "pin " << pin;
        EXPECT_EQ(recorder.last(Register::CONTROL), bytes.second) << "pin " << pin;
    }
}

TEST(Parport, EachInputIsReadFromItsBit) {
    const std::map<int, std::pair<Register, std::uint8_t>> expected{
        {10, {Register::STATUS, 0x40}}, {12, {Register::STATUS, 0x20}}, {13, {Register::STATUS, 0x10}},
        {15, {Register::STATUS, 0x08}}, {2, {Register::DATA, 0x01}},    {9, {Register::DATA, 0x80}}};
    for (const auto &[pin, place] : expected) {
        Recorder recorder;
        recorder.inputs[Register::STATUS] = 0x80;  // pin 11 low
        Port port;
        port.begin(recorder, Mode::IN, 0);
        EXPECT_EQ(port.read(), 0U);
        recorder.inputs[place.first] |= place.second;
        EXPECT_EQ(port.read(), Levels{1} << index_of(port.inputs(), pin)) << "pin " << pin;
    }
    Recorder recorder;
    Port port;
    port.begin(recorder, Mode::OUT, 0);
    EXPECT_EQ(port.read(), Levels{1} << index_of(port.inputs(), 11)) << "bit 7 is 0: pin 11 is high";
    EXPECT_EQ(recorder.reads, 1) << "only the status register has inputs";
}

TEST(Parport, ControlPinsAreInputsOfTypeX) {
    Recorder recorder;
    Port port;
    port.begin(recorder, Mode::CONTROL_IN, 0);
    EXPECT_EQ(recorder.last(Register::CONTROL), 0x04)
        << "all control pins are high, so that they can be pulled low";
    recorder.inputs = {{Register::STATUS, 0x80}, {Register::CONTROL, 0x0B}};
    EXPECT_EQ(port.read(), 0U);
    recorder.inputs[Register::CONTROL] = 0x0A;
    EXPECT_EQ(port.read(), Levels{1} << index_of(port.inputs(), 1));
}

TEST(Parport, DataPinsAreInputsOfTypeIn) {
    Recorder recorder;
    Port port;
    port.begin(recorder, Mode::IN, 0);
    EXPECT_EQ(recorder.last(Register::CONTROL), 0x2B);
    port.write(Levels{1} << index_of(port.outputs(), 16));
    EXPECT_EQ(recorder.last(Register::CONTROL), 0x2F) << "the direction stays";
}

TEST(Parport, WritesOnlyWhatChanges) {
    Recorder recorder;
    Port port;
    port.begin(recorder, Mode::OUT, 0);
    recorder.writes.clear();
    port.write(0);
    EXPECT_TRUE(recorder.writes.empty());
    port.write(1);
    EXPECT_EQ(recorder.writes, (std::vector<std::pair<Register, std::uint8_t>>{{Register::DATA, 1}}));
}

TEST(Parport, AResetMakesOneStepInEachPeriod) {
    Recorder recorder;
    Port port;
    port.begin(recorder, Mode::OUT, 0);
    recorder.writes.clear();
    const Levels step = Levels{1} << index_of(port.outputs(), 2),
                 direction = Levels{1} << index_of(port.outputs(), 3);
    for (int period = 0; period < 3; ++period) {
        port.write(step | direction);
        port.reset(step, 0);
    }
    EXPECT_EQ(recorder.writes, (std::vector<std::pair<Register, std::uint8_t>>{{Register::DATA, 0x03},
                                                                               {Register::DATA, 0x02},
                                                                               {Register::DATA, 0x03},
                                                                               {Register::DATA, 0x02},
                                                                               {Register::DATA, 0x03},
                                                                               {Register::DATA, 0x02}}));
    recorder.writes.clear();
    port.write(direction);
    port.reset(step, step);  // an inverted step pin is high when inactive
    EXPECT_EQ(recorder.last(Register::DATA), 0x03);
}

}  // namespace
}  // namespace mw::parport
