// SPDX-License-Identifier: GPL-2.0-or-later
// sim_parport has the canonical digital inputs and outputs under the names of a parallel port.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

constexpr int OUTPUTS[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17};
constexpr int INPUTS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15};

std::string pin_of(int number) {
    return std::string("parport.0.pin-") + (number < 10 ? "0" : "") + std::to_string(number);
}

class SimParportTest : public ::testing::Test {
  protected:
    Bench bench{"loadrt sim_parport names=parport.0\naddf parport.0.read t\naddf parport.0.write t"};
};

TEST_F(SimParportTest, HasPinsAndParametersOfThePortWithTypeAndDirection) {
    using Kind = std::pair<hal::Type, hal::Dir>;
    std::map<std::string, Kind> expected{{"parport.0.reset-time", {hal::Type::FLOAT, hal::Dir::IN}}};
    std::map<std::string, hal::Type> expected_params;
    for (const int i : OUTPUTS) {
        expected[pin_of(i) + "-out"] = {hal::Type::BIT, hal::Dir::IN};
        expected[pin_of(i) + "-out-fake"] = {hal::Type::BIT, hal::Dir::OUT};
        expected_params[pin_of(i) + "-out-invert"] = hal::Type::BIT;
        expected_params[pin_of(i) + "-out-reset"] = hal::Type::BIT;
    }
    for (const int i : INPUTS) {
        expected[pin_of(i) + "-in"] = {hal::Type::BIT, hal::Dir::OUT};
        expected[pin_of(i) + "-in-not"] = {hal::Type::BIT, hal::Dir::OUT};
        expected[pin_of(i) + "-in-fake"] = {hal::Type::BIT, hal::Dir::IN};
    }
    std::map<std::string, Kind> pins;
    for (const hal::PinInfo &pin : bench.hal().pins().list("parport.0.*")) {
        if (pin.owner == "sim_parport" && pin.name.find(".time") == std::string::npos) {
            pins[pin.name] = {pin.type, pin.dir};
        }
    }
    EXPECT_EQ(pins, expected);
    std::map<std::string, hal::Type> params;
    for (const hal::ParamInfo &param : bench.hal().params().list("parport.0.pin-*")) {
        EXPECT_EQ(param.dir, hal::Dir::RW) << param.name;
        params[param.name] = param.type;
    }
    EXPECT_EQ(params, expected_params);
}

TEST_F(SimParportTest, CopiesInputsWithTheirInverseAndInvertsOutputs) {
    bench.set(pin_of(15) + "-in-fake", 1);
    bench.set(pin_of(17) + "-out", 1);
    bench.set(pin_of(16) + "-out-invert", 1);
    bench.pass();
    EXPECT_EQ(bench.get(pin_of(15) + "-in"), 1.0);
    EXPECT_EQ(bench.get(pin_of(15) + "-in-not"), 0.0);
    EXPECT_EQ(bench.get(pin_of(2) + "-in"), 0.0);
    EXPECT_EQ(bench.get(pin_of(2) + "-in-not"), 1.0);
    EXPECT_EQ(bench.get(pin_of(17) + "-out-fake"), 1.0);
    EXPECT_EQ(bench.get(pin_of(16) + "-out-fake"), 1.0);
    EXPECT_EQ(bench.get(pin_of(1) + "-out-fake"), 0.0);
}

}  // namespace
}  // namespace mw::components::test
