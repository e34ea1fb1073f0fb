// SPDX-License-Identifier: GPL-2.0-or-later
// Number of kills in the tests of deaths.
#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

#include "base/text.hh"

namespace mw::testing {

/// Number of kills: `preset`, or MILLWRIGHT_KILLS. A value that is not a number above 0 is a failure, so that
/// a test without a kill does not pass.
inline int count_kills(int preset) {
    const char *text = std::getenv("MILLWRIGHT_KILLS");
    if (text == nullptr) {
        return preset;
    }
    const auto number = parse_int(text);
    if (!number.has_value() || *number < 1 || *number > 1000000) {
        ADD_FAILURE() << "MILLWRIGHT_KILLS=" << text << ": a number from 1 up is wanted";
        return preset;
    }
    return static_cast<int>(*number);
}

}  // namespace mw::testing
