// SPDX-License-Identifier: GPL-2.0-or-later
// Prefixes in Declare.
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"
#include "hal/sdk/component.hh"

namespace mw::hal {
namespace {

struct DeclareNames : ::testing::Test {
    TestMachine machine;
    UseInstance use{machine.host.get() == nullptr ? nullptr : &machine.hal()};
    int comp = hal_init("board");
    sdk::Out<bool> *pin = sdk::make<sdk::Out<bool>>();

    ~DeclareNames() override { hal_exit(comp); }
};

TEST_F(DeclareNames, KeepsThePrefixAfterTheTextHasChanged) {
    char prefix[] = "board.0";
    sdk::Declare declare(comp, prefix, 0);
    std::memset(prefix, 'x', sizeof prefix - 1);
    declare.pin(*pin, "in");
    EXPECT_EQ(declare.status(), 0);
    EXPECT_EQ(machine.hal().pins().list("board.0.in").size(), 1U);
}

TEST_F(DeclareNames, RefusesAPrefixThatIsTooLongEvenWithoutAName) {
    sdk::Declare declare(comp, std::string(HAL_NAME_LEN + 1, 'p').c_str(), 0);
    declare.pin(*pin, "");
    EXPECT_EQ(declare.status(), -EINVAL);
}

}  // namespace
}  // namespace mw::hal
