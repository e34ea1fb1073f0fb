// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/mesa/board/test/host.hh"

namespace mw::mesa::board {
namespace {

TEST(BoardThreePhasePwm, EachPhaseHasItsDutyWhileEnabled) {
    Host host("7i80hd-3pwm");
    host.write(0x4600, 0x300U | (0x200U << 10U) | (0x100U << 20U));
    const auto duty = [&](unsigned phase) {
        return phase_duty(host.board.firmware().three_phase_pwm()->generators()[0], phase);
    };
    EXPECT_EQ(duty(0), 0.0) << "not enabled";
    host.write(0x4700, 1);
    EXPECT_EQ(duty(0), 0.75);
    EXPECT_EQ(duty(1), 0.5);
    EXPECT_EQ(duty(2), 0.25);
    EXPECT_EQ(host.read(0x4700), 1U);
    host.write(0x4804, 0x01FF0066);
    EXPECT_EQ(host.read(0x4804), 0x01FF0066U) << "each generator has its setup";
    EXPECT_EQ(host.read(0x4800), 0U);
}

// The average of the level over whole periods is the duty; the lower switch has the opposite level.
TEST(BoardThreePhasePwm, TheOutputsFollowTheDuty) {
    Host host("7i80hd-3pwm");
    host.write(0x4600, 0x300);
    host.write(0x4900, 13'422);  // 20 kHz
    host.write(0x4700, 1);
    host.write(0x1200, 0x7F);
    host.write(0x1100, 0x7F);
    int high = 0;
    constexpr int SAMPLES = 10'000;
    for (int i = 0; i < SAMPLES; ++i) {
        host.time_ns += 997;
        host.board.advance(host.time_ns);
        high += host.board.firmware().pin_level(0) ? 1 : 0;
        ASSERT_NE(host.board.firmware().pin_level(0), host.board.firmware().pin_level(3));
    }
    EXPECT_NEAR(static_cast<double>(high) / SAMPLES, 0.75, 0.01);
    EXPECT_FALSE(host.board.firmware().pin_level(6)) << "/enable";
}

TEST(BoardThreePhasePwm, AFaultSwitchesOffUntilItIsEnabledAgain) {
    Host host("7i80hd-3pwm");
    host.write(0x4700, 1);
    host.board.firmware().set_input(7, false);
    EXPECT_EQ(host.read(0x4700), 3U);
    host.board.firmware().set_input(7, true);
    EXPECT_EQ(host.read(0x4700), 3U) << "the fault is kept";
    EXPECT_EQ(phase_duty(host.board.firmware().three_phase_pwm()->generators()[0], 0), 0.0);
    host.write(0x4700, 0);
    host.write(0x4700, 1);
    EXPECT_EQ(host.read(0x4700), 1U);
    host.write(0x4800, 0x8000);
    EXPECT_EQ(host.read(0x4700), 3U) << "with the other polarity, high is a fault";
}

TEST(BoardRcPwm, PulseAndPeriodAreExact) {
    Host host("7i92-uart");
    host.write(0x4A04, 9374);       // 1.5 ms
    host.write(0x4B00, 1'999'998);  // 50 Hz
    const RcPwmModule &pwm = *host.board.firmware().rc_pwm();
    EXPECT_EQ(pwm.pulse_ns(1), 1'500'000);
    EXPECT_EQ(pwm.period_ns(), 20'000'000);
    EXPECT_EQ(pwm.pulse_ns(0), 0) << "nothing was written";
    for (std::int64_t time_ns = 50'000; time_ns < 60 * MS; time_ns += 100'000) {
        host.board.advance(time_ns);
        ASSERT_EQ(pwm.output(1, 0x81), time_ns % (20 * MS) < 1'500'000) << time_ns;
    }
}

TEST(BoardResolver, ABoardWithoutResolversRejectsOne) {
    const auto plan = parse_physics("motor x stepgen=0 steps_per_rev=200\nresolver 0 motor=x\n", "p.txt",
                                    model_of("7i92").idrom);
    ASSERT_FALSE(plan.has_value());
    EXPECT_EQ(plan.error().str(), "p.txt:2:1: The board has no resolver '0': it has 0.");
}

TEST(BoardResolver, APwmMotorTurnsItsResolver) {
    Host host("7i80hd-resolver", "motor s pwm=0 full_rev_s=10 start_rev=0.25\nresolver 2 motor=s\n");
    host.time_ns = MS;
    EXPECT_EQ(host.read(0x3E08), 0x40000000U);
    EXPECT_EQ(host.read(0x3C00), 0x3BU) << "the other channels have no signal";
    host.write(0x3A00, 0x801);  // ClockLow / 20000: 5 kHz
    EXPECT_EQ(host.read(0x3A00), 0x801U) << "the command takes its time";
    host.write(0x1200, 0x7F);
    host.write(0x1100, 0x7F);
    host.write(0x4100, 3);
    host.write(0x4000, 4095U << 16U);
    host.write(0x4400, 1);
    for (int i = 0; i < 100; ++i) {
        host.time_ns += MS;
        host.read(0x3E08);
    }
    EXPECT_EQ(host.read(0x3A00), 0U);
    const double rev_s = static_cast<std::int32_t>(host.read(0x3D08)) / 4294967296.0 * 5000;
    EXPECT_NEAR(rev_s, 10.0, 0.01);
    const double rev = host.board.physics().position_rev(0);
    EXPECT_NEAR(host.read(0x3E08) / 4294967296.0, rev - std::floor(rev), 1e-3);
}

TEST(BoardUart, BytesComeBackAfterTheirTime) {
    Host host("7i92-uart");
    host.write(0x6210, 1208);  // 115200 bits/s, instance 1
    host.write(0x601C, 0x44332211);
    host.write(0x6010, 0x55);
    EXPECT_EQ(host.read(0x6110), 5U) << "five bytes are not sent yet";
    EXPECT_EQ(host.read(0x6510), 0U);
    host.time_ns = 100 * US;  // a byte takes 87 us
    EXPECT_EQ(host.read(0x6510), 1U);
    host.time_ns = MS;
    EXPECT_EQ(host.read(0x6110), 0U);
    EXPECT_EQ(host.read(0x6510), 5U);
    EXPECT_EQ(host.read(0x6414), 0x2211U) << "two bytes";
    EXPECT_EQ(host.read(0x6410), 0x33U);
    EXPECT_EQ(host.read(0x6510), 2U);
    host.write(0x6510, 0);
    EXPECT_EQ(host.read(0x6510), 0U) << "the FIFO is emptied";
    EXPECT_EQ(host.read(0x6500), 0U) << "the other instance has its own line";
}

TEST(BoardUart, APeerAnswers) {
    Host host("7i92-uart");
    host.board.firmware().serial_lines(Gtag::UART_TX)[0].connect([](const SerialBytes &frame) {
        return frame[0] == 0x0D ? std::optional(SerialBytes{'O', 'K'}) : std::nullopt;
    });
    host.write(0x6200, 1208);
    host.write(0x6000, 'A');
    host.write(0x6000, 0x0D);
    host.time_ns = MS;
    EXPECT_EQ(host.read(0x6500), 2U);
    EXPECT_EQ(host.read(0x6404), 'O' | ('K' << 8U));
}

TEST(BoardPacketUart, FramesKeepTheirLengths) {
    Host host("7i92-uart");
    host.write(0x6A00, 10'486);  // 1 Mbit/s
    host.write(0x6800, 0x04030201);
    host.write(0x6800, 0x05);
    host.write(0x6900, 5);
    host.write(0x6800, 0x00EEDDCC);
    host.write(0x6900, 3);
    EXPECT_EQ((host.read(0x6B00) >> 16U) & 0x1FU, 2U) << "frames to be sent";
    host.time_ns = MS;
    EXPECT_EQ((host.read(0x6F00) >> 16U) & 0x1FU, 2U) << "frames received";
    EXPECT_EQ(host.read(0x6D00), 5U);
    EXPECT_EQ(host.read(0x6C00), 0x04030201U);
    EXPECT_EQ(host.read(0x6C00), 0x05U);
    EXPECT_EQ((host.read(0x6F00) >> 16U) & 0x1FU, 1U);
    host.write(0x6F00, 0x80010000);
    EXPECT_EQ((host.read(0x6F00) >> 16U) & 0x1FU, 0U);
}

TEST(BoardBspi, EachChannelHasItsFrame) {
    Host host("7i92-latch");
    host.write(0x5500, 0x0000000B);  // channel 0: 12 bits
    host.write(0x5500, 0x80010017);  // channel 1: 24 bits, no answer
    host.write(0x5400, 0xFABC);
    host.write(0x5404, 0x123456);
    EXPECT_EQ(host.read(0x5600), 1U);
    EXPECT_EQ(host.read(0x5400), 0xABCU) << "12 bits come back";
    host.board.firmware().bspi()->connect(
        0, [](unsigned channel, std::uint32_t frame) { return frame + channel + 1; });
    host.write(0x5400, 0x10);
    EXPECT_EQ(host.read(0x5400), 0x11U);
}

/// Sets the filters of 32 inputs: scans of `divisor` + 1 times 128 ticks.
void set_filters(Host &host, unsigned divisor, unsigned fast, unsigned slow) {
    host.write(0x8000, (divisor << 6U) | (fast << 16U) | (slow << 22U) | 0x20U);
}

TEST(BoardInMux, AnInputIsTakenAfterItsScans) {
    Host host("7i92-latch");
    EXPECT_EQ(host.read(0x8000) & 0x1FU, 31U);
    set_filters(host, 38, 5, 500);  // 20 kHz: a scan is 50 us
    host.write(0x8100, 0x2);
    host.board.firmware().set_multiplexed_input(0, true);
    host.board.firmware().set_multiplexed_input(1, true);
    EXPECT_EQ(host.read(0x8300), 3U) << "raw";
    host.time_ns = 240 * US;
    EXPECT_EQ(host.read(0x8200), 0U);
    host.time_ns = 260 * US;
    EXPECT_EQ(host.read(0x8200), 1U);
    host.time_ns = 24 * MS;
    EXPECT_EQ(host.read(0x8200), 1U) << "the slow one waits for 25 ms";
    host.time_ns = 26 * MS;
    EXPECT_EQ(host.read(0x8200), 3U);
    host.board.firmware().set_multiplexed_input(0, false);
    host.time_ns += 200 * US;
    host.board.advance(host.time_ns);
    host.board.firmware().set_multiplexed_input(0, true);
    host.time_ns += MS;
    EXPECT_EQ(host.read(0x8200), 3U) << "a short change is filtered";
}

TEST(BoardInMux, ASwitchOfAMotorIsAnInput) {
    Host host("7i92-latch", "motor x stepgen=0 steps_per_rev=200\nswitch 31 inmux=0 motor=x above_rev=0.5\n");
    set_filters(host, 0, 1, 1);
    host.write(0x1200, 0x3);
    host.write(0x1100, 0x3);
    host.write(0x2000, 429'497);  // 10,000 steps/s
    host.time_ns = 9 * MS;
    EXPECT_EQ(host.read(0x8300), 0U);
    host.time_ns = 11 * MS;
    EXPECT_EQ(host.read(0x8300), 0x80000000U);
    const auto error = [](const std::string &model, const std::string &text) {
        return parse_physics("motor x stepgen=0 steps_per_rev=200\n" + text, "p.txt", model_of(model).idrom)
            .error()
            .str();
    };
    EXPECT_EQ(error("7i92-latch", "switch 32 inmux=0 motor=x above_rev=1"),
              "p.txt:2:1: The board has no input '32': it has 32.");
    EXPECT_EQ(error("7i76e", "switch 3 inmux=0 motor=x above_rev=1"),
              "p.txt:2:10: The board has no module 'inmux'.");
}

TEST(BoardInMux, MpgCountersCountTheirInputs) {
    Host host("7i92-latch");
    set_filters(host, 0, 1, 1);
    host.write(0x8400, 0x00000001);  // counter 0: 4x, counter 1: 1x
    const auto turn = [&](int steps) {
        constexpr unsigned AB[] = {0, 1, 3, 2};
        static unsigned phase = 0;
        for (int i = 0; i < std::abs(steps); ++i) {
            phase += steps > 0 ? 1U : 3U;
            for (const unsigned counter : {0U, 1U}) {
                host.board.firmware().set_multiplexed_input(2 * counter, (AB[phase & 3U] & 1U) != 0);
                host.board.firmware().set_multiplexed_input(2 * counter + 1, (AB[phase & 3U] & 2U) != 0);
            }
            host.time_ns += 100 * US;
            host.board.advance(host.time_ns);
        }
    };
    turn(40);
    EXPECT_EQ(host.read(0x8400), 40U | (10U << 8U));
    turn(-60);
    EXPECT_EQ(host.read(0x8400), 0xECU | (0xFBU << 8U)) << "-20 and -5";
}

// Random registers at random times: nothing crashes, and the description of the firmware is unchanged.
TEST(BoardModels, SurviveRandomRegisters) {
    for (const BuiltInModel &model : built_in_models()) {
        SCOPED_TRACE(model.name);
        std::mt19937_64 random(11);
        Board board(*load_model(std::string(model.name)));
        std::int64_t time_ns = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto address = static_cast<std::uint16_t>(4 * (random() % 0x2800));
            if (random() % 2 == 0) {
                board.firmware().write(address, static_cast<std::uint32_t>(random()));
            } else {
                (void)board.firmware().read(address);
            }
            time_ns += static_cast<std::int64_t>(random() % 50'000);
            board.advance(time_ns);
        }
        EXPECT_EQ(board.firmware().read(0x0100), COOKIE);
    }
}

}  // namespace
}  // namespace mw::mesa::board
