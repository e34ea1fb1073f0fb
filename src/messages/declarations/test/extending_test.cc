// SPDX-License-Identifier: GPL-2.0-or-later
// The example of docs/developer/extending/message.md.

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "messages/declarations/binary.hh"
#include "messages/declarations/check.hh"
#include "messages/declarations/json.hh"
#include "messages/declarations/text.hh"

namespace mw::messages {

// clang-format off
// begin of the example
struct SetGenericOutput {
    int index = 0;
    double value = 0;
};
template <>
inline constexpr auto DECLARED<SetGenericOutput> =
    declare("SetGenericOutput", 1605, "sets a generic output",
            field<&SetGenericOutput::index>("index", "number of the output", unit::NONE, range(0, 15)),
            field<&SetGenericOutput::value>("value", "of the output"));
// end of the example
// clang-format on

namespace {

TEST(ExtendingMessages, OneDeclarationGivesCodecsCheckAndText) {
    const SetGenericOutput command{3, 1.5};
    EXPECT_EQ(to_json(object(command)), R"({"message":"SetGenericOutput","index":3,"value":1.5})");
    EXPECT_EQ(to_text(object(command)), "SetGenericOutput index=3 value=1.5");
    std::string bytes;
    encode(object(command), bytes);
    SetGenericOutput from_bytes, read;
    ASSERT_TRUE(decode(bytes, object(from_bytes)).has_value());
    EXPECT_EQ(from_bytes.value, 1.5);
    ASSERT_TRUE(
        from_json(R"({"message":"SetGenericOutput","index":7,"value":-2})", object(read)).has_value());
    EXPECT_EQ(read.index, 7);
    read.index = 16;
    EXPECT_EQ(check(object(static_cast<const SetGenericOutput &>(read))).error().message,
              "SetGenericOutput: index is 16, allowed is 0 to 15");
}

TEST(ExtendingMessages, ThePageShowsWhatIsCompiledHere) {
    const std::string source =
        read_file(MW_SOURCE_DIR "/src/messages/declarations/test/extending_test.cc").value();
    const std::string begin = "// begin of the example\n";
    const std::size_t from = source.find('\n' + begin) + 1 + begin.size();
    const std::string example = source.substr(from, source.find("// end of the example\n") - from);
    ASSERT_GT(example.size(), 200U);
    EXPECT_NE(read_file(MW_SOURCE_DIR "/docs/developer/extending/message.md").value().find(example),
              std::string::npos);
}

}  // namespace
}  // namespace mw::messages
