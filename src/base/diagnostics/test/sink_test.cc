// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"

namespace mw::diagnostics {
namespace {

TEST(Sink, ShowsPlaceTextAndCaret) {
    const Diagnostic d{Severity::ERROR, {"unknown word", {"a.ngc", 3, 4}, ""}, {{"main.ngc", 7, 1}}, "G1 Q5"};
    EXPECT_EQ(d.str(), "a.ngc:3:4: error: unknown word\n  G1 Q5\n     ^\n  called from main.ngc:7:1");
}

TEST(Sink, LongLinesAreShownAroundTheColumn) {
    const std::string line = std::string(5000, 'a') + "Q" + std::string(5000, 'b');
    const Diagnostic d{Severity::ERROR, {"m", {"a.ngc", 3, 5001}, ""}, {}, line};
    const std::string text = d.context();
    EXPECT_LT(text.size(), 500U);
    const std::size_t end = text.find('\n');
    ASSERT_NE(end, std::string::npos);
    EXPECT_EQ(text.substr(end + 1).find('^'), text.find('Q'));
}

TEST(Sink, NoCharacterIsCutInHalfAndNoControlCharacterGetsOut) {
    std::string line;
    for (int i = 0; i < 300; ++i) {
        line += "\xE2\x88\x92";
    }
    for (int column = 290; column < 302; ++column) {
        const std::string text =
            Diagnostic{Severity::ERROR, {"m", {"a.ngc", 3, column}, ""}, {}, line}.context();
        const std::string shown = text.substr(0, text.find('\n'));
        EXPECT_EQ((shown.size() - shown.find('\xE2')) % 3, 0U) << "with three dots behind: " << column;
    }
    const Diagnostic d{Severity::ERROR, {"m\x1b[2J", {"a.ngc", 3, 1}, ""}, {}, "G0 (\x1b]0;x\x07)"};
    EXPECT_EQ(d.str(), "a.ngc:3:1: error: m?[2J\n  G0 (?]0;x?)\n  ^");
}

TEST(Sink, AMessageThatQuotesMegabytesIsCut) {
    const std::string megabytes(5'000'000, '[');
    const Diagnostic diagnostic{
        Severity::ERROR, {"malformed section header '" + megabytes + "'", {"a.ini", 1, 1}, {}}, {}, {}};
    EXPECT_LT(diagnostic.str().size(), 400U);
    EXPECT_EQ(diagnostic.str().substr(0, 41), "a.ini:1:1: error: malformed section heade");
}

TEST(Sink, RepeatedCallersTakeOneLine) {
    std::vector<SourcePlace> callers(400, SourcePlace{"a.ngc", 2, 0});
    callers.push_back({"a.ngc", 9, 0});
    const Diagnostic d{Severity::ERROR, {"deep", {"a.ngc", 2, 0}, ""}, callers, ""};
    EXPECT_EQ(d.str(), "a.ngc:2: error: deep\n  called from a.ngc:2, 400 times\n  called from a.ngc:9");
}

TEST(Sink, CountsErrorsOnlyAndGoesOn) {
    Sink sink;
    sink.warning("w");
    sink.error("e1");
    sink.error("e2");
    EXPECT_EQ(sink.count_errors(), 2);
    EXPECT_EQ(sink.all().size(), 3U);
}

TEST(Sink, TellsAFailureOnceOnlyWhoeverFoundIt) {
    Sink sink;
    const auto find = [&sink]() -> Result<> {
        sink.error("bad line", {"a.hal", 3, 0});
        return fail_told("a.hal has errors");
    };
    sink.failure(find().error());
    EXPECT_EQ(sink.count_errors(), 1);
    EXPECT_EQ(find().error().str(), "a.hal has errors") << "the summary still names the file";
    sink.failure(Error{"not told"});
    EXPECT_EQ(sink.all().back().what.str(), "not told");
    EXPECT_EQ(sink.count_errors(), 3);
}

}  // namespace
}  // namespace mw::diagnostics
