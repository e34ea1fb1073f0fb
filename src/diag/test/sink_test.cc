// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "diag/sink.hh"

namespace mw::diag {
namespace {

TEST(Sink, ShowsPlaceTextAndCaret) {
    const Diagnostic d{Severity::ERROR, {"unknown word", {"a.ngc", 3, 4}, ""}, {{"main.ngc", 7, 1}}, "G1 Q5"};
    EXPECT_EQ(d.str(), "a.ngc:3:4: error: unknown word\n  G1 Q5\n     ^\n  called from main.ngc:7:1");
}

TEST(Sink, CountsErrorsOnlyAndGoesOn) {
    Sink sink;
    sink.warning("w");
    sink.error("e1");
    sink.error("e2");
    EXPECT_EQ(sink.count_errors(), 2);
    EXPECT_EQ(sink.all().size(), 3U);
}

}  // namespace
}  // namespace mw::diag
