// SPDX-License-Identifier: GPL-2.0-or-later
// Values of smart serial cards. The expected bits and numbers are those that LinuxCNC 2.9 exchanged with a
// simulated card for the same pins.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/modules/sserial_values.hh"

namespace mw::mesa::test {
namespace {

DataRecord record(const char *name, int bits, FieldType type, FieldDirection direction, float min = 0,
                  float max = 0) {
    DataRecord one;
    one.name = name;
    one.bits = bits;
    one.type = type;
    one.direction = direction;
    one.min = min;
    one.max = max;
    return one;
}

SserialCardValues card_of(const std::vector<DataRecord> &process) {
    const auto layout = process_layout(process, 96);
    EXPECT_TRUE(layout.has_value());
    return make_sserial_card(process, *layout);
}

SserialNumber number(double value, double scale_max, double min, double max) {
    return {value, scale_max, max, min};
}

struct NumberCase {
    SserialNumber number;
    int bits;
    std::uint64_t expected;
};

TEST(SserialNumbers, UnsignedOutputsAreThoseOfLinuxCnc) {
    const NumberCase cases[] = {
        {number(0.5, 1, 0, 1), 8, 0x7F},
        {number(2, 1, 0, 1), 8, 0xFF},
        {number(-1, 1, 0, 1), 8, 0},
        {number(0.25, 1, 0, 1), 8, 0x3F},
        {number(0.5, 2, 0, 1), 8, 0x3F},
        {number(5, 50, 10, 50), 16, 0x3333},
        {number(30, 50, 10, 50), 16, 0x9999},
        {number(49.99, 50, 10, 50), 16, 0xFFF1},
        {number(30, 100, 0, 100), 32, 0x4CCCCCCC},
        {number(100, 100, 0, 100), 32, 0xFFFFFFFF},
        {number(1e-7, 100, 0, 100), 32, 4},
        {number(50, 100, 0, 100), 16, 0x7FFF},
    };
    for (const NumberCase &one : cases) {
        EXPECT_EQ(unsigned_bits(one.number, one.bits), one.expected)
            << one.number.value << " of " << one.number.scale_max;
    }
}

TEST(SserialNumbers, SignedOutputsAreThoseOfLinuxCnc) {
    const NumberCase cases[] = {
        {number(5, 10, -10, 10), 12, 0x3FF},     {number(-10, 10, -10, 10), 12, 0x800},
        {number(10, 10, -10, 10), 12, 0x7FF},    {number(0.01, 10, -10, 10), 12, 0x002},
        {number(-7, 10, -5, 10), 16, 0xC000},    {number(10, 10, -5, 10), 16, 0x7FFF},
        {number(-2.5, 10, -5, 10), 16, 0xE000},  {number(0.001, 10, -5, 10), 16, 0x0003},
        {number(3, -10, -100, 100), 16, 0xD999}, {number(5, 20, -10, 10), 12, 0x1FF},
    };
    for (const NumberCase &one : cases) {
        EXPECT_EQ(signed_bits(one.number, one.bits), one.expected)
            << one.number.value << " of " << one.number.scale_max;
    }
}

TEST(SserialNumbers, InputsAreThoseOfLinuxCnc) {
    EXPECT_NEAR(unsigned_number(0xABC, 12, 10), 6.710623, 1e-6);
    EXPECT_NEAR(unsigned_number(0xABC, 12, 100), 67.10623, 1e-5);
    EXPECT_NEAR(unsigned_number(0x80, 8, 1), 0.5019608, 1e-7);
    EXPECT_NEAR(signed_number(0x8001, 16, 10), -9.999695, 1e-6);
    EXPECT_NEAR(signed_number(0x8001, 16, -20), 19.99939, 1e-5);
    EXPECT_NEAR(signed_number(0x85, 8, 1), -0.9609375, 1e-7);
    // LinuxCNC divides by 0 here.
    EXPECT_NEAR(unsigned_number(0x80000000, 32, 1), 0.5, 1e-9);
}

TEST(SserialNumbers, WithoutAValidScaleOrValueTheOutputIsOff) {
    EXPECT_EQ(unsigned_bits(number(5, 0, 0, 10), 16), 0U);
    EXPECT_EQ(signed_bits(number(std::nan(""), 10, -10, 10), 16), 0U);
    EXPECT_EQ(signed_bits(number(1e300, 1e-300, -1e300, 1e300), 16), 0U) << "infinite";
    EXPECT_EQ(signed_bits(number(50, 10, -100, 100), 16), 0x7FFFU) << "limited to the range of the card";
}

TEST(SserialFields, HaveTheirDefaultsFromTheCard) {
    const auto card = card_of({record("Volt", 12, FieldType::UNSIGNED, FieldDirection::INPUT, 0, 36.3F),
                               record("Plain", 8, FieldType::SIGNED, FieldDirection::INPUT),
                               record("Out", 16, FieldType::SIGNED, FieldDirection::OUTPUT, -5, 10)});
    EXPECT_FLOAT_EQ(static_cast<float>(card.numbers[0].scale_max), 36.3F);
    EXPECT_EQ(card.numbers[1].scale_max, 1.0);
    EXPECT_EQ(card.numbers[2].min_limit, -5.0);
    EXPECT_EQ(card.numbers[2].max_limit, 10.0);
    EXPECT_EQ(card.fields[0].name, "volt");
}

TEST(SserialFields, OfDamagedDescriptionsNeverGiveInvalidNumbers) {
    std::mt19937 random(3);
    const FieldType types[] = {FieldType::BITS,         FieldType::UNSIGNED,    FieldType::SIGNED,
                               FieldType::FLOAT,        FieldType::BOOLEAN,     FieldType::ENCODER,
                               FieldType::ENCODER_HIGH, FieldType::ENCODER_LOW, FieldType::STREAM,
                               FieldType::PAD,          FieldType::NV_FLOAT};
    const FieldDirection directions[] = {FieldDirection::INPUT, FieldDirection::OUTPUT, FieldDirection::BOTH};
    for (int i = 0; i < 3000; ++i) {
        std::vector<DataRecord> process;
        for (int n = 0; n < 3; ++n) {
            process.push_back(record("a", static_cast<int>(random() % 65), types[random() % std::size(types)],
                                     directions[random() % 3], static_cast<float>(random()),
                                     random() % 4 == 0 ? 0.0F : static_cast<float>(random())));
        }
        auto layout = process_layout(process, 224);
        ASSERT_TRUE(layout.has_value());
        auto card = make_sserial_card(process, *layout);
        for (SserialNumber &one : card.numbers) {
            one.scale_max = random() % 3 == 0 ? std::nan("") : one.scale_max;
        }
        std::uint32_t words[7];
        for (int cycle = 0; cycle < 5; ++cycle) {
            std::ranges::generate(words, [&] { return static_cast<std::uint32_t>(random()); });
            sserial_read(card, words);
            for (const SserialNumber &one : card.numbers) {
                ASSERT_TRUE(std::isfinite(one.value))
                    << one.value << " of " << one.scale_max << " max " << one.max_limit;
            }
            sserial_write(card, words);
        }
    }
}

TEST(SserialFields, OutputsArePackedAndInverted) {
    auto card = card_of({record("Output", 16, FieldType::BITS, FieldDirection::OUTPUT),
                         record("SpinOut", 16, FieldType::UNSIGNED, FieldDirection::OUTPUT, 0, 100),
                         record("SpinEna", 1, FieldType::BOOLEAN, FieldDirection::OUTPUT),
                         record("Wide", 3, FieldType::BOOLEAN, FieldDirection::OUTPUT)});
    card.bits[3].value = true;
    card.bits[5].invert = true;
    card.numbers[0].value = 50;
    card.bits[17].value = true;
    std::uint32_t words[3] = {};
    sserial_write(card, words);
    EXPECT_EQ(words[0], 0x7FFF0028U);
    EXPECT_EQ(words[1], 0b1110U) << "a boolean fills all its bits";
}

TEST(SserialFields, InputsHaveTheirInverse) {
    auto card = card_of({record("Input", 32, FieldType::BITS, FieldDirection::INPUT),
                         record("Wide", 3, FieldType::BOOLEAN, FieldDirection::INPUT),
                         record("Raw", 8, FieldType::STREAM, FieldDirection::INPUT),
                         record("", 3, FieldType::PAD, FieldDirection::INPUT),
                         record("Last", 1, FieldType::BOOLEAN, FieldDirection::INPUT)});
    const std::uint32_t words[3] = {0x80000001, 0b1'000'0010'0101'010U, 0};
    sserial_read(card, words);
    EXPECT_TRUE(card.bits[0].value && card.bits[31].value && !card.bits[1].value);
    EXPECT_TRUE(card.bits[1].inverse && !card.bits[0].inverse);
    EXPECT_TRUE(card.bits[32].value);
    EXPECT_EQ(card.streams[0].value, 0b0010'0101U);
    EXPECT_TRUE(card.bits[33].value);
}

TEST(SserialFields, HeldOutputsAreOffUntilTheirPinWasOff) {
    auto card = card_of({record("Output", 2, FieldType::BITS, FieldDirection::OUTPUT),
                         record("Speed", 8, FieldType::UNSIGNED, FieldDirection::OUTPUT, 0, 1)});
    card.bits[0].value = card.bits[1].value = true;
    card.numbers[0].value = 1;
    hold_outputs(card);
    const auto word = [&] {
        std::uint32_t words[3] = {};
        sserial_write(card, words);
        return words[0];
    };
    EXPECT_EQ(word(), 0U);
    card.bits[0].value = false;
    card.numbers[0].value = 0.5;
    EXPECT_EQ(word(), 0U) << "another speed is no switch-on";
    card.bits[0].value = true;
    EXPECT_EQ(word(), 1U);
    card.numbers[0].value = 0;
    EXPECT_EQ(word(), 1U);
    card.numbers[0].value = 1;
    EXPECT_EQ(word(), 1U | (0xFFU << 2U));
    hold_outputs(card);
    release_outputs(card);
    EXPECT_EQ(word(), 3U | (0xFFU << 2U));
}

TEST(SserialCounters, CountOnOverTheirBits) {
    SserialCounter counter;
    counter.scale = 10;
    for (int i = 1; i <= 100; ++i) {
        count_encoder(counter, static_cast<std::uint64_t>(7 * i) & 0xFFU, 8);
    }
    EXPECT_EQ(counter.rawcounts, 700);
    EXPECT_EQ(counter.count, 700);
    EXPECT_DOUBLE_EQ(counter.position, 70.0);
    for (int i = 1; i <= 200; ++i) {
        count_encoder(counter, static_cast<std::uint64_t>(700 - 9 * i) & 0xFFU, 8);
    }
    EXPECT_EQ(counter.rawcounts, 700 - 1800);
}

TEST(SserialCounters, ResetKeepsTheCountAtZero) {
    SserialCounter counter;
    count_encoder(counter, 50, 8);
    counter.reset = true;
    count_encoder(counter, 60, 8);
    EXPECT_EQ(counter.count, 0);
    EXPECT_EQ(counter.rawcounts, 60);
    counter.reset = false;
    count_encoder(counter, 64, 8);
    EXPECT_EQ(counter.count, 4);
}

TEST(SserialCounters, TheIndexIsEachMultipleOfTheCountsOfARevolution) {
    SserialCounter counter;
    counter.counts_per_rev = 1000;
    const auto move_to = [&](std::int64_t count) {
        count_encoder(counter, static_cast<std::uint64_t>(count) & 0xFFFFU, 16);
    };
    move_to(-11'916);
    counter.index_enable = true;
    move_to(-11'950);
    EXPECT_TRUE(counter.index_enable);
    move_to(-12'086);
    EXPECT_FALSE(counter.index_enable);
    EXPECT_EQ(counter.count, -86) << "as LinuxCNC counts here";
    move_to(-3);
    counter.index_enable = true;
    move_to(0);
    EXPECT_FALSE(counter.index_enable);
    EXPECT_EQ(counter.count, 0);
    counter.index_enable = true;
    move_to(0);
    EXPECT_TRUE(counter.index_enable) << "without a move there is no index";
    counter.counts_per_rev = 0;
    move_to(5000);
    EXPECT_TRUE(counter.index_enable);
}

TEST(SserialCounters, TwoHalvesAreOneEncoder) {
    auto card = card_of({record("Enc", 8, FieldType::ENCODER_HIGH, FieldDirection::INPUT),
                         record("Enc", 8, FieldType::ENCODER_LOW, FieldDirection::INPUT),
                         record("Alone", 8, FieldType::ENCODER_HIGH, FieldDirection::INPUT)});
    const std::uint32_t words[3] = {0x00'05'34'12, 0, 0};
    sserial_read(card, words);
    EXPECT_EQ(card.counters[0].rawcounts, 0x1234);
    EXPECT_EQ(card.counters.back().rawcounts, 5);
    EXPECT_EQ(card.fields[1].pins, FieldPins::NONE);
}

}  // namespace
}  // namespace mw::mesa::test
