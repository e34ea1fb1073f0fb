// SPDX-License-Identifier: GPL-2.0-or-later
// The prologs and epilogs of python/stdglue.py.
#include "scripted.hh"

namespace mw::python_host::test {
namespace {

using Events = std::vector<std::string>;

/// T and M6 as procedures that record their arguments.
void add_changer(Scripted &it, const std::string &change_body, const std::string &prepare_body = "") {
    it.remap("T prolog=prepare_prolog ngc=prepare epilog=prepare_epilog");
    it.remap("M6 modalgroup=6 prolog=change_prolog ngc=change epilog=change_epilog");
    it.handlers("");
    it.write("prepare.ngc", "o<prepare> sub\n(debug,prepare %d#<tool> #<pocket>)\n" + prepare_body +
                                "o<prepare> endsub [1]\n");
    it.write("change.ngc",
             "o<change> sub\n(debug,change %d#<tool_in_spindle> #<selected_tool> #<selected_pocket>)\n" +
                 change_body);
}

TEST(Stdglue, ToolChangeInProgramOrder) {
    Scripted it;
    add_changer(it, "G0 X5\no<change> endsub [1]\n");
    ASSERT_EQ(it.run("T2 M6\n(debug,tool %d#5400 z %.1f#5403)\nG0 X6\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(), (Events{"MESSAGE(\"prepare 2 2\")", "SELECT_TOOL(2)", "MESSAGE(\"change 0 2 2\")",
                                  "STRAIGHT_TRAVERSE(5.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
                                  "CHANGE_TOOL()", "SYNC", "MESSAGE(\"tool 2 z 0.1\")",
                                  "STRAIGHT_TRAVERSE(6.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
    ASSERT_EQ(it.run("M6\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "M6: no tool prepared");
}

TEST(Stdglue, OwnMeaningInsideTheProcedureIsEnough) {
    Scripted it;
    add_changer(it, "M6\no<change> endsub [1]\n", "T#<tool>\n");
    ASSERT_EQ(it.run("T3 M6\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(), (Events{"MESSAGE(\"prepare 3 3\")", "SELECT_TOOL(3)", "MESSAGE(\"change 0 3 3\")",
                                  "STOP_SPINDLE_TURNING(0)", "CHANGE_TOOL()", "SYNC", "SYNC"}));
}

TEST(Stdglue, ProceduresThatDoNotAgreeAbort) {
    Scripted it;
    add_changer(it, "o<change> endsub [-2]\n");
    ASSERT_EQ(it.run("T1 M6\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "M6: aborted (return code -2.0)");
    ASSERT_EQ(it.run("T77\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "T77: tool 77 is not in the tool table");
    ASSERT_EQ(it.run("#5600=1 #5601=-3\nM6\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "M6: the tool changer reports fault -3");
}

TEST(Stdglue, SpeedFeedAndToolNumber) {
    Scripted it;
    it.remap("S prolog=setspeed_prolog ngc=speed epilog=setspeed_epilog");
    it.remap("F prolog=setfeed_prolog ngc=feed epilog=setfeed_epilog");
    it.remap("M61 prolog=settool_prolog ngc=settool epilog=settool_epilog");
    it.handlers("");
    it.write("speed.ngc", "o<speed> sub\n#<speed> = [#<speed> * 2]\no<speed> endsub [1]\n");
    it.write("feed.ngc", "o<feed> sub\nF[#<feed> / 2]\no<feed> endsub [1]\n");
    it.write("settool.ngc", "o<settool> sub\no<settool> endsub [1]\n");
    ASSERT_EQ(it.run("S100 F50\nM61 Q2\nG1 X1\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(),
              (Events{"SET_FEED_RATE(25.0000)", "SET_SPINDLE_SPEED(0, 200.0000)", "CHANGE_TOOL_NUMBER(2)",
                      "SYNC", "STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
}

TEST(Stdglue, CycleKeepsDepthAndRUntilG80) {
    Scripted it;
    it.remap("G84.3 modalgroup=1 argspec=xyzabcuvwqplr prolog=cycle_prolog ngc=g843 epilog=cycle_epilog");
    it.handlers("");
    it.write("toplevel.py",
             "import remap, oword, stdglue\ndef __init__(self):\n    stdglue.init_stdglue(self)\n");
    it.write("g843.ngc", "o<g843> sub\n(debug,%d#<x> #<y> #<z> #<r> #<p>)\no<g843> endsub\n");
    ASSERT_EQ(it.run("F100\nG84.3 X1 Y2 Z3 R1\nX3 Y4 P2\nX6 Y7 Z5\nG80\nG84.3 X1 Z2 R4\nG80\n"),
              Step::PROGRAM_END)
        << it.error();
    Events messages;
    for (const std::string &event : it.story()) {
        if (event.starts_with("MESSAGE")) {
            messages.push_back(event);
        }
    }
    EXPECT_EQ(messages, (Events{"MESSAGE(\"1 2 3 1 ######\")", "MESSAGE(\"3 4 3 1 2\")",
                                "MESSAGE(\"6 7 5 1 ######\")", "MESSAGE(\"1 ###### 2 4 ######\")"}));
    for (const auto &[block, why] : std::initializer_list<std::pair<const char *, const char *>>{
             {"G84.3 X1 Z2\n", "R must be given"},
             {"G84.3 X1 Z2 R1 A5\n", "A, B and C cannot be used"},
             {"G84.3 X1 U2 R1\n", "XYZ and UVW"},
             {"G84.3 R1\n", "at least one axis word"},
             {"G84.3 X1 R1 P-1\n", "P must not be negative"},
             {"G93 F1\nG84.3 X1 R1\n", "inverse time"}}) {
        ASSERT_EQ(it.run(std::string("G94 G80 F100\n") + block), Step::FAILED) << block;
        EXPECT_NE(it.error().find(why), std::string::npos) << it.error();
    }
}

TEST(Stdglue, LatheToolWithWearOffset) {
    Scripted it;
    it.remap("T python=index_lathe_tool_with_wear");
    it.remap("M6 python=ignore_m6");
    it.handlers("");
    ToolEntry wear;
    wear.toolno = 10001;
    wear.offset[2] = 0.5;
    it.world.table.add(wear);
    ASSERT_EQ(it.run("T201\nM6\n"), Step::PROGRAM_END) << it.error();
    EXPECT_EQ(it.story(),
              (Events{"SELECT_TOOL(2)", "CHANGE_TOOL()", "SYNC",
                      "USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 0.1000, 0.0000 0.0000 0.0000, 0.0000 0.0000 "
                      "0.0000)",
                      "USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 0.6000, 0.0000 0.0000 0.0000, 0.0000 0.0000 "
                      "0.0000)"}));
    ASSERT_EQ(it.run("T207\n"), Step::FAILED);
    EXPECT_EQ(it.error(), "T207: tool 10007 is not in the tool table");
}

}  // namespace
}  // namespace mw::python_host::test
