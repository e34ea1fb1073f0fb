// SPDX-License-Identifier: GPL-2.0-or-later
// The example of docs/developer/extending/motion_command.md.
#include <fstream>
#include <sstream>
#include <variant>

#include <gtest/gtest.h>

#include "base/overloaded.hh"
#include "motion/servo/outputs/machine_outputs.hh"

namespace mw::motion::example {

// begin of the declaration
/// A command that changes a digital output to its other state.
struct FlipDigitalOutput {
    int index = 0;
};
// end of the declaration

/// The part with the new command.
class MachineOutputs : public motion::MachineOutputs {
  public:
    using motion::MachineOutputs::MachineOutputs;
    using motion::MachineOutputs::take;
    CommandResult take(const FlipDigitalOutput &command) noexcept;
};

// begin of the behaviour
CommandResult MachineOutputs::take(const FlipDigitalOutput &command) noexcept {
    if (!hasDigital(command.index)) {
        return {Reason::NO_SUCH_OUTPUT};
    }
    const bool isOn = (digital() >> command.index & 1U) != 0;
    return take(SetDigitalOutput{command.index, !isOn});
}
// end of the behaviour

namespace {

/// The body of a command with one alternative more.
template <class Variant, class More>
struct Extended;
template <class... Bodies, class More>
struct Extended<std::variant<Bodies...>, More> {
    using Body = std::variant<Bodies..., More>;
};
using Body = Extended<CommandBody, FlipDigitalOutput>::Body;

template <class Command>
concept TakenByOutputs = requires(MachineOutputs &outputs, const Command &command) {
    { outputs.take(command) } -> std::same_as<CommandResult>;
};

TEST(ExtendingMotion, TheNewCommandWorksAndRejectsAMissingOutput) {
    MachineOutputs outputs(4, 0);
    outputs.take(SetDigitalOutput{0, true});
    outputs.take(SetDigitalOutput{2, true});
    EXPECT_EQ(outputs.take(FlipDigitalOutput{3}).reason, Reason::NONE);
    EXPECT_EQ(outputs.digital(), 0b1101U);
    EXPECT_EQ(outputs.take(FlipDigitalOutput{0}).reason, Reason::NONE);
    EXPECT_EQ(outputs.digital(), 0b1100U);
    EXPECT_EQ(outputs.take(FlipDigitalOutput{4}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(outputs.take(FlipDigitalOutput{-1}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(outputs.digital(), 0b1100U) << "a rejected command changes nothing";
}

/// Tests step 3 of the page: handlers for the old commands only are not a visitor of the new variant; with
/// the line of the outputs they are.
TEST(ExtendingMotion, AVisitorThatForgetsTheNewCommandDoesNotCompile) {
    const auto others = []<class C>(const C &)
        requires(IS_ALTERNATIVE<C, CommandBody> && !TakenByOutputs<C>)
    { return CommandResult{}; };
    MachineOutputs outputs(1, 0);
    const Overloaded old{
        others, [&](const OneOf<SetDigitalOutput, SetAnalogOutput> auto &c) { return outputs.take(c); }};
    const Overloaded extended{others,
                              [&](const OneOf<SetDigitalOutput, SetAnalogOutput, FlipDigitalOutput> auto &c) {
                                  return outputs.take(c);
                              }};
    static_assert(std::is_invocable_v<decltype(old), const SetDigitalOutput &>);
    static_assert(!std::is_invocable_v<decltype(old), const FlipDigitalOutput &>);
    EXPECT_EQ(std::visit(extended, Body{FlipDigitalOutput{0}}).reason, Reason::NONE);
    EXPECT_EQ(std::visit(extended, Body{Heartbeat{}}).reason, Reason::NONE);
    EXPECT_EQ(outputs.digital(), 1U);
    static_assert(std::is_trivially_copyable_v<Body>);
}

std::string file_text(const std::string &path) {
    std::ostringstream text;
    text << std::ifstream(MW_SOURCE_DIR + path).rdbuf();
    return text.str();
}

TEST(ExtendingMotion, ThePageShowsTheCompiledCodeAndExistingLines) {
    const std::string source = file_text("/src/motion/test/parts/extending_test.cc");
    const std::string page = file_text("/docs/developer/extending/motion_command.md");
    for (const std::string what : {"declaration", "behaviour"}) {
        const std::string begin = "\n// begin of the " + what + "\n";
        const std::size_t from = source.find(begin) + begin.size();
        const std::string example = source.substr(from, source.find("// end of the " + what + "\n") - from);
        ASSERT_GT(example.size(), 80U);
        EXPECT_NE(page.find("```cpp\n" + example + "```\n"), std::string::npos) << example;
    }
    // The dispatcher contains the line that the new name is added to, as on the page.
    const std::string joined = ", FlipDigitalOutput> auto &c) { return parts.outputs.take(c); },";
    const std::size_t place = page.find(joined);
    ASSERT_NE(place, std::string::npos);
    const std::size_t line = page.rfind('\n', place) + 1 + std::string("    ").size();
    const std::string standing =
        page.substr(line, place - line) + joined.substr(std::string(", FlipDigitalOutput").size());
    EXPECT_NE(file_text("/src/motion/servo/command_dispatcher.cc").find(standing), std::string::npos)
        << standing;
}

}  // namespace
}  // namespace mw::motion::example
