// SPDX-License-Identifier: GPL-2.0-or-later
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/modules/field_format.hh"

namespace mw::mesa::test {
namespace {

TEST(FieldFormats, NameFieldsFromTheLowestBitOn) {
    const auto fields = parse_field_format("error%1bposition%24gex%2pload%9mgs", 64);
    ASSERT_TRUE(fields.has_value()) << fields.error().str();
    ASSERT_EQ(fields->size(), 4U);
    EXPECT_EQ((*fields)[1].name, "position");
    EXPECT_EQ((*fields)[1].field.first, 1);
    EXPECT_EQ((*fields)[1].field.bits, 24);
    EXPECT_EQ((*fields)[1].field.type, BitFieldType::ENCODER);
    EXPECT_TRUE((*fields)[1].field.gray);
    EXPECT_EQ((*fields)[3].field.first, 27);
    EXPECT_TRUE((*fields)[3].field.multi_turn);
    EXPECT_EQ((*fields)[3].field.type, BitFieldType::SIGNED);
}

TEST(FieldFormats, AFormatMayEndWithAModifier) {
    const auto fields = parse_field_format("error%1bposition%24g", 64);
    ASSERT_TRUE(fields.has_value());
    EXPECT_EQ((*fields)[1].field.type, BitFieldType::ENCODER);
}

TEST(FieldFormats, AreRefusedWithTheCharacterThatIsWrong) {
    for (const auto &[format, text] : {std::pair{"position", "character 1"},
                                       {"a%b", "character 3"},
                                       {"a%8z", "character 4"},
                                       {"a%0u", "1 to 64"},
                                       {"a%60ub%5u", "more than 64"},
                                       {"a%8", "not a type"},
                                       {"a%8uxyz", "without %"}}) {
        const auto fields = parse_field_format(format, 64);
        ASSERT_FALSE(fields.has_value()) << format;
        EXPECT_NE(fields.error().message.find(text), std::string::npos) << fields.error().message;
    }
}

TEST(FieldFormats, Aa64Has76Bits) {
    const auto fields = parse_field_format("AA64", 76);
    ASSERT_TRUE(fields.has_value());
    EXPECT_EQ(fields->back().name, "crc");
    EXPECT_EQ(fields->back().field.first + fields->back().field.bits, 76);
}

TEST(BitFields, AreTakenAtEveryPosition) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 20'000; ++i) {
        const std::uint64_t low = random();
        const auto high = static_cast<std::uint32_t>(random());
        const std::uint32_t words[] = {static_cast<std::uint32_t>(low),
                                       static_cast<std::uint32_t>(low >> 32U), high};
        BitField field;
        field.bits = 1 + static_cast<int>(random() % 64);
        field.first = static_cast<int>(random() % static_cast<unsigned>(97 - field.bits));
        __extension__ using Wide = unsigned __int128;
        const Wide all = (Wide{high} << 64U) | low;
        const Wide mask = (Wide{1} << static_cast<unsigned>(field.bits)) - 1;
        ASSERT_EQ(bits_of(field, words),
                  static_cast<std::uint64_t>((all >> static_cast<unsigned>(field.first)) & mask));
    }
}

TEST(BitFields, GrayCodeIsConverted) {
    BitField field;
    field.bits = 24;
    field.gray = true;
    for (std::uint32_t n = 0; n < 0xFFFFFF; n += 977) {
        const std::uint32_t words[] = {n ^ (n >> 1U)};
        ASSERT_EQ(bits_of(field, words), n);
    }
}

TEST(AbsoluteEncoders, CountEveryTurn) {
    std::mt19937 random(6);
    std::uniform_int_distribution<int> change(-2047, 2047);
    BitField field;
    field.bits = 12;
    AbsoluteEncoder encoder;
    encoder.scale = 10.0;
    std::int64_t position = 4000 - 4096;
    absolute_encoder_read(encoder, 4000, field);
    EXPECT_EQ(encoder.rawcounts, position);
    for (int i = 0; i < 20'000; ++i) {
        position += change(random);
        absolute_encoder_read(encoder, static_cast<std::uint64_t>(position) & 0xFFFU, field);
        ASSERT_EQ(encoder.rawcounts, position);
        ASSERT_EQ(encoder.position, static_cast<double>(position) / 10.0);
    }
}

TEST(AbsoluteEncoders, AMultiTurnEncoderNeverWraps) {
    BitField field;
    field.bits = 12;
    field.multi_turn = true;
    AbsoluteEncoder encoder;
    absolute_encoder_read(encoder, 10, field);
    absolute_encoder_read(encoder, 4090, field);
    EXPECT_EQ(encoder.rawcounts, -6);
    absolute_encoder_read(encoder, 2047, field);
    EXPECT_EQ(encoder.rawcounts, 2047);
}

TEST(AbsoluteEncoders, IndexIsAtMultiplesOfARevolutionInBothDirections) {
    for (const int step : {37, -37}) {
        BitField field;
        field.bits = 20;
        AbsoluteEncoder encoder;
        encoder.counts_per_rev = 1000;
        std::int64_t position = 5500;
        absolute_encoder_read(encoder, static_cast<std::uint64_t>(position), field);
        encoder.index_enable = true;
        while (encoder.index_enable) {
            position += step;
            absolute_encoder_read(encoder, static_cast<std::uint64_t>(position), field);
        }
        EXPECT_EQ(encoder.zero, step > 0 ? 6000 : 5000);
        EXPECT_EQ(encoder.count, position - encoder.zero);
    }
}

TEST(AbsoluteEncoders, ResetMakesThePositionZero) {
    BitField field;
    field.bits = 16;
    AbsoluteEncoder encoder;
    encoder.reset = true;
    absolute_encoder_read(encoder, 777, field);
    EXPECT_EQ(encoder.count, 0);
    EXPECT_EQ(encoder.rawcounts, 777);
}

}  // namespace
}  // namespace mw::mesa::test
