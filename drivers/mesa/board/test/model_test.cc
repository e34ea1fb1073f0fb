// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <gtest/gtest.h>

#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/identity/cards.hh"

namespace mw::mesa::board {
namespace {

constexpr std::string_view BOARD = "board card=7I76E-16 name=MESA7I76 ports=1 port_width=17\n"
                                   "module ioport base=0x1000 registers=5 per_instance=0x1F\n";

std::string error_of(const std::string &text) {
    const auto model = parse_model(text, "m.txt");
    return model.has_value() ? "" : model.error().str();
}

std::string error_after_board(const std::string &text) {
    return error_of(std::string(BOARD) + text);
}

/// The models of cards without Ethernet.
constexpr std::string_view OTHER_BUSES[] = {"5i20", "5i25", "6i25", "7i43", "7i90"};

TEST(BoardModel, EachBuiltInModelMatchesItsCard) {
    EXPECT_EQ(built_in_models().size(), 15U);
    for (const BuiltInModel &one : built_in_models()) {
        const auto model = load_model(std::string(one.name));
        ASSERT_TRUE(model.has_value()) << model.error().str();
        const bool is_ethernet = std::ranges::find(OTHER_BUSES, one.name) == std::end(OTHER_BUSES);
        const Card *card = find_ethernet_card(model->card_name);
        ASSERT_EQ(card != nullptr, is_ethernet) << model->card_name;
        if (is_ethernet) {
            EXPECT_TRUE(one.name == card->hal_name ||
                        one.name.starts_with(std::string(card->hal_name) + '-') ||
                        one.name.starts_with(std::string(card->hal_name) + "hd-"));
            EXPECT_EQ(card->ports, model->idrom.header.io_ports);
            EXPECT_EQ(card->port_width, model->idrom.header.port_width);
        }
        // No two pins have the same function of the same unit.
        for (std::size_t i = 0; i < model->idrom.pins.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const bool plain = model->idrom.pins[i].secondary == Gtag::NONE;
                EXPECT_TRUE(plain || model->idrom.pins[i] != model->idrom.pins[j]) << i << " and " << j;
            }
        }
    }
}

TEST(BoardModel, The7I76EHasThePinsOfItsDescription) {
    const auto model = load_model("7i76e");
    ASSERT_TRUE(model.has_value());
    const auto &pins = model->idrom.pins;
    ASSERT_EQ(pins.size(), 51U);
    EXPECT_EQ(pins[8], (PinDescriptor{0x82, Gtag::STEPGEN, 4, Gtag::IO_PORT}));
    EXPECT_EQ(pins[9], (PinDescriptor{0x81, Gtag::STEPGEN, 4, Gtag::IO_PORT}));
    EXPECT_EQ(pins[14], (PinDescriptor{3, Gtag::ENCODER, 0, Gtag::IO_PORT}));
    EXPECT_EQ(pins[17], PinDescriptor{});
}

TEST(BoardModel, ErrorsNameFileLineAndColumn) {
    EXPECT_EQ(error_after_board(""), "");
    EXPECT_EQ(error_of(""), "m.txt:1:1: The model is empty: the line 'board' is missing.");
    EXPECT_EQ(error_of("# only a comment\npin 3\n"), "m.txt:2:1: The first line of a model is 'board'.");
    EXPECT_EQ(error_after_board(std::string(BOARD)), "m.txt:3:1: A model has one line 'board'.");
    EXPECT_EQ(error_after_board("connector P1\n"),
              "m.txt:3:1: Unknown line 'connector', expected board, module or pin.");
    EXPECT_EQ(error_after_board("module stepgem base=0x2000 registers=10\n"),
              "m.txt:3:1: Unknown module 'stepgem'. Did you mean 'stepgen'?");
    EXPECT_EQ(error_after_board("module stepgen base=0x20000 registers=10\n"),
              "m.txt:3:16: base=0x20000 is not a whole number from 0 to 65535.");
    EXPECT_EQ(error_after_board("module stepgen registers=10\n"), "m.txt:3:1: 'module' needs base=VALUE.");
    EXPECT_EQ(error_after_board("module ssr base=0x200 registers=1 color=red\n"),
              "m.txt:3:35: 'module' has no value 'color'.");
    EXPECT_EQ(error_after_board("module ssr base=0x200 registers=1 clock=slow\n"),
              "m.txt:3:35: clock=slow is not one of low, high.");
    EXPECT_EQ(error_after_board("pin 17 module=ioport function=1\n"),
              "m.txt:3:1: '17' is not a pin from 0 to 16.");
    EXPECT_EQ(error_after_board("pin 3 module=ssr function=1\n"),
              "m.txt:3:7: The board has no module 'ssr'.");
    EXPECT_EQ(error_after_board("pin 3 module=ioport function=1\npin 3 module=ioport function=2\n"),
              "m.txt:4:1: Pin 3 is declared twice.");
    EXPECT_EQ(error_after_board("pin 3 module=ioport function=1 output\n"),
              "m.txt:3:32: Unexpected word 'output', expected KEY=VALUE.");
}

TEST(BoardModel, AModelThatADriverRejectsIsAnError) {
    EXPECT_EQ(
        error_of("board card=7I76E-16 name=MESA7I76 ports=1 port_width=18\n"),
        "m.txt: invalid IDROM PortWidth 18, expected one of 17, 19, 21, 24, 27, 29, 30, 32, aborting load");
    EXPECT_EQ(load_model("5i99").error().message,
              "Unknown model '5i99'. Built in are 5i20, 5i25, 6i25, 7i43, 7i76e, 7i80, 7i80hd-3pwm, "
              "7i80hd-resolver, 7i90, 7i92, 7i92-latch, 7i92-uart, 7i95, 7i96s, 7i97; a file is given by its "
              "path.");
    EXPECT_EQ(load_model("./missing.txt").error().message,
              "cannot open './missing.txt': No such file or directory");
}

TEST(Model, IsWrittenAsATextThatGivesItAgain) {
    for (const BuiltInModel &built_in : built_in_models()) {
        const auto model = parse_model(built_in.text, std::string(built_in.name));
        ASSERT_TRUE(model.has_value()) << model.error().str();
        const auto text = write_model(*model);
        ASSERT_TRUE(text.has_value()) << text.error().str();
        const auto again = parse_model(*text, "again");
        ASSERT_TRUE(again.has_value()) << again.error().str();
        EXPECT_EQ(*again, *model) << built_in.name;
    }
}

TEST(Model, WritesModulesThatItDoesNotKnow) {
    auto model = *load_model("7i92");
    model.idrom.modules.back().gtag = static_cast<Gtag>(77);
    const auto text = write_model(model);
    ASSERT_TRUE(text.has_value()) << text.error().str();
    EXPECT_NE(text->find("module gtag-77 "), std::string::npos) << *text;
}

}  // namespace
}  // namespace mw::mesa::board
