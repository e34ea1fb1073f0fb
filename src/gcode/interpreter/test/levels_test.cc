// SPDX-License-Identifier: GPL-2.0-or-later
// Call levels, their programs, and the search for subroutines; without an executor.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "gcode/interpreter/flow/sub_search.hh"

namespace mw::gcode::detail {
namespace {

class LevelsTest : public ::testing::Test {
  protected:
    LevelsTest() {
        static int count = 0;
        folder = std::filesystem::temp_directory_path() /
                 ("mw_levels_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(folder / "path");
    }
    ~LevelsTest() override { std::filesystem::remove_all(folder); }

    Program *program(const std::string &name, const std::string &text) {
        return files.keep(std::make_unique<Program>((folder / name).string(), text, names));
    }
    void write(const std::string &name, const std::string &text) { std::ofstream(folder / name) << text; }
    Call call(CallKind kind, const std::string &label) {
        Call out;
        out.kind = kind;
        out.label = names.intern(label);
        return out;
    }
    SubSearch search() { return {levels, files, names, path, fault}; }

    std::filesystem::path folder;
    Names names;
    ProgramFiles files;
    Levels levels;
    Fault fault;
    std::vector<std::string> path;
};

TEST_F(LevelsTest, ACallComesBackToTheLineBehindIt) {
    Program *const main = program("main.ngc", "1\n2\n3\n");
    Program *const sub = program("sub.ngc", "a\nb\n");
    levels.open(main);
    Place &here = levels.here();
    here.line = 2;
    here.next = 9;  // any target of a jump in the block
    here.repeats = {{1, 5}};
    levels.enter(call(CallKind::OWORD, "sub"));
    EXPECT_TRUE(here.repeats.empty()) << "the caller's loops are not the subroutine's";
    here.program = sub;
    here.next = 1;
    EXPECT_EQ(levels.call_level(), 1);
    EXPECT_EQ(levels.main(), main);
    EXPECT_EQ(levels.main_line(), 2);
    EXPECT_EQ(names.text(levels.subroutine()), "sub");
    const Call left = levels.leave();
    EXPECT_EQ(left.line, 2);
    EXPECT_EQ(here.program, main);
    EXPECT_EQ(here.next, 3);
    ASSERT_EQ(here.repeats.size(), 1u);
    EXPECT_EQ(here.repeats[0].left, 5);
    EXPECT_EQ(levels.subroutine(), NO_ID);
}

TEST_F(LevelsTest, TheTextOfAScriptIsNoLevelOfItsOwn) {
    Program *const main = program("main.ngc", "1\n2\n3\n");
    levels.open(main);
    levels.here().line = 1;
    levels.here().next = 3;  // a script may run after a jump
    levels.enter_text(files.keep_script_text("G0 X1", names), 12);
    EXPECT_EQ(levels.size(), 1u);
    EXPECT_EQ(levels.call_level(), 0);
    EXPECT_TRUE(levels.isTextRunning());
    EXPECT_EQ(levels.top().reported_line, 12);
    levels.leave();
    EXPECT_FALSE(levels.isTextRunning());
    EXPECT_EQ(levels.here().next, 3);
    levels.enter_text(files.keep_script_text("G0 X1", names), 0);
    EXPECT_EQ(levels.top().reported_line, 1) << "the line where the script was called";
}

TEST_F(LevelsTest, UnwindingGoesBackToALevelAndGivesWhatItDrops) {
    Program *const main = program("main.ngc", "1\n2\n3\n4\n");
    levels.open(main);
    for (int i = 1; i <= 3; ++i) {
        levels.here().line = i;
        levels.here().next = i + 1;
        levels.enter(call(CallKind::OWORD, "s" + std::to_string(i)));
    }
    levels.enter_text(files.keep_script_text("", names), 1);
    const std::vector<Call> dropped = levels.unwind(1);
    ASSERT_EQ(dropped.size(), 3u);
    EXPECT_EQ(names.text(dropped[0].label), "s2");
    EXPECT_EQ(levels.size(), 1u);
    EXPECT_EQ(levels.call_level(), 1);
    EXPECT_EQ(levels.here().next, 3) << "behind the call that was dropped";
    EXPECT_TRUE(levels.unwind(1).empty());
}

TEST_F(LevelsTest, MdiStandsAboveTheOpenFile) {
    Program *const main = program("main.ngc", "1\n2\n3\n");
    levels.open(main);
    levels.here().next = 2;
    levels.begin_mdi(files.keep_mdi("G0 X1", names));
    EXPECT_TRUE(levels.isMdi());
    EXPECT_EQ(levels.file(), "MDI");
    levels.here().next = 2;
    EXPECT_TRUE(levels.here().isAtEnd());
    levels.end_mdi();
    EXPECT_EQ(levels.here().program, main);
    EXPECT_EQ(levels.here().next, 2);
    levels.end_mdi();
    EXPECT_EQ(levels.here().next, 2) << "once is enough";
}

TEST_F(LevelsTest, NamesCallersAndTheLineForMessages) {
    EXPECT_EQ(levels.file(), "");
    EXPECT_EQ(levels.line_text(), "");
    levels.open(program("main.ngc", "one\ntwo\n"));
    levels.here().line = 2;
    EXPECT_EQ(levels.line_text(), "two");
    levels.enter(call(CallKind::OWORD, "a"));
    levels.here().line = 1;
    levels.enter(call(CallKind::OWORD, "b"));
    const std::vector<SourcePlace> callers = levels.callers();
    ASSERT_EQ(callers.size(), 2u);
    EXPECT_EQ(callers[0].line, 1);
    EXPECT_EQ(callers[1].line, 2);
}

TEST_F(LevelsTest, SubroutinesAreLookedForInnermostFileFirst) {
    Program *const main = program("main.ngc", "o<a> sub\no<a> endsub\no<b> sub\no<b> endsub\n");
    Program *const inner = program("inner.ngc", "\no<a> sub\no<a> endsub\n");
    levels.open(main);
    levels.here().line = 5;
    levels.enter(call(CallKind::OWORD, "inner"));
    levels.here().program = inner;
    Sub sub;
    ASSERT_TRUE(find_sub(names.intern("a"), 1, search(), sub));
    EXPECT_EQ(sub.program, inner);
    EXPECT_EQ(sub.line, 2);
    ASSERT_TRUE(find_sub(names.intern("b"), 1, search(), sub));
    EXPECT_EQ(sub.program, main) << "in those that have called it";
    EXPECT_EQ(sub.line, 3);
}

TEST_F(LevelsTest, FilesOfTheirOwnStandBesideTheMainProgramThenInThePath) {
    write("path/tool.ngc", "o<tool> sub\no<tool> endsub\n");
    write("path/near.ngc", "o<near> sub\no<near> endsub\n");
    write("near.ngc", "\no<near> sub\no<near> endsub\n");
    path = {(folder / "path").string()};
    levels.open(program("main.ngc", "G0\n"));
    Sub sub;
    ASSERT_TRUE(find_sub(names.intern("near"), 1, search(), sub));
    EXPECT_EQ(sub.line, 2);
    ASSERT_TRUE(find_sub(names.intern("tool"), 1, search(), sub));
    Program *const first = sub.program;
    std::filesystem::remove(folder / "path/tool.ngc");
    ASSERT_TRUE(find_sub(names.intern("tool"), 1, search(), sub)) << "read once";
    EXPECT_EQ(sub.program, first);
    EXPECT_EQ(files.line_text(first->path(), 1), "o<tool> sub");
    EXPECT_EQ(files.line_text(first->path(), 9), "");
    EXPECT_EQ(files.line_text("elsewhere", 1), "");
    // A line of MDI has no folder.
    write("mine.ngc", "o<mine> sub\no<mine> endsub\n");
    levels.begin_mdi(files.keep_mdi("o<mine> call", names));
    EXPECT_FALSE(find_sub(names.intern("mine"), 1, search(), sub));
}

TEST_F(LevelsTest, ASubroutineThatIsNotThereIsNamedAndMayEndTheProgram) {
    Sub sub;
    levels.open(program("main.ngc", "%\nG0\n%\n"));
    EXPECT_FALSE(find_sub(names.intern("gone"), 7, search(), sub));
    EXPECT_NE(fault.message.find("o<gone>"), std::string::npos);
    EXPECT_EQ(fault.column, 7u);
    EXPECT_TRUE(fault.program_ended) << "the search has come to the closing percent sign";
    fault.clear();
    levels.open(program("open.ngc", "G0\n"));
    EXPECT_FALSE(find_sub(names.intern("gone"), 7, search(), sub));
    EXPECT_FALSE(fault.program_ended);
}

TEST_F(LevelsTest, EachKindOfSubroutineHasItsOwnCall) {
    levels.open(program("main.ngc", "o5 sub\no5 endsub\nO7\nM99\n"));
    levels.here().line = 9;
    Sub sub;
    EXPECT_TRUE(find_sub(names.intern("5"), 1, search(), sub));
    EXPECT_TRUE(find_fanuc_sub(names.intern("7"), search(), sub));
    EXPECT_EQ(sub.line, 3);
    EXPECT_FALSE(find_sub(names.intern("7"), 1, search(), sub));
    EXPECT_EQ(fault.message, FANUC_TEXT);
    EXPECT_EQ(fault.line, 3);
    EXPECT_EQ(fault.hint, "subroutine O7, called in line 9");
    fault.clear();
    EXPECT_FALSE(find_fanuc_sub(names.intern("5"), search(), sub));
    EXPECT_EQ(fault.message, OWORD_TEXT);
    EXPECT_EQ(fault.line, 1);
}

}  // namespace
}  // namespace mw::gcode::detail
