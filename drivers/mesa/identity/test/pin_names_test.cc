// SPDX-License-Identifier: GPL-2.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "drivers/mesa/identity/pin_names.hh"

namespace mw::mesa {
namespace {

TEST(PinNames, NamesFunctionsAsManualsDo) {
    EXPECT_EQ(pin_function({.secondary_pin = 0x82, .secondary = Gtag::STEPGEN, .unit = 3}),
              "step generator 3: direction");
    EXPECT_EQ(pin_function({.secondary_pin = 3, .secondary = Gtag::ENCODER, .unit = 0}), "encoder 0: index");
    EXPECT_EQ(pin_function({.secondary_pin = 0x83, .secondary = Gtag::SMART_SERIAL, .unit = 0}),
              "smart serial 0: transmit 2");
    EXPECT_EQ(pin_function({.secondary_pin = 0x81, .secondary = Gtag::MUX_SELECT, .unit = 0x80}),
              "encoder multiplexer: select 0");
    EXPECT_EQ(pin_function({}), "");
}

TEST(PinNames, AModuleThatIsNotKnownHasItsNumber) {
    EXPECT_EQ(pin_function({.secondary_pin = 0x84, .secondary = static_cast<Gtag>(77), .unit = 1}),
              "module 77 1: function 0x84");
}

TEST(PinNames, EachPinOfAConnectorOccursOnce) {
    for (const auto &[width, highest] : {std::pair{17, 17}, {24, 47}}) {
        std::set<int> pins;
        for (int i = 0; i < width; ++i) {
            EXPECT_TRUE(pins.insert(connector_pin(width, i)).second);
        }
        EXPECT_EQ(*pins.begin(), 1);
        EXPECT_EQ(*pins.rbegin(), highest);
    }
    EXPECT_EQ(connector_pin(17, 17), 0);
    EXPECT_EQ(connector_pin(29, 3), 0) << "its manual names the terminals";
}

}  // namespace
}  // namespace mw::mesa
