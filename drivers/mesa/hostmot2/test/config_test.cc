// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {
namespace {

std::string error_of(const std::string &text) {
    const auto config = parse_config(text);
    return config ? "" : config.error().message;
}

TEST(ConfigString, HasCountsModesAndSwitches) {
    const auto config = parse_config(
        " num_encoders=1 num_stepgens=3  sserial_port_0=01xX firmware=hm2/5i20/SVST8_4.BIT enable_raw ");
    ASSERT_TRUE(config.has_value()) << config.error().str();
    EXPECT_EQ(config->wanted_of(Gtag::ENCODER), 1);
    EXPECT_EQ(config->wanted_of(Gtag::MUXED_ENCODER), 1);
    EXPECT_EQ(config->wanted_of(Gtag::STEPGEN), 3);
    EXPECT_EQ(config->wanted_of(Gtag::PWM), ALL_INSTANCES);
    EXPECT_EQ(config->sserial_modes[0], "01xx");
    EXPECT_EQ(config->firmware, "hm2/5i20/SVST8_4.BIT");
    EXPECT_TRUE(config->raw_enabled);
}

TEST(ConfigString, MayBeEmpty) {
    const auto config = parse_config("");
    ASSERT_TRUE(config.has_value());
    EXPECT_EQ(config->wanted_of(Gtag::STEPGEN), ALL_INSTANCES);
    EXPECT_FALSE(config->raw_enabled);
}

TEST(ConfigString, NamesAnUnknownTokenAndTheNearestOne) {
    EXPECT_EQ(error_of("num_encoder=1"), "config: unknown token num_encoder. Did you mean num_encoders?");
    EXPECT_EQ(error_of("numstepgens=1"), "config: unknown token numstepgens. Did you mean num_stepgens?");
    EXPECT_EQ(error_of("sserial_port_7=0"),
              "config: unknown token sserial_port_7. Did you mean sserial_port_N?");
}

TEST(ConfigString, RefusesValuesThatAreNotNumbersOrModes) {
    EXPECT_NE(error_of("num_encoders=two").find("num_encoders=two"), std::string::npos);
    EXPECT_NE(error_of("num_encoders=-2").find("num_encoders=-2"), std::string::npos);
    EXPECT_NE(error_of("num_encoders=").find("num_encoders="), std::string::npos);
    EXPECT_NE(error_of("sserial_port_0=0123456789").find("sserial_port_0"), std::string::npos);
    EXPECT_NE(error_of("sserial_port_0=0y").find("sserial_port_0"), std::string::npos);
    EXPECT_NE(error_of("stepgen_width=9").find("1 to 8"), std::string::npos);
}

Result<Assignment> assigned(const std::string &config) {
    return assign(firmware(), parse_config(config).value(), 4);
}

int general_pins(const Assignment &assignment) {
    int count = 0;
    for (const UsedPin &pin : assignment.pins) {
        count += pin.isGeneral() ? 1 : 0;
    }
    return count;
}

TEST(AssignmentOfModules, UsesAllInstancesAndThePinsOfThem) {
    const auto assignment = assigned("");
    ASSERT_TRUE(assignment.has_value());
    EXPECT_EQ(general_pins(*assignment), 51 - 10 - 3);
    EXPECT_TRUE(assignment->warnings.empty());
}

TEST(AssignmentOfModules, ReleasesThePinsOfInstancesThatAreNotUsed) {
    const auto assignment = assigned("num_stepgens=3 num_encoders=0");
    ASSERT_TRUE(assignment.has_value());
    EXPECT_EQ(general_pins(*assignment), 51 - 6);
    EXPECT_EQ(assignment->pins[5].module, Gtag::STEPGEN);
    EXPECT_TRUE(assignment->pins[6].isGeneral());
    EXPECT_TRUE(assignment->pins[14].isGeneral());
}

TEST(AssignmentOfModules, LimitsThePinsOfAStepGenerator) {
    const auto assignment = assigned("stepgen_width=1");
    ASSERT_TRUE(assignment.has_value());
    EXPECT_TRUE(assignment->pins[0].isGeneral()) << "direction";
    EXPECT_EQ(assignment->pins[1].module, Gtag::STEPGEN) << "step";
}

TEST(AssignmentOfModules, NamesTheNumberThatThereIs) {
    const auto more = assigned("num_stepgens=6");
    ASSERT_FALSE(more.has_value());
    EXPECT_EQ(more.error().message,
              "config: num_stepgens=6, but this firmware has 5. Use a number from 0 to 5, or -1 for all.");
    const auto none = assigned("num_ssrs=1");
    ASSERT_FALSE(none.has_value());
    EXPECT_EQ(none.error().message, "config: num_ssrs=1, but this firmware has 0.");
    EXPECT_TRUE(assigned("num_ssrs=0").has_value());
}

TEST(AssignmentOfModules, LeavesOutUnknownModulesAndVersionsWithAWarning) {
    Idrom idrom = firmware();
    ModuleDescriptor unknown;
    unknown.gtag = static_cast<Gtag>(77);
    unknown.version = 3;
    unknown.instances = 1;
    unknown.base_address = 0x6100;
    idrom.modules.push_back(unknown);
    idrom.modules[3].version = 9;
    idrom.modules.push_back({Gtag::IRQ, 5, false, 1, 0x0A00, 1, 0, 0, 0});
    const auto assignment = assign(idrom, {}, 4);
    ASSERT_TRUE(assignment.has_value());
    ASSERT_EQ(assignment->warnings.size(), 2U);
    EXPECT_EQ(
        assignment->warnings[0],
        "Module StepGen (gtag 5) version 9 at 0x2000 is not supported and not used. Its pins are GPIO.");
    EXPECT_EQ(
        assignment->warnings[1],
        "Module unknown (gtag 77) version 3 at 0x6100 is not supported and not used. Its pins are GPIO.");
    EXPECT_TRUE(assignment->pins[0].isGeneral());
}

}  // namespace
}  // namespace mw::mesa::test
