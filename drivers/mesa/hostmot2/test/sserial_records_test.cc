// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the description of a smart serial card: a 7I76 with its outputs, inputs and spindle.
#include <cstring>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/hostmot2/modules/sserial_records.hh"

namespace mw::mesa::test {
namespace {

class CardMemory {
  public:
    std::map<std::uint16_t, std::uint8_t> bytes;

    std::uint16_t add(const DataRecord &record) {
        const std::uint16_t start = at_;
        put(0xA0);
        put(static_cast<std::uint8_t>(record.bits));
        put(static_cast<std::uint8_t>(record.type));
        put(static_cast<std::uint8_t>(record.direction));
        for (const float value : {record.min, record.max}) {
            std::uint8_t raw[4];
            std::memcpy(raw, &value, sizeof raw);
            for (const std::uint8_t byte : raw) {
                put(byte);
            }
        }
        put16(record.value_address);
        text(record.unit);
        text(record.name);
        return start;
    }
    std::uint16_t add_mode(int index, int kind, const std::string &name) {
        const std::uint16_t start = at_;
        put(0xB0);
        put(static_cast<std::uint8_t>(index));
        put(static_cast<std::uint8_t>(kind));
        put(0);
        text(name);
        return start;
    }
    std::uint16_t add_table(const std::vector<std::uint16_t> &addresses) {
        const std::uint16_t start = at_;
        for (const std::uint16_t address : addresses) {
            put16(address);
        }
        put16(0);
        return start;
    }
    ReadCardByte reader() {
        return [this](std::uint16_t address) -> Result<std::uint8_t> {
            const auto found = bytes.find(address);
            if (found == bytes.end()) {
                return fail("no memory");
            }
            return found->second;
        };
    }

  private:
    void put(std::uint8_t byte) { bytes[at_++] = byte; }
    void put16(std::uint16_t word) {
        put(static_cast<std::uint8_t>(word));
        put(static_cast<std::uint8_t>(word >> 8U));
    }
    void text(const std::string &value) {
        for (const char c : value) {
            put(static_cast<std::uint8_t>(c));
        }
        put(0);
    }
    std::uint16_t at_ = 0x0100;
};

DataRecord field(const char *name, int bits, FieldType type, FieldDirection direction) {
    DataRecord record;
    record.name = name;
    record.unit = "none";
    record.bits = bits;
    record.type = type;
    record.direction = direction;
    record.max = 100.0F;
    record.value_address = 0x20;
    return record;
}

class RecordsOfCard : public ::testing::Test {
  protected:
    RecordsOfCard() {
        process = {field("Output", 16, FieldType::BITS, FieldDirection::OUTPUT),
                   field("SpinOut", 16, FieldType::UNSIGNED, FieldDirection::OUTPUT),
                   field("SpinEna", 1, FieldType::BOOLEAN, FieldDirection::OUTPUT),
                   field("Input", 32, FieldType::BITS, FieldDirection::INPUT),
                   field("Counter", 8, FieldType::ENCODER, FieldDirection::INPUT)};
        std::vector<std::uint16_t> addresses;
        for (DataRecord &record : process) {
            record.address = memory.add(record);
            addresses.push_back(record.address);
        }
        addresses.push_back(memory.add_mode(1, 1, "IO_Spin_AnalogIn"));
        parameter = field("SwRevision", 8, FieldType::UNSIGNED, FieldDirection::INPUT);
        parameter.address = memory.add(parameter);
        ptoc = memory.add_table(addresses);
        addresses.push_back(parameter.address);
        gtoc = memory.add_table(addresses);
    }
    CardMemory memory;
    std::vector<DataRecord> process;
    DataRecord parameter;
    std::uint16_t ptoc = 0, gtoc = 0;
};

TEST_F(RecordsOfCard, AreReadInTheirOrder) {
    const auto records = read_card_records(memory.reader(), ptoc, gtoc);
    ASSERT_TRUE(records.has_value()) << records.error().message;
    EXPECT_EQ(records->process, process);
    ASSERT_EQ(records->parameters.size(), 1U);
    EXPECT_EQ(records->parameters[0], parameter);
    ASSERT_EQ(records->modes.size(), 1U);
    EXPECT_EQ(records->modes[0], (ModeRecord{1, true, "IO_Spin_AnalogIn"}));
}

TEST_F(RecordsOfCard, ArePackedApartForEachDirection) {
    const auto layout = process_layout(process, 96);
    ASSERT_TRUE(layout.has_value());
    EXPECT_EQ(layout->output_bits, 33);
    EXPECT_EQ(layout->input_bits, 40);
    ASSERT_EQ(layout->outputs.size(), 3U);
    EXPECT_EQ(layout->outputs[1].first_bit, 16);
    EXPECT_EQ(layout->outputs[2].first_bit, 32);
    ASSERT_EQ(layout->inputs.size(), 2U);
    EXPECT_EQ(layout->inputs[1].record, 4);
    EXPECT_EQ(layout->inputs[1].first_bit, 32);
    EXPECT_FALSE(process_layout(process, 32).has_value());
}

TEST_F(RecordsOfCard, ThatAreDamagedGiveAnErrorWithTheAddress) {
    memory.bytes[process[1].address] = 0x33;
    const auto records = read_card_records(memory.reader(), ptoc, gtoc);
    ASSERT_FALSE(records.has_value());
    EXPECT_NE(records.error().message.find("it begins with 0x33"), std::string::npos);
}

TEST_F(RecordsOfCard, WithAnyByteDamagedNeverLoopForever) {
    std::mt19937 random(9);
    const auto good = memory.bytes;
    for (int i = 0; i < 2000; ++i) {
        memory.bytes = good;
        auto one = memory.bytes.begin();
        std::advance(one, static_cast<std::ptrdiff_t>(random() % memory.bytes.size()));
        one->second = static_cast<std::uint8_t>(random());
        const auto records = read_card_records(memory.reader(), ptoc, gtoc);
        EXPECT_TRUE(records.has_value() || !records.error().message.empty());
    }
}

TEST(ProcessData, FieldsKeepTheirNeighbours) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 2000; ++i) {
        std::uint32_t words[3] = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()),
                                  static_cast<std::uint32_t>(random())};
        const int bits = static_cast<int>(random() % 64) + 1;
        const int first = static_cast<int>(random() % (96U - static_cast<unsigned>(bits) + 1U));
        const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
        const std::uint64_t value = random() & mask;
        std::uint32_t before[3];
        std::ranges::copy(words, before);
        set_field_bits(words, first, bits, value);
        EXPECT_EQ(field_bits(words, first, bits), value);
        for (int bit = 0; bit < 96; ++bit) {
            if (bit < first || bit >= first + bits) {
                EXPECT_EQ((words[bit / 32] >> (bit % 32)) & 1U, (before[bit / 32] >> (bit % 32)) & 1U);
            }
        }
    }
}

}  // namespace
}  // namespace mw::mesa::test
