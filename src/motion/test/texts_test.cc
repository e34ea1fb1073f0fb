// SPDX-License-Identifier: GPL-2.0-or-later
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "motion/interface/texts.hh"

namespace mw::motion {
namespace {

TEST(Texts, EveryReasonAndFaultHasItsOwnText) {
    std::set<std::string> seen;
    for (int r = 1; r < static_cast<int>(Reason::COUNT); ++r) {
        Answer a;
        a.reason = static_cast<Reason>(r);
        a.index = 1;
        const std::string text = reason_text(a);
        EXPECT_FALSE(text.empty());
        EXPECT_TRUE(seen.insert(text).second) << text;
    }
    for (int k = 0; k < static_cast<int>(FaultKind::COUNT); ++k) {
        Fault f;
        f.kind = static_cast<FaultKind>(k);
        f.index = 0;
        EXPECT_TRUE(seen.insert(fault_text(f)).second) << fault_text(f);
    }
    Fault limit;
    limit.kind = FaultKind::HARD_LIMIT;
    limit.index = 0;
    EXPECT_EQ(fault_text(limit), "joint 0 on limit switch error");
    for (const int line : {1, 2, 1000}) {
        limit.source.line = line;
        EXPECT_EQ(fault_text(limit), "joint 0 on limit switch error (line " + std::to_string(line) + ")");
    }
}

TEST(Texts, ARejectionNamesTheJointOrAxisIfKnown) {
    Answer a;
    a.reason = Reason::INDEXER_ALONE;
    const auto has = [&](const char *name) {
        return reason_text(a).starts_with(std::string(name) + " is a");
    };
    for (const bool isPath : {false, true}) {
        a.isPath = isPath;
        a.index = -1;
        EXPECT_TRUE(has("a joint or axis")) << reason_text(a);
        a.index = 2;
        EXPECT_TRUE(has(isPath ? "axis Z" : "joint or axis 2")) << reason_text(a);
    }
}

}  // namespace
}  // namespace mw::motion
