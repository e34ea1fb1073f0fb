// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes without an interpreter: rows, running procedures, and the words that they receive.
#include <gtest/gtest.h>

#include "gcode/interpreter/codes/remaps.hh"

namespace mw::gcode::detail {
namespace {

const std::vector<RemapLine> LINES = {"M400 modalgroup=5 argspec=Pq ngc=rm400", "M6 py=change",
                                      "G88.1 ngc=g881"};

Remaps loaded() {
    Remaps remaps;
    const Result<> done = remaps.load(LINES);
    EXPECT_TRUE(done) << done.error().message;
    return remaps;
}

PendingBlock block_with(const Remap &remap, std::string_view letters, double first) {
    static Fault fault;
    PendingBlock block{&remap, BlockValues(fault), 0, {}, 0, -1};
    block.line = 12;
    for (const char c : letters) {
        block.values.present |= bit_of(BlockValues::index(c));
        block.values.value[static_cast<std::size_t>(BlockValues::index(c))] = first++;
    }
    return block;
}

TEST(Remaps, FindsTheRowsOfItsLinesAndNoOthers) {
    const Remaps remaps = loaded();
    const Code *const code = remaps.find(M(400));
    ASSERT_NE(code, nullptr);
    EXPECT_EQ(code->remap, &remaps.all()[0]);
    EXPECT_EQ(code->remap->name, "M400");
    EXPECT_NE(remaps.find(G(88, 1)), nullptr);
    EXPECT_EQ(remaps.find(G(88)), nullptr);
    EXPECT_EQ(remaps.find(G(40)), nullptr);
    EXPECT_EQ(remaps.find(M(3)), nullptr);
}

TEST(Remaps, RefusesTwoLinesForOneCodeAndTellsOfThoseWithoutEffect) {
    Remaps twice;
    const std::vector<RemapLine> same = {"M400 ngc=a", "M400 ngc=b"};
    const Result<> done = twice.load(same);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("M400 is remapped twice"), std::string::npos);
    Remaps fixed;
    const std::vector<RemapLine> lines = {"G1 ngc=mine", "M401 ngc=b"};
    ASSERT_TRUE(fixed.load(lines));
    ASSERT_EQ(fixed.refused().size(), 1u);
    EXPECT_NE(fixed.refused()[0].find("G1 cannot be remapped"), std::string::npos);
    EXPECT_EQ(fixed.find(G(1)), nullptr);
    EXPECT_NE(fixed.find(M(401)), nullptr);
}

TEST(Remaps, ACodeHasItsOwnMeaningInItsProcedure) {
    Remaps remaps = loaded();
    const Remap &change = *remaps.find(M(6))->remap;
    remaps.begin(change, 1);
    EXPECT_EQ(remaps.find(M(6)), nullptr);
    EXPECT_NE(remaps.find(M(400)), nullptr) << "others keep the meaning that their lines give";
    EXPECT_NE(remaps.recursion_text(M(6)), "");
    EXPECT_EQ(remaps.recursion_text(M(400)), "");
    remaps.begin(*remaps.find(M(400))->remap, 2);
    remaps.count_builtin(M(6));
    remaps.count_builtin(M(6));
    EXPECT_EQ(remaps.builtin_uses(1), 2);
    EXPECT_EQ(remaps.builtin_uses(2), 0);
    EXPECT_EQ(remaps.count_running(), 2);
}

TEST(Remaps, ProceduresEndWithTheirLevelsOfCall) {
    Remaps remaps = loaded();
    remaps.begin(remaps.all()[0], 1);
    remaps.begin(remaps.all()[1], 4);  // levels 2 and 3 are plain subroutines
    remaps.end_above(4);
    EXPECT_EQ(remaps.count_running(), 2);
    remaps.end_above(3);
    EXPECT_EQ(remaps.count_running(), 1);
    EXPECT_NE(remaps.find(M(6)), nullptr);
    EXPECT_EQ(remaps.find(M(400)), nullptr);
    remaps.end_above(0);
    EXPECT_FALSE(remaps.isAnyRunning());
}

TEST(Remaps, NamesTheWordsThatAreMissing) {
    Remaps remaps;
    const std::vector<RemapLine> lines = {"M400 argspec=PXq>^ ngc=rm400"};
    ASSERT_TRUE(remaps.load(lines));
    State state;
    EXPECT_EQ(missing_words(block_with(remaps.all()[0], "x", 1), state), "P,F>0,S>0");
    state.feed = 1;
    state.spindles[0].speed = 1;
    EXPECT_EQ(missing_words(block_with(remaps.all()[0], "xp", 1), state), "");
}

TEST(Remaps, WordsBecomeLocalNames) {
    Remaps remaps;
    const std::vector<RemapLine> lines = {"M400 argspec=Pqn ngc=rm400"};
    ASSERT_TRUE(remaps.load(lines));
    Parameters parameters;
    Names names;
    parameters.push_call();
    parameters.set(1, 7);
    pass_words(block_with(remaps.all()[0], "p", 3.5), true, parameters, names);
    EXPECT_EQ(parameters.named(names.intern("p"), false), 3.5);
    EXPECT_EQ(parameters.named(names.intern("q"), false), std::nullopt);
    EXPECT_EQ(parameters.named(names.intern("n"), false), 12);
    EXPECT_EQ(parameters.named(names.intern("n_args"), false), std::nullopt) << "only of numbered arguments";
    EXPECT_EQ(parameters.get(1), 0) << "no argument of the caller is seen";
}

TEST(Remaps, WordsBecomeNumbersInTheOrderOfTheArgspec) {
    Remaps remaps;
    const std::vector<RemapLine> lines = {"M400 argspec=@qpx ngc=rm400"};
    ASSERT_TRUE(remaps.load(lines));
    Parameters parameters;
    Names names;
    parameters.push_call();
    pass_words(block_with(remaps.all()[0], "pq", 3), true, parameters, names);
    EXPECT_EQ(parameters.get(1), 4);  // Q
    EXPECT_EQ(parameters.get(2), 3);  // P
    EXPECT_EQ(parameters.get(3), 0);
    EXPECT_EQ(parameters.named(names.intern("n_args"), false), 2);
}

TEST(Remaps, TheInterruptedBlockIsTakenOnce) {
    Remaps remaps = loaded();
    PendingBlock block = block_with(remaps.all()[0], "p", 1);
    block.next = 2;
    block.comment = "why";
    remaps.interrupt(block);
    const PendingBlock taken = remaps.take_interrupted();
    EXPECT_EQ(taken.remap, &remaps.all()[0]);
    EXPECT_EQ(taken.next, 2u);
    EXPECT_EQ(taken.comment, "why");
    EXPECT_EQ(taken.values.at('p'), 1);
}

}  // namespace
}  // namespace mw::gcode::detail
