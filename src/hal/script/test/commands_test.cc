// SPDX-License-Identifier: GPL-2.0-or-later
// Every command, with valid and invalid calls.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "hal/script/commands.hh"
#include "hal/script/test/session_fixture.hh"

namespace mw::hal::script {
namespace {

/// Lines and their result, or the beginning of the last line's message after its position.
struct Case {
    const char *lines;
    const char *answer;
};

constexpr Case GOOD[] = {
    {"newsig a bit\nnewsig b float\nnewsig c s32\nnewsig d u32\nnewsig e s64\nnewsig f u64\nnewsig g "
     "port\nlist sig",
     "a b c d e f g \n"},
    {"newsig a BIT\nnewsig b Float\nstype a\nstype b", "bit\nfloat\n"},
    {"newsig a s32\nsets a -0x10\ngets a", "-16\n"},
    {"newsig a bit\ndelsig a\nlist sig", "\n"},
    {"newsig a bit\nnewsig b bit\ndelsig all\nlist sig", "\n"},
    {"net s board.out => board.in0\nsave netla", "# nets\nnet s board.out => board.in0\n"},
    {"net s board.out\nnet s => board.in0 board.in1\nsave netl",
     "# nets\nnet s board.in0 board.in1 board.out\n"},
    {"net s <=> board.io\nnet s board.in0\nsave netla", "# nets\nnet s board.io <=> board.in0\n"},
    {"linkpp board.out => board.in0\nsave netla", "# nets\nnet board.out board.out => board.in0\n"},
    {"newsig s bit\nlinkps board.in0 <= s\nlinksp s => board.in1\nsave linka",
     "# links\nlinkps board.in0 <== s\nlinkps board.in1 <== s\n"},
    {"net s board.in0\nunlinkp board.in0\nsave link", "# links\n"},
    {"unlinkp board.in0", ""},
    {"setp board.in0 1\nsetp board.in1 TRUE\ngetp board.in0\ngetp board.in1", "TRUE\nTRUE\n"},
    {"setp board.word 0x10\ngetp board.word\nsetp board.word 010\ngetp board.word", "16\n8\n"},
    {"board.value = -1.5e3\ngetp board.value", "-1500\n"},
    {"setp board.gain 2\ngetp board.gain\nptype board.gain\nptype board.in0", "2\nfloat\nbit\n"},
    {"newsig s s32\nsets s -7\ngets s\nstype s", "-7\ns32\n"},
    {"net s board.in0\nsets s 1\ngetp board.in0", "TRUE\n"},
    {"alias pin board.in0 left\nalias param board.gain boost\nsetp left 1\ngetp board.in0\nsave alias",
     "TRUE\n# pin aliases\nalias pin board.in0 left\n# param aliases\nalias param board.gain boost\n"},
    {"alias pin board.in0 left\nunalias pin left\nsave alias", "# pin aliases\n# param aliases\n"},
    {"addf tool.read servo\naddf tool.write servo 1\nsave thread",
     "# realtime thread/function links\naddf tool.write servo\naddf tool.read servo\n"},
    {"addf tool.read servo -1\naddf tool.write servo -2\nshow thread",
     "Realtime Threads:\n     Period  FP     Name               (     Time, Max-Time )\n"
     "    1000000  YES                 servo (        0,        0 )\n"
     "                  1 tool.write\n                  2 tool.read\n\n"},
    {"addf tool.read servo\ndelf tool.read servo\nsave thread", "# realtime thread/function links\n"},
    {"initf tool.read servo\nsave thread", "# realtime thread/function links\ninitf tool.read servo\n"},
    {"start\nstart\nstop\nstop", ""},
    {"lock\nstatus lock",
     "HAL locking status:\n  current lock value 255 (ff)\n  HAL_LOCK_LOAD    - loading of new components is "
     "locked\n"
     "  HAL_LOCK_CONFIG  - link and addf is locked\n  HAL_LOCK_PARAMS  - setting params is locked\n"
     "  HAL_LOCK_RUN     - running/stopping HAL is locked\n"},
    {"lock tune\nsetp board.in0 1\nstart\nunlock tune\nstatus lock",
     "HAL locking status:\n  current lock value 0 (00)\n  HAL_LOCK_NONE - nothing is locked\n"},
    {"lock all\nunlock tune\nstatus lock",
     "HAL locking status:\n  current lock value 252 (fc)\n  HAL_LOCK_PARAMS  - setting params is locked\n"
     "  HAL_LOCK_RUN     - running/stopping HAL is locked\n"},
    {"lock\nlock none\nnewsig a bit\nlist sig", "a \n"},
    {"list pin *.in?", "board.in0 board.in1 \n"},
    {"list pin board.i", "board.in0 board.in1 board.io \n"},
    {"list pin -tfloat", "board.value \n"},
    {"list pin -tu32 nosuch board.*", "board.word \n"},
    {"list comp\nlist funct\nlist thread\nlist param b*",
     "__servo tool board \ntool.read tool.write \nservo \n"
     "board.gain \n"},
    {"show pin -tfloat", "Component Pins:\nOwner   Type  Dir                 Value  Name\n"
                         "     4  float IN                      0  board.value\n\n"},
    {"show alias", "Pin Aliases:\n Alias                                            Original Name\n\n"
                   "Parameter Aliases:\n Alias                                            Original Name\n\n"},
    {"newsig a bit\nnet s board.out => board.in0\nsave sig\nsave sigu\nsave net",
     "# signals\nnewsig a bit  \nnewsig s bit  \n# signals\nnewsig a bit  \n# nets\nnewsig a bit  \nnewsig s "
     "bit  \n"
     "linksp s  board.in0\nlinksp s  board.out\n"},
    {"save unconnectedinpins", "# unconnected pin values\nsetp board.in0                FALSE\n"
                               "setp board.in1                FALSE\nsetp board.value                    0\n"
                               "setp board.word           0x00000000\n"},
    {"save comp", "# components\n#loadrt tool  (not loaded by loadrt, no args saved)\n#loadrt __servo  (not "
                  "loaded by loadrt, no args saved)\n"},
    {"debug 0\ndebug 5", ""},
    {"newsig a bit\nexit\nnewsig b bit", ""},
    {"quit\nbogus", ""},
    {"setexact_for_test_suite_only", ""},
    {"unloadrt all", ""},
    {"help start", "start \nStarts the threads: they call their functions.\n"},
};

constexpr Case BAD[] = {
    {"newsig a", "newsig needs 2 arguments, 1 given"},
    {"newsig a bits", "unknown signal type 'bits'"},
    {"newsig a bit\nnewsig a float", "there is a signal 'a' already"},
    {"delsig b", "signal 'b' does not exist"},
    {"net s", "net needs at least 2 arguments, 1 given"},
    {"net s =>", "net needs at least 2 arguments, 1 given"},
    {"net s board.inn", "pin 'board.inn' does not exist (did you mean 'board.in0'?)"},
    {"net board.in0 board.out", "signal name 'board.in0' is the name of a pin (write the signal first"},
    {"net s board.out board.io",
     "signal 's' cannot have I/O pin 'board.io': another pin of the same net writes it"},
    {"net s board.in0 board.value", "pin 'board.value' is of type float, signal 's' of type bit"},
    {"net s board.in0\nnet t board.in0", "pin 'board.in0' is linked to signal 's' already"},
    {"linkpp board.out board.value", "pin 'board.value' is of type float"},
    {"linkps board.in0 s", "signal 's' does not exist"},
    {"newsig s bit\nlinksp s board.on", "pin 'board.on' does not exist"},
    {"unlinkp board", "pin 'board' does not exist"},
    {"setp board.in0", "setp needs 2 arguments, 1 given"},
    {"setp board.in0 1 2", "setp needs 2 arguments, 3 given"},
    {"setp bord.in0 1", "parameter or pin 'bord.in0' does not exist (did you mean 'board.in0'?)"},
    {"setp board.in0 maybe", "'board.in0': 'maybe' is not a value of type bit: expected TRUE, FALSE, 1 or 0"},
    {"setp board.value nan", "'board.value': 'nan' is not a value of type float"},
    {"setp board.word -1",
     "'board.word': '-1' is not a value of type u32: expected a whole number from 0 to 4294967295"},
    {"setp board.out 1", "pin 'board.out' is an output, its component sets it"},
    {"setp tool.read.tmax-increased 1", "parameter 'tool.read.tmax-increased' is read-only"},
    {"net s board.in0\nsetp board.in0 1", "pin 'board.in0' is linked to signal 's' (set the signal instead)"},
    {"board.in0=1", "unknown command 'board.in0=1' (an assignment needs blanks around '=')"},
    {"getp x", "parameter or pin 'x' does not exist"},
    {"ptype x", "parameter or pin 'x' does not exist"},
    {"gets x", "signal 'x' does not exist"},
    {"stype x", "signal 'x' does not exist"},
    {"sets x 1", "signal 'x' does not exist"},
    {"net s board.out\nsets s 1", "signal 's' is written by pin 'board.out'"},
    {"newsig s s32\nsets s 1.5", "'s': '1.5' is not a value of type s32"},
    {"newsig p port\nsets p 1", "port signal 'p': a size of 1 is outside of 2 to "},
    {"alias x board.in0 y", "'x' is neither pin nor param"},
    {"alias pin board.inn y", "there is no pin 'board.inn' (did you mean 'board.in"},
    {"alias pin board.in0 board.in1", "there is a pin 'board.in1' already"},
    {"unalias pin x", "there is no pin 'x'"},
    {"addf tool.reed servo", "function 'tool.reed' does not exist (did you mean 'tool.read'?)"},
    {"addf tool.read servp", "thread 'servp' does not exist (did you mean 'servo'?)"},
    {"addf tool.read servo 0", "'0' is not a position (1 is the first position, -1 the last)"},
    {"addf tool.read servo 7", ""},
    {"initf tool.read x", "thread 'x' does not exist"},
    {"delf tool.read servo", ""},
    {"lock some", "unknown lock type 'some' (none, tune or all)"},
    {"unlock none", "unknown lock type 'none' (tune or all)"},
    {"lock all\nnewsig a bit", "HAL is locked against new signals"},
    {"lock all\nsetp board.in0 1", "HAL is locked against setting parameters and pins"},
    {"lock all\nstart", "HAL is locked against starting threads"},
    {"lock all\naddf tool.read servo", "HAL is locked against adding functions to threads"},
    {"lock all\nloadrt and2", "HAL is locked against loading"},
    {"loadrt nosuch", "there is no module 'nosuch.so'"},
    {"loadrt", "loadrt needs at least 1 argument, 0 given"},
    {"unloadrt nosuch", "component 'nosuch' is not loaded"},
    {"unload nosuch", "component 'nosuch' is not loaded"},
    {"unloadusr __servo", "component '__servo' is not a program"},
    {"loadusr -Wq x", "unknown option '-q' of loadusr"},
    {"loadusr -W", "loadusr needs the name of a program"},
    {"waitusr", "waitusr needs 1 argument, 0 given"},
    {"show pins", "unknown 'show' type 'pins' (did you mean 'pin'?)"},
    {"show pin -tx", "'x' is not a HAL type"},
    {"list", "list needs at least 1 argument, 0 given"},
    {"list sigs", "unknown 'list' type 'sigs' (did you mean 'sig'?)"},
    {"save nett", "unknown 'save' type 'nett' (did you mean 'net'?)"},
    {"save all /nosuch/folder/file", ""},
    {"status locks", "unknown 'status' type 'locks' (lock, mem or all)"},
    {"start now", "start needs 0 arguments, 1 given"},
    {"stop now", "stop needs 0 arguments, 1 given"},
    {"source nosuch.hal", "HAL file 'nosuch.hal' not found"},
    {"debug loud", "'loud' is not a debug level (0 to 5)"},
    {"debug 6", "'6' is not a debug level"},
    {"print two words", "print needs 0 to 1 arguments, 2 given"},
    {"echo 1", "echo needs 0 arguments"},
    {"unecho 1", "unecho needs 0 arguments"},
    {"help nothing", "unknown command 'nothing'"},
    {"exit 1", "exit needs 0 arguments"},
    {"quit 1", "quit needs 0 arguments"},
    {"setexact_for_test_suite_only 1", "setexact_for_test_suite_only needs 0 arguments"},
    {"sets", "sets needs 2 arguments, 0 given"},
    {"bogus", "unknown command 'bogus'"},
    {"setq a 1", "unknown command 'setq' (did you mean 'setp'?)"},
    {"getp $(NOT_SET_ANYWHERE)", "environment variable 'NOT_SET_ANYWHERE' is not set"},
    {"getp [SEC]NAME", "'[SEC]NAME' needs an INI file, and none was given"},
    {"getp 'board.in0", "unterminated quoted string"},
};

/// A new instance for every case.
class Sandbox : public SessionTest {
  public:
    Sandbox() {
        Instance &hal = host->hal();
        const int id = *hal.components().create("tool", CompType::REALTIME);
        for (const char *name : {"tool.read", "tool.write"}) {
            EXPECT_TRUE(hal.functions().create(name, {[](void *, long) {}}, id));
        }
        EXPECT_TRUE(hal.components().set_ready(id));
        EXPECT_TRUE(hal.threads().create("servo", 1000000));
    }
    void TestBody() override {}
    using SessionTest::last_result;
    using SessionTest::run;
};

TEST(HalCommands, GoodCallsAnswer) {
    for (const Case &one : GOOD) {
        Sandbox sandbox;
        EXPECT_EQ(sandbox.run(one.lines), one.answer) << one.lines;
        EXPECT_TRUE(sandbox.last_result) << one.lines;
    }
}

TEST(HalCommands, BadCallsSayWhatIsWrongAndWhere) {
    for (const Case &one : BAD) {
        Sandbox sandbox;
        const std::string lines = one.lines;
        const auto number = std::count(lines.begin(), lines.end(), '\n') + 1;
        const std::string said = sandbox.run(lines);
        EXPECT_FALSE(sandbox.last_result) << lines;
        const std::string place = "test.hal:" + std::to_string(number) + ":";
        EXPECT_TRUE(said.starts_with(place)) << lines << " -> " << said;
        const std::size_t behind = said.find(": ");
        EXPECT_TRUE(behind != std::string::npos && said.substr(behind + 2).starts_with(one.answer))
            << lines << " -> " << said;
    }
}

TEST(HalCommands, EachHasACaseOfEachKind) {
    const auto named = [](const auto &cases) {
        std::set<std::string, std::less<>> names;
        for (const Case &one : cases) {
            std::string line;
            for (const char c : std::string(one.lines) + "\n") {
                if (c != '\n') {
                    line += c;
                    continue;
                }
                names.insert(line.substr(0, line.find(' ')));
                line.clear();
            }
        }
        return names;
    };
    const auto good = named(GOOD);
    const auto bad = named(BAD);
    // Programs, files and notes are tested with processes (src/hal/tools/programs) and in session_test.
    const std::set<std::string, std::less<>> elsewhere = {
        "loadrt", "loadusr", "waitusr", "unload", "unloadusr", "source", "echo", "unecho", "print"};
    for (const CommandSpec &spec : commands()) {
        EXPECT_TRUE(good.contains(spec.name) || elsewhere.contains(spec.name)) << spec.name;
        EXPECT_TRUE(bad.contains(spec.name)) << spec.name;
    }
}

}  // namespace
}  // namespace mw::hal::script
