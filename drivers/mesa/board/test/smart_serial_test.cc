// SPDX-License-Identifier: GPL-2.0-or-later
#include <bit>

#include <gtest/gtest.h>

#include "drivers/mesa/board/test/host.hh"

namespace mw::mesa::board {
namespace {

/// A host that runs commands of the smart serial processor.
struct SerialHost : Host {
    explicit SerialHost(const std::string &remotes = "remote 0 card=7i76\nremote 1 card=7i84\n")
        : Host("7i76e", remotes) {}

    /// Runs a command to its end. @return the mask of the channels that failed
    std::uint32_t run(std::uint32_t command) {
        write(0x5A00, command);
        int cycles = 0;
        while (read(0x5A00) != 0 && cycles++ < 10'000) {
            time_ns += 10 * US;
        }
        EXPECT_LT(cycles, 10'000);
        return read(0x5B00) & 0xFFU;
    }
    std::uint32_t local(std::uint32_t address) {
        run(0x2000 | address);
        return read(0x5B00);
    }
    std::uint32_t remote_byte(unsigned channel, std::uint32_t address) {
        const auto offset = static_cast<std::uint16_t>(4 * channel);
        write(static_cast<std::uint16_t>(0x5C00 + offset), 0x4C000000 | address);
        EXPECT_EQ(run(0x1000U | (1U << channel)), 0U);
        EXPECT_EQ(read(static_cast<std::uint16_t>(0x5C00 + offset)) & 0xFF00U, 0U);
        return read(static_cast<std::uint16_t>(0x5D00 + offset));
    }
    std::uint32_t remote_word(unsigned channel, std::uint32_t address) {
        return remote_byte(channel, address) | (remote_byte(channel, address + 1) << 8U);
    }
    std::string remote_text(unsigned channel, std::uint32_t address) {
        std::string text;
        while (const auto one = remote_byte(channel, address++)) {
            text += static_cast<char>(one);
        }
        return text;
    }
    /// The names of the process data of a channel in a mode, from its own description.
    std::vector<std::string> names(unsigned channel, std::uint32_t mode) {
        run(0x800U | (1U << channel));
        write(static_cast<std::uint16_t>(0x5C00 + 4 * channel), mode << 24U);
        EXPECT_EQ(run(0xF00U | (1U << channel)), 0U);
        const std::uint32_t lists = read(static_cast<std::uint16_t>(0x5F00 + 4 * channel));
        std::vector<std::string> found;
        for (std::uint32_t at = lists & 0xFFFFU; const auto record = remote_word(channel, at); at += 2) {
            EXPECT_EQ(remote_byte(channel, record), 0xA0U);
            const std::string unit = remote_text(channel, record + 14);
            found.push_back(remote_text(channel, record + 15 + static_cast<std::uint32_t>(unit.size())));
        }
        return found;
    }
    void start(std::uint32_t mode) {
        run(0x8FF);
        write(0x5C00, mode << 24U);
        EXPECT_EQ(run(0x901), 0U);
    }
    Remote &remote(unsigned channel) { return *board.firmware().smart_serial()->remote(0, channel); }
};

TEST(BoardSmartSerial, TheProcessorReportsItself) {
    SerialHost host;
    host.run(0x4000);
    EXPECT_GE(host.local(3), 43U) << "the minor version";
    EXPECT_EQ(host.local(7), 2U) << "channels with a receive pin";
    const std::uint32_t channel0 = host.local(4);
    std::uint32_t baud = 0;
    for (unsigned i = 0; i < 4; ++i) {
        baud |= host.local(channel0 + 42 + i) << (8 * i);
    }
    EXPECT_EQ(baud, 2'500'000U);
}

TEST(BoardSmartSerial, SetUpFindsTheRemotesAndTheirDescriptions) {
    SerialHost host;
    host.run(0x4000);
    EXPECT_EQ(host.run(0xFFF), 0xFCU) << "two channels answer";
    EXPECT_EQ(host.read(0x5E00), 0x36374937U) << "7I76";
    EXPECT_EQ(host.read(0x5E04), 0x34384937U) << "7I84";
    EXPECT_NE(host.read(0x5D00), host.read(0x5D04)) << "each has its serial number";
    using Names = std::vector<std::string>;
    EXPECT_EQ(host.names(0, 0), (Names{"Output", "Input", "SpinOut", "SpinEna", "SpinDir"}));
    EXPECT_EQ(host.names(0, 1).size(), 9U);
    EXPECT_EQ(host.names(0, 2).back(), "Enc1");
    EXPECT_EQ(host.names(1, 0), (Names{"Output", "Input"}));
}

TEST(BoardSmartSerial, ARecordHasItsBitsTypeDirectionAndRange) {
    SerialHost host;
    host.run(0x4000);
    host.run(0xF01);
    const auto record = host.remote_word(0, (host.read(0x5F00) & 0xFFFFU) + 4);
    EXPECT_EQ(host.remote_byte(0, record + 1), 16U);
    EXPECT_EQ(host.remote_byte(0, record + 2), 2U) << "unsigned";
    EXPECT_EQ(host.remote_byte(0, record + 3), 0x80U) << "output";
    const auto max = host.remote_word(0, record + 8) | (host.remote_word(0, record + 10) << 16U);
    EXPECT_EQ(std::bit_cast<float>(max), 100.0F);
}

TEST(BoardSmartSerial, ProcessDataAreExchangedWithEachDoIt) {
    SerialHost host;
    host.run(0x4000);
    host.start(1);
    host.remote(0).set_value("Input", 0x80000001);
    host.remote(0).set_value("AnalogIn1", 0xABC);
    host.write(0x5D00, 0x7FFF0008);
    host.write(0x5E00, 0x1);
    host.write(0x5A00, 0x1001);
    EXPECT_EQ(host.read(0x5A00), 0x1001U) << "the exchange takes its time";
    host.time_ns += 200 * US;
    EXPECT_EQ(host.read(0x5A00), 0U);
    EXPECT_EQ(host.read(0x5B00), 0U);
    EXPECT_EQ(host.remote(0).value("Output"), 8U);
    EXPECT_EQ(host.remote(0).value("SpinOut"), 0x7FFFU);
    EXPECT_EQ(host.remote(0).value("SpinEna"), 1U);
    EXPECT_EQ(host.remote(0).value("SpinDir"), 0U);
    EXPECT_EQ(host.read(0x5D00), 0x80000001U);
    EXPECT_EQ(host.read(0x5E00), 0xABCU << 12U);
}

TEST(BoardSmartSerial, SwitchesAndFieldsSetTheInputsOfACard) {
    SerialHost host(
        "motor x stepgen=0 steps_per_rev=200 start_rev=2.5\nremote 0 card=7i76\n"
        "switch 3 remote=0 motor=x above_rev=2\nswitch 4 remote=0 motor=x above_rev=2 closed=low\n"
        "field 0 name=AnalogIn1 value=0x123\nfield 0 name=Enc0 motor=x counts_per_rev=100\n");
    host.run(0x4000);
    host.start(2);
    EXPECT_EQ(host.run(0x1001), 0U);
    EXPECT_EQ(host.read(0x5D00), 8U);
    EXPECT_EQ(host.read(0x5E00), 0x123U << 12U);
    EXPECT_EQ(host.read(0x5F00) >> 16U, 250U) << "the encoder counts 2.5 revolutions";
}

TEST(BoardSmartSerial, AChannelWithoutARemoteFails) {
    SerialHost host("remote 0 card=7i76\n");
    host.run(0x4000);
    EXPECT_EQ(host.run(0x903), 2U);
    EXPECT_EQ(host.run(0x1003), 2U);
    EXPECT_NE(host.read(0x5C04) & (1U << 13U), 0U) << "communication error";
    EXPECT_EQ(host.read(0x5C00), 0U);
    host.run(0x8FF);
    EXPECT_EQ(host.run(0x1001), 1U) << "a stopped channel does not exchange";
}

TEST(BoardSmartSerial, A7I77HasTwoChannels) {
    SerialHost host("remote 0 card=7i77\n");
    host.run(0x4000);
    EXPECT_EQ(host.run(0xF03), 0U);
    EXPECT_EQ(host.read(0x5E00), host.read(0x5E04)) << "both report 7I77";
    using Names = std::vector<std::string>;
    EXPECT_EQ(host.names(0, 0), (Names{"Output", "Input"}));
    EXPECT_EQ(host.names(1, 0), (Names{"AnalogOut0", "AnalogOut1", "AnalogOut2", "AnalogOut3", "AnalogOut4",
                                       "AnalogOut5", "AnalogEna", "SpinEna"}));
    host.run(0x8FF);
    host.write(0x5C00, 0);
    host.write(0x5C04, 0);
    EXPECT_EQ(host.run(0x903), 0U);
    host.write(0x5D04, 0x800U | (0x7FFU << 12U));
    host.write(0x5F04, 0x100);
    EXPECT_EQ(host.run(0x1003), 0U);
    EXPECT_EQ(host.remote(1).value("AnalogOut0"), 0x800U);
    EXPECT_EQ(host.remote(1).value("AnalogOut1"), 0x7FFU);
    EXPECT_EQ(host.remote(1).value("AnalogEna"), 1U);
}

TEST(BoardSmartSerial, A7I73HasThreeModes) {
    SerialHost host("remote 0 card=7i73\n");
    host.run(0x4000);
    EXPECT_EQ(host.names(0, 0).size(), 6U);
    EXPECT_EQ(host.names(0, 1).back(), "Display");
    EXPECT_EQ(host.names(0, 2).back(), "Display32");
    host.start(2);
    host.remote(0).set_value("Enc3", 0xFF);
    host.write(0x5D00, 0x12400001);
    host.write(0x5E00, 0x8D159E);
    EXPECT_EQ(host.run(0x1001), 0U);
    EXPECT_EQ(host.remote(0).value("Output"), 1U);
    EXPECT_EQ(host.read(0x5E00) & 0xFF0000U, 0xFF0000U);
}

TEST(BoardSmartSerial, GlobalsKeepWhatIsWritten) {
    SerialHost host("remote 0 card=7i76\n");
    host.run(0x4000);
    host.run(0xF01);
    const std::uint32_t list = host.read(0x5F00) >> 16U;
    const std::uint32_t record = host.remote_word(0, list + 6);
    EXPECT_EQ(host.remote_text(0, record + 19), "NVWatchDogTimeout");
    const std::uint32_t at = host.remote_word(0, record + 12);
    EXPECT_EQ(host.remote_word(0, at), 50U);
    host.write(0x5D00, 80);
    host.write(0x5C00, 0x65000000 | at);
    EXPECT_EQ(host.run(0x1001), 0U);
    EXPECT_EQ(host.remote_word(0, at), 80U);
    host.run(0xF01);
    EXPECT_EQ(host.remote_word(0, at), 80U) << "a new start keeps it";
}

TEST(BoardSmartSerial, ACardThatDoesNotFitIsAnError) {
    const auto plan = parse_physics("remote 7 card=7i77", "p.txt", model_of("7i76e").idrom);
    ASSERT_FALSE(plan.has_value());
    EXPECT_EQ(plan.error().str(), "p.txt:1:10: Card '7i77' needs more channels than the port has.");
}

TEST(BoardSmartSerial, AnUnknownCardIsAnError) {
    const auto plan = parse_physics("remote 0 card=7i99", "p.txt", model_of("7i76e").idrom);
    ASSERT_FALSE(plan.has_value());
    EXPECT_EQ(plan.error().str(),
              "p.txt:1:10: Unknown card '7i99', known are 7i73, 7i76, 7i77, 7i77-analog, 7i84.");
}

}  // namespace
}  // namespace mw::mesa::board
