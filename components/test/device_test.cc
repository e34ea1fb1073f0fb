// SPDX-License-Identifier: GPL-2.0-or-later
// Carousels, converters, displays, lasers, and switchable kinematics.
#include <dlfcn.h>

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "components/hmi/lcd_core.hh"
#include "components/machine/bldc_core.hh"
#include "components/machine/carousel_core.hh"
#include "components/machine/raster_core.hh"
#include "components/machine/thermocouple.hh"
#include "components/test/bench.hh"
#include "components/test/modules.hh"
#include "hal/include/kinematics.h"

namespace mw::components::test {
namespace {

/// A carousel with eight pockets and binary sensors.
class CarouselTest : public ::testing::Test {
  protected:
    Bench bench{"loadrt carousel pockets=8 encoding=binary\naddf carousel.0 t\nsetp carousel.0.fwd-dc 1.5\n"
                "setp carousel.0.rev-dc -0.7\nsetp carousel.0.hold-dc 0.2"};

    void at(int pocket) {
        for (int i = 0; i < 4; ++i) {
            bench.set("carousel.0.sense-" + std::to_string(i), pocket >> i & 1);
        }
        bench.pass();
    }
    double pin(const std::string &name) { return bench.get("carousel.0." + name); }
    void set(const std::string &name, double value) { bench.set("carousel.0." + name, value); }
};

TEST_F(CarouselTest, TurnsTheShorterWayAndStopsThere) {
    at(1);
    set("pocket-number", 3);
    set("enable", 1);
    at(1);
    EXPECT_EQ(pin("active"), 1.0);
    EXPECT_EQ(pin("motor-fwd"), 1.0);
    EXPECT_EQ(pin("motor-vel"), 1.5);
    at(0);
    at(2);
    EXPECT_EQ(pin("motor-fwd"), 1.0);
    at(3);
    EXPECT_EQ(pin("motor-fwd"), 0.0);
    EXPECT_EQ(pin("ready"), 1.0);
    EXPECT_EQ(pin("active"), 0.0);
    EXPECT_EQ(pin("motor-vel"), 0.2);
    set("enable", 0);
    at(3);
    set("pocket-number", 9);  // the first one again
    set("enable", 1);
    at(3);
    EXPECT_EQ(pin("motor-rev"), 1.0);
    EXPECT_EQ(pin("motor-vel"), -0.7);
    EXPECT_EQ(pin("ready"), 0.0);
    at(1);
    EXPECT_EQ(pin("ready"), 1.0);
}

TEST_F(CarouselTest, StopsWhenDisabledAndRefusesNoPocket) {
    at(1);
    set("pocket-number", 3);
    set("enable", 1);
    at(1);
    set("enable", 0);
    at(2);
    EXPECT_EQ(pin("motor-fwd"), 0.0);
    EXPECT_EQ(pin("active"), 0.0);
    EXPECT_EQ(pin("ready"), 0.0);
    set("pocket-number", 0);
    set("enable", 1);
    at(2);
    EXPECT_EQ(pin("motor-fwd"), 0.0);
    EXPECT_EQ(pin("motor-rev"), 0.0);
}

TEST_F(CarouselTest, PulsesInReverseAgainstItsStop) {
    set("rev-pulse", 0.003);
    at(3);
    set("pocket-number", 4);
    set("enable", 1);
    at(3);
    at(4);
    EXPECT_EQ(pin("motor-rev"), 1.0);
    EXPECT_EQ(pin("ready"), 0.0);
    at(4);
    at(4);
    EXPECT_EQ(pin("motor-rev"), 1.0);
    at(4);
    EXPECT_EQ(pin("motor-rev"), 0.0);
    EXPECT_EQ(pin("ready"), 1.0);
}

TEST_F(CarouselTest, AlignsOnTheForwardEdge) {
    set("align-dc", 0.1);
    set("decel-time", 0.002);
    at(3);
    set("pocket-number", 4);
    set("enable", 1);
    at(3);
    at(4);
    EXPECT_EQ(pin("motor-vel"), 0.0) << "slowing down";
    at(0);  // it overshot
    at(0);
    EXPECT_EQ(pin("motor-vel"), -0.1);
    at(4);
    EXPECT_EQ(pin("motor-rev"), 1.0) << "off the marker again";
    at(0);
    EXPECT_EQ(pin("motor-vel"), 0.1);
    at(4);
    EXPECT_EQ(pin("ready"), 1.0);
}

TEST_F(CarouselTest, ChecksParityAndStrobe) {
    at(3);
    EXPECT_EQ(pin("parity-error"), 0.0);
    at(1);
    EXPECT_EQ(pin("parity-error"), 1.0);
    set("parity", 1);
    at(1);
    EXPECT_EQ(pin("parity-error"), 0.0);
    set("strobe", 0);
    at(5);
    EXPECT_EQ(pin("current-position"), 1.0) << "not valid now";
}

TEST_F(CarouselTest, JogsOnePocket) {
    at(8);
    set("jog-fwd", 1);
    at(8);
    EXPECT_EQ(pin("motor-fwd"), 1.0);
    set("jog-fwd", 0);
    at(1);
    EXPECT_EQ(pin("motor-fwd"), 0.0);
    EXPECT_EQ(pin("ready"), 0.0);
}

TEST(CarouselHoming, SearchesTheIndexFirst) {
    Bench bench("loadrt carousel pockets=4 encoding=index\naddf carousel.0 t\nsetp carousel.0.fwd-dc 1\n"
                "setp carousel.0.pocket-number 3\nsetp carousel.0.enable 1");
    const auto step = [&](int index, int pulse) {
        bench.set("carousel.0.sense-0", index);
        bench.set("carousel.0.sense-1", pulse);
        bench.pass();
    };
    step(0, 1);
    EXPECT_EQ(bench.get("carousel.0.homing"), 1.0);
    bench.set("carousel.0.enable", 0);  // homing continues
    step(1, 0);
    EXPECT_EQ(bench.get("carousel.0.motor-fwd"), 1.0);
    bench.set("carousel.0.enable", 1);
    step(1, 1);
    EXPECT_EQ(bench.get("carousel.0.homed"), 1.0);
    EXPECT_EQ(bench.get("carousel.0.current-position"), 1.0);
    for (int pocket = 2; pocket <= 3; ++pocket) {
        EXPECT_EQ(bench.get("carousel.0.motor-fwd"), 1.0);
        step(0, 0);
        step(0, 1);
        EXPECT_EQ(bench.get("carousel.0.current-position"), pocket);
    }
    EXPECT_EQ(bench.get("carousel.0.ready"), 1.0);
}

TEST(CarouselCore, DecodesAndFindsPassedPockets) {
    carousel::Position position;
    position.pockets = 40;
    position.encoding = carousel::Encoding::BCD;
    position.read({.bits = 0x37}, 0);
    EXPECT_EQ(position.pocket, 37);
    position.encoding = carousel::Encoding::GRAY;
    position.read({.bits = 7}, 0);
    EXPECT_EQ(position.pocket, 5);
    position.encoding = carousel::Encoding::SINGLE;
    position.read({.bits = 16}, 0);
    EXPECT_EQ(position.pocket, 5);
    position.read({.bits = 17}, 0);
    EXPECT_EQ(position.pocket, 0) << "two at once";
    position.pockets = 4;
    position.encoding = carousel::Encoding::COUNTS;
    position.findHome({.bits = 1, .counts = 50});
    position.read({.counts = 249}, 1);
    EXPECT_EQ(position.pocket, 2) << "passed 150";
    position.read({.counts = 255}, 1);
    EXPECT_EQ(position.pocket, 3) << "passed 250";
    position.read({.counts = 240}, -1);
    EXPECT_EQ(position.pocket, 3) << "passed it again, backwards";
    position.read({.counts = -50}, -1);
    EXPECT_EQ(position.pocket, 4) << "one before the first";
}

TEST(BldcCore, EveryPatternHasSixDifferentSectorsThatDifferInOneSensor) {
    for (int pattern = 0; pattern < bldc::PATTERNS; ++pattern) {
        for (int sector = 0; sector < bldc::SECTORS; ++sector) {
            const unsigned hall = bldc::hall_of_sector(pattern, sector);
            EXPECT_EQ(bldc::sector_of_hall(pattern, hall), sector) << pattern;
            const unsigned next = bldc::hall_of_sector(pattern, (sector + 1) % bldc::SECTORS);
            EXPECT_EQ(__builtin_popcount(hall ^ next), 1) << pattern;
        }
    }
}

TEST(Thermocouple, FollowsTheTablesOfTypeK) {
    const double points[][2] = {{-100, -3.554}, {0, 0},         {100, 4.096},
                                {500, 20.644},  {1000, 41.276}, {1300, 52.410}};
    for (const auto &point : points) {
        EXPECT_NEAR(thermocouple::type_k_mv(point[0]), point[1], 0.001);
        EXPECT_NEAR(thermocouple::type_k_celsius(point[1]), point[0], 0.1);
    }
    EXPECT_TRUE(std::isnan(thermocouple::type_k_celsius(60)));
}

/// A converter at the other end of the wires.
double read_max31855(Bench &bench, std::uint32_t frame) {
    int bit = 31;
    bool last_clock = false;
    for (int i = 0; i < 200; ++i) {
        bench.set("max31855.0.data.0.in", frame >> (bit & 31) & 1U);
        bench.pass();
        const bool clock = bench.get("max31855.0.clk.out") != 0.0;
        if (bench.get("max31855.0.cs.out") != 0.0) {
            bit = 31;
        } else if (!clock && last_clock) {
            --bit;
        }
        last_clock = clock;
    }
    return bench.get("max31855.0.temp-celsius.0");
}

TEST(Max31855, ReadsFramesAndFaults) {
    Bench bench("loadrt max31855 personality=1\naddf max31855.0.bitbang-spi t");
    const auto frame = [](double celsius, double inside) {
        return (static_cast<std::uint32_t>(static_cast<int>(celsius * 4)) << 18) |
               ((static_cast<std::uint32_t>(static_cast<int>(inside * 16)) & 0xfffU) << 4);
    };
    EXPECT_NEAR(read_max31855(bench, frame(100, 25)), 100.1, 1.0);
    const double before = bench.get("max31855.0.temp-celsius.0");
    EXPECT_NEAR(bench.get("max31855.0.temp-fahrenheit.0"), before * 1.8 + 32, 1e-9);
    EXPECT_EQ(read_max31855(bench, frame(500, 25) | 0x10002U), before) << "kept in a fault";
    EXPECT_EQ(bench.get("max31855.0.fault.0"), 1.0);
    EXPECT_EQ(bench.get("max31855.0.fault-flags.0"), 2.0);
    EXPECT_NEAR(read_max31855(bench, frame(-50, 20)), -55.7, 0.2) << "the converter counts straight on";
    EXPECT_EQ(read_max31855(bench, frame(1500, 20)), 1500.0) << "outside the curve: unchanged";
}

std::string text_of(const lcd::Text &text) {
    return {text.text, static_cast<std::size_t>(text.length)};
}

lcd::Item item_of(const char *format) {
    lcd::Item item;
    EXPECT_TRUE(lcd::parse_item(format, item)) << format;
    return item;
}

TEST(LcdCore, ShowsNumbersInTheirFields) {
    EXPECT_EQ(text_of(lcd::show_float(item_of("%f"), 3.14159, '.')), "3.1416");
    EXPECT_EQ(text_of(lcd::show_float(item_of("%+5.2f"), 3.14159, ',')), "+3,14");
    EXPECT_EQ(text_of(lcd::show_float(item_of("%08.3f"), -3.14159, '.')), "-003.142");
    EXPECT_EQ(text_of(lcd::show_float(item_of("%4.2f"), -314.159, '.')), "-***");
    EXPECT_EQ(text_of(lcd::show_float(item_of("%4f"), std::nan(""), '.')), "****");
    EXPECT_EQ(text_of(lcd::show_integer(item_of("%6d"), 42, true)), "   -42");
    EXPECT_EQ(text_of(lcd::show_integer(item_of("%x"), 255, false)), "FF");
    EXPECT_EQ(text_of(lcd::show_integer(item_of("%o"), 8, false)), "10");
    EXPECT_EQ(text_of(lcd::show_character(item_of("%3c"), 65)), "AAA");
    EXPECT_EQ(text_of(lcd::show_character(item_of("%bY\\7E"), 0)), "~");
    lcd::Item item;
    for (const char *wrong : {"%q", "%", "%99d", "%b1", "\\x"}) {
        const char *text = wrong;
        EXPECT_FALSE(lcd::parse_item(text, item)) << wrong;
    }
}

TEST(Lcd, StreamsThePageThatIsChosen) {
    Bench bench("loadrt lcd \"fmt_strings=X%3d\\nY|second\"\naddf lcd t\nsetp lcd.00.page.00.arg.00 7");
    const auto stream = [&](int periods) {
        std::string text;
        for (int i = 0; i < periods; ++i) {
            bench.pass();
            const char c = static_cast<char>(bench.get("lcd.00.out"));
            text += c != '\0' ? std::string(1, c) : "";
        }
        return text;
    };
    stream(114);
    EXPECT_EQ(stream(14), "\x1e\x1aX  7\x18\r\nY\x1b=  ");
    bench.set("lcd.00.page-num", 1);
    EXPECT_NE(stream(40).find("\x1e\x1asecond\x1b=  second"), std::string::npos);
}

raster::Line line_of(const std::string &text) {
    raster::Line line;
    for (const char byte : text) {
        line.take(byte);
    }
    return line;
}

TEST(RasterCore, ReadsLinesAndFindsMistakes) {
    const auto line = std::make_unique<raster::Line>(line_of("\n-1.5;8;10.25;3;00\n7Fff"));
    EXPECT_EQ(line->reading(), raster::Reading::COMPLETE);
    EXPECT_EQ(line->offset(), -1.5);
    EXPECT_EQ(line->pixels_per_unit(), 10.25);
    EXPECT_EQ(line->count(), 3);
    EXPECT_EQ(line->bits(), 8);
    EXPECT_EQ(line->percent(0), 0.0);
    EXPECT_EQ(line->percent(1), 50.0);
    EXPECT_EQ(line->percent(2), raster::NO_PIXEL);
    EXPECT_EQ(line->way(-2.5), 10.25) << "downwards";
    EXPECT_EQ(line_of("0;32;2;2;fffffffe00000000").percent(0), 100.0);
    EXPECT_NEAR(line_of("-2.5e-05;8;1e+3;2;0000").offset(), -2.5e-5, 1e-15);
    EXPECT_EQ(line_of("0;8;10;2;00").reading(), raster::Reading::PIXELS);
    EXPECT_EQ(line_of("0;8;10;2;0g").reading(), raster::Reading::BAD_PIXEL);
    const std::vector<std::pair<const char *, raster::Reading>> bad = {
        {"x;", raster::Reading::BAD_OFFSET},         {";", raster::Reading::BAD_OFFSET},
        {"1e999;", raster::Reading::BAD_OFFSET},     {"0;7;", raster::Reading::BAD_BITS},
        {"0;36;", raster::Reading::BAD_BITS},        {"0;0;", raster::Reading::BAD_BITS},
        {"0;-8;", raster::Reading::BAD_BITS},        {"0;8;0;", raster::Reading::BAD_SCALE},
        {"0;8;-1;", raster::Reading::BAD_SCALE},     {"0;8;--1;", raster::Reading::BAD_SCALE},
        {"0;8;1;1;", raster::Reading::BAD_COUNT},    {"0;8;1;2.5;", raster::Reading::BAD_COUNT},
        {"0;8;1;99999;", raster::Reading::BAD_COUNT}};
    for (const auto &[header, reading] : bad) {
        EXPECT_EQ(line_of(header).reading(), reading) << header;
    }
    EXPECT_EQ(line_of(std::string(200, '0')).reading(), raster::Reading::BAD_OFFSET);
}

TEST(Raster, HasNoPowerWithoutALine) {
    Bench bench("loadrt raster\naddf raster.0 t");
    EXPECT_EQ(bench.get("raster.0.output"), -1.0);
    EXPECT_EQ(bench.after("raster.0.run", 1, "raster.0.enabled"), 0.0) << "it waits for a line";
    EXPECT_EQ(bench.get("raster.0.output"), -1.0);
    EXPECT_EQ(bench.get("raster.0.fault"), 0.0);
    EXPECT_EQ(bench.after("raster.0.reset", 1, "raster.0.state"), 0.0);
}

TEST(Millturn, SwitchesBetweenMillAndTurn) {
    void *module = dlopen(MW_MODULES_FOLDER "/millturn.so", RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(module, nullptr) << dlerror();
    const auto forward = reinterpret_cast<decltype(&kinematicsForward)>(dlsym(module, "kinematicsForward"));
    const auto inverse = reinterpret_cast<decltype(&kinematicsInverse)>(dlsym(module, "kinematicsInverse"));
    const auto change = reinterpret_cast<decltype(&kinematicsSwitch)>(dlsym(module, "kinematicsSwitch"));
    ASSERT_TRUE(forward != nullptr && inverse != nullptr && change != nullptr);
    for (int type = 0; type < 2; ++type) {
        ASSERT_EQ(change(type), 0);
        const double joint[] = {1, 2, 3, 4};
        EmcPose pose{};
        ASSERT_EQ(forward(joint, &pose, nullptr, nullptr), 0);
        EXPECT_EQ(pose.tran.x, type == 0 ? 1 : 3);
        EXPECT_EQ(pose.tran.y, type == 0 ? 2 : -2);
        EXPECT_EQ(pose.tran.z, type == 0 ? 3 : 1);
        double back[4] = {};
        ASSERT_EQ(inverse(&pose, back, nullptr, nullptr), 0);
        for (int i = 0; i < 4; ++i) {
            EXPECT_EQ(back[i], joint[i]);
        }
    }
    EXPECT_NE(change(2), 0);
    dlclose(module);
}

}  // namespace
}  // namespace mw::components::test
