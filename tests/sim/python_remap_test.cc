// SPDX-License-Identifier: GPL-2.0-or-later
// Remaps with Python on a whole machine in virtual time: program order, waiting, abort (I1).
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

class PythonRemapTest : public VirtualMachineTest {
  protected:
    PythonRemapTest() {
        write("toplevel.py", "import remap, oword\n");
        write("oword.py", "");
    }

    void switch_on(const std::vector<std::string> &remaps) {
        VirtualMachineTest::switch_on([&](task::Settings &task) {
            task.interpreter.remaps.assign(remaps.begin(), remaps.end());
            task.interpreter.scripts.top_level = (folder_ / "toplevel.py").string();
            task.interpreter.scripts.path_prepend = {folder_.string()};
            task.interpreter.subroutine_path.push_back(folder_.string());
        });
    }
};

TEST_F(PythonRemapTest, AToolChangeThroughPythonAndAProcedureKeepsProgramOrder) {
    write("remap.py", "from stdglue import *\n");
    write("change.ngc", "o<change> sub\nG53 G0 Z40\nG53 G0 X-20\nM64 P1\no<change> endsub [1]\n");
    switch_on({"M6 modalgroup=6 prolog=change_prolog ngc=change epilog=change_epilog"});
    ASSERT_TRUE(machine_->hal().signals().unlink("iocontrol.0.tool-changed").has_value());
    start("G21 G90\nG0 X10\nT2 M6\n(debug,tool %d#5400)\nG0 X30\nM2\n");
    for (int i = 0; i < 20000 && !machine_->hal().values().get("iocontrol.0.tool-change")->as_bit(); ++i) {
        cycles(1);
    }
    ASSERT_TRUE(machine_->hal().values().get("iocontrol.0.tool-change")->as_bit());
    EXPECT_TRUE(machine_->task().motion_status().isInPosition);
    EXPECT_TRUE(machine_->hal().values().get("motion.digital-out-01")->as_bit())
        << "the procedure ran before the change";
    EXPECT_EQ(progress(run_), task::Progress::STARTED);
    EXPECT_EQ(messages().find("tool 2"), std::string::npos) << "nothing after the change is read before it";
    const double waiting_at = x();
    cycles(2000);
    EXPECT_EQ(x(), waiting_at);
    ASSERT_TRUE(machine_->hal().values().set("iocontrol.0.tool-changed", "TRUE").has_value());
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_EQ(machine_->task().status().tool.in_spindle, 2);
    EXPECT_DOUBLE_EQ(x(), 30.0);
    EXPECT_NE(messages().find("tool 2"), std::string::npos);
}

TEST_F(PythonRemapTest, AYieldResumesWhenTheMachineIsThere) {
    write("remap.py", "import emccanon\nfrom interpreter import *\n"
                      "def there(self, **words):\n"
                      "    assert self.task == 1\n"
                      "    self.execute('G1 F3000 X%g' % words['p'])\n"
                      "    yield INTERP_EXECUTE_FINISH\n"
                      "    emccanon.MESSAGE('machine at %.4f' % emccanon.GET_EXTERNAL_POSITION_X())\n"
                      "    emccanon.WAIT(0, 1, 3, 5.0)\n"
                      "    yield INTERP_EXECUTE_FINISH\n"
                      "    emccanon.MESSAGE('input %g' % self.params[5399])\n");
    switch_on({"M400 argspec=P py=there"});
    ASSERT_TRUE(machine_->hal().values().set("motion.digital-in-00", "TRUE").has_value());
    start("G21 G90\nG0 X10\nM400 P25\nM400 P5\nG0 X7\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_EQ(messages(), "machine at 25.0000\ninput 1\nmachine at 5.0000\ninput 1\n");
    EXPECT_DOUBLE_EQ(x(), 7.0);
}

TEST_F(PythonRemapTest, AbortDuringAYieldEndsTheScriptAndTheNextProgramRuns) {
    write("remap.py", "from interpreter import *\nstate = []\n"
                      "def wait(self, **words):\n"
                      "    try:\n        yield INTERP_EXECUTE_FINISH\n        state.append('resumed')\n"
                      "    finally:\n        state.append('closed')\n");
    write("oword.py", "import remap\nfrom emccanon import MESSAGE\n"
                      "def tell(self):\n    MESSAGE(' '.join(remap.state))\n");
    switch_on({"M400 py=wait"});
    start("G21 G90\nG1 F60 X100\nM400\nG0 X0\nM2\n");
    cycles(1500);
    EXPECT_EQ(machine_->task().status().task.call_level, 1);
    ask(task::AbortAll{});
    EXPECT_EQ(progress(run_), task::Progress::FAILED);
    cycles(500);
    messages();
    start("G21 G90\no<tell> call\nG0 X3\nM2\n");
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_EQ(messages(), "closed\n");
    EXPECT_DOUBLE_EQ(x(), 3.0);
}

TEST_F(PythonRemapTest, AnErrorInPythonStopsTheProgramWithItsPlace) {
    write("remap.py", "def bad(self, **words):\n    return 1 / 0\n");
    switch_on({"M400 py=bad"});
    start("G21 G90\nG0 X1\nM400\nG0 X100\nM2\n");
    EXPECT_EQ(finish(), task::Progress::FAILED);
    const std::string all = messages();
    EXPECT_NE(all.find("p.ngc:3"), std::string::npos) << all;
    EXPECT_NE(all.find("remap.py:2 in bad"), std::string::npos) << all;
}

TEST_F(PythonRemapTest, MdiRunsRemapsAndWaits) {
    write("remap.py", "from interpreter import *\n"
                      "def move(self, **words):\n    self.execute('G0 X8')\n    yield INTERP_EXECUTE_FINISH\n"
                      "    self.execute('G0 X9')\n");
    switch_on({"M400 py=move"});
    ask(task::SetMode{task::Mode::MDI});
    run_ = post(task::Mdi{"M400"});
    cycles(3);
    EXPECT_EQ(finish(), task::Progress::DONE);
    EXPECT_DOUBLE_EQ(x(), 9.0);
}

}  // namespace
}  // namespace mw::machine
