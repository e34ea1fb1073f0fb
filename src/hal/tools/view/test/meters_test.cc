// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "hal/tools/view/meters.hh"

namespace mw::hal::view {
namespace {

using Words = std::vector<std::string>;

Words asked(const Words &words, bool is_terminal = false) {
    bool wrong = false;
    const Words out = meter_words(words, is_terminal, wrong);
    return wrong ? Words{"wrong"} : out;
}

TEST(Meters, TakeTheWordsThatMenusAndScriptsUse) {
    EXPECT_EQ(asked({"pin", "a.b"}), (Words{"watch", "a.b"}));
    EXPECT_EQ(asked({"-s", "sig", "x", "-g", "100", "500", "300"}), (Words{"watch", "x"}));
    EXPECT_EQ(asked({"-g", "1", "2", "param", "p", "pin", "q"}, true), (Words{"p", "q"}));
    EXPECT_EQ(asked({}, true), Words{}) << "everything, live";
    EXPECT_EQ(asked({"pin"}), Words{"wrong"});
    EXPECT_EQ(asked({"sognal", "x"}), Words{"wrong"});
}

}  // namespace
}  // namespace mw::hal::view
