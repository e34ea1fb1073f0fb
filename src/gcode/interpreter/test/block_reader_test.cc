// SPDX-License-Identifier: GPL-2.0-or-later
// Values of parsed blocks, without execution.
#include <memory>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/block_reader.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

class NoBuiltIns final : public BuiltIns {
  public:
    bool isBuiltInName(std::string_view) const override { return false; }
    std::optional<double> built_in(std::string_view) const override { return std::nullopt; }
    double built_in(int) const override { return 0; }
};

class BlockReaderTest : public testing::Test {
  protected:
    bool read(const std::string &line) {
        program = std::make_unique<Program>("a.ngc", line + "\n", names);
        values.clear();
        return read_words(program->block(1), {evaluator, remaps}, values);
    }
    /// The codes in the order of execution.
    std::vector<GCode> codes() const {
        std::vector<GCode> out;
        for (const ActiveCode &active : values.codes) {
            out.push_back(active.code->id);
        }
        return out;
    }

    Names names;
    Parameters parameters;
    NoBuiltIns built_ins;
    Fault fault;
    Evaluator evaluator{parameters, names, built_ins, fault};
    Remaps remaps;
    std::unique_ptr<Program> program;
    BlockValues values{fault};
};

TEST_F(BlockReaderTest, WordsAreComputed) {
    parameters.set(7, 2.5);
    ASSERT_TRUE(read("G1 X[#7 * 2] Y3"));
    EXPECT_EQ(values.at('x'), 5);
    EXPECT_EQ(values.at('y'), 3);
    EXPECT_FALSE(values.has('z'));
}

TEST_F(BlockReaderTest, CodesStandInTheOrderOfExecution) {
    ASSERT_TRUE(read("M0 G1 X1 M3 F100 G21"));
    EXPECT_EQ(codes(), (std::vector<GCode>{WORD_F, M(3), G(21), G(1), M(0)}));
    EXPECT_EQ(values.motion, find_code(G(1)));
}

TEST_F(BlockReaderTest, TwoCodesOfOneGroupAreRefused) {
    EXPECT_FALSE(read("G1 G2 X1"));
    EXPECT_EQ(fault.message, "Two g codes used from same modal group");
    EXPECT_EQ(fault.column, 4U);
}

TEST_F(BlockReaderTest, UnknownCodesAreRefused) {
    EXPECT_FALSE(read("G77"));
    EXPECT_FALSE(read("M200"));
    EXPECT_EQ(fault.message, "M-code greater than 199: M200");
}

TEST_F(BlockReaderTest, AxisWordsAloneMeanTheMotionInForce) {
    ASSERT_TRUE(read("X1"));
    EXPECT_FALSE(choose_motion(values, MOTION_NONE, remaps));
    ASSERT_TRUE(choose_motion(values, G(1), remaps));
    EXPECT_TRUE(values.motion_implied);
    EXPECT_EQ(codes(), (std::vector<GCode>{G(1)}));
}

TEST_F(BlockReaderTest, AxisWordsOfAnotherCodeAreNoMotion) {
    ASSERT_TRUE(read("G92 X1"));
    ASSERT_TRUE(choose_motion(values, G(1), remaps));
    EXPECT_EQ(codes(), (std::vector<GCode>{G(92)}));
}

TEST_F(BlockReaderTest, WordsThatNoCodeUsesAndWordsThatAreMissingAreNamed) {
    ASSERT_TRUE(read("G4 P1 Q2"));
    EXPECT_FALSE(check_words(values));
    EXPECT_EQ(fault.message, "Q word with no g code that uses it");
    ASSERT_TRUE(read("M62"));
    EXPECT_FALSE(check_words(values));
    EXPECT_EQ(fault.message, "m62 needs the word P");
}

TEST_F(BlockReaderTest, AxesThatTheMachineLacksAreRefusedAlsoAfterItChanges) {
    constexpr unsigned XYZ = 7, XYZA = 15;
    AxisCheck axes;
    ASSERT_TRUE(read("G0 A1"));
    EXPECT_FALSE(axes.check(values, XYZ));
    EXPECT_EQ(fault.message, "Bad character 'a' used");
    EXPECT_TRUE(axes.check(values, XYZA));
    EXPECT_FALSE(axes.check(values, XYZ));
}

TEST_F(BlockReaderTest, ParametersAreSetAllAtOnce) {
    BlockSettings settings;
    parameters.set(1, 5);
    ASSERT_TRUE(read("#1=7 #2=#1 #<size>=3"));
    ASSERT_TRUE(settings.apply(program->block(1), evaluator, names, parameters, fault));
    EXPECT_EQ(parameters.get(1), 7);
    EXPECT_EQ(parameters.get(2), 5);
    EXPECT_EQ(evaluator.named(names.intern("size")), 3);
    ASSERT_TRUE(read("#3=1 #5420=2"));
    EXPECT_FALSE(settings.apply(program->block(1), evaluator, names, parameters, fault));
    EXPECT_EQ(fault.message, "Parameter is readonly: #5420");
    EXPECT_EQ(parameters.get(3), 0);
}

}  // namespace
}  // namespace mw::gcode::detail
