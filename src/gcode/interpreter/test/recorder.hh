// SPDX-License-Identifier: GPL-2.0-or-later
// A machine for tests that records the calls of a program.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "mill.hh"

namespace mw::gcode::test {

/// Records moves, and all other calls as text in `calls`.
class Recorder : public MachineCanon {
  public:
    std::vector<LineMove> lines;
    std::vector<ArcMove> arcs;
    std::vector<std::string> calls;
    int selected_tool = 0, tool_in_spindle = 0;

    void begin_block(const BlockRef &) override {}
    void take(const MachineCall &call) override {
        std::visit([this](const AlternativeOf<MachineCall> auto &one) { note(one); }, call);
    }

    virtual void line(const LineMove &move) { lines.push_back(move); }
    virtual void arc(const ArcMove &move) { arcs.push_back(move); }

  private:
    void say(const std::string &call) { calls.push_back(call); }
    void note(const LineMove &move) { line(move); }
    void note(const ArcMove &move) { arc(move); }
    void note(const ProbeMove &move) { lines.push_back({move.end, move.settings}); }
    void note(const TapMove &move) { lines.push_back({move.end, move.settings}); }
    void note(const Dwell &) { say("dwell"); }
    void note(const UseToolOffset &) { say("tool_offset"); }
    void note(const OneOf<UseOffsets, UsePlanner, LogProbes, ReloadTools, ProgramComment> auto &) {}
    void note(const SetSpindleMode &) { say("spindle_mode"); }
    void note(const UseSpindleSpeed &) { say("spindle_speed"); }
    void note(const StartSpindle &call) { say(call.clockwise ? "spindle_cw" : "spindle_ccw"); }
    void note(const StopSpindle &) { say("spindle_off"); }
    void note(const OrientSpindle &) { say("orient"); }
    void note(const WaitOrientComplete &) { say("wait_orient"); }
    void note(const SelectTool &call) {
        say("select_tool " + std::to_string(call.toolno));
        selected_tool = call.toolno;
    }
    void note(const ChangeTool &) {
        say("change_tool");
        tool_in_spindle = selected_tool;
    }
    void note(const ChangeToolNumber &call) {
        say("tool_number " + std::to_string(call.toolno));
        tool_in_spindle = call.toolno;
    }
    void note(const SetToolTableEntry &call) { say("tool_entry " + std::to_string(call.index)); }
    void note(const SwitchMist &call) { say(call.isOn ? "mist_on" : "mist_off"); }
    void note(const SwitchFlood &call) { say(call.isOn ? "flood_on" : "flood_off"); }
    void note(const SwitchFeedOverride &call) { say(call.isOn ? "fo_on" : "fo_off"); }
    void note(const SwitchSpeedOverride &call) { say(call.isOn ? "so_on" : "so_off"); }
    void note(const SwitchFeedHold &call) { say(call.isOn ? "hold_on" : "hold_off"); }
    void note(const SwitchAdaptiveFeed &call) { say(call.isOn ? "adaptive_on" : "adaptive_off"); }
    void note(const SetDigitalOutput &call) {
        say("dout " + std::to_string(call.index) + (call.isOn ? " on" : " off") +
            (call.synched ? " synched" : ""));
    }
    void note(const SetAnalogOutput &call) {
        say("aout " + std::to_string(call.index) + (call.synched ? " synched" : ""));
    }
    void note(const WaitInput &call) { say("wait " + std::to_string(call.index)); }
    void note(const ProgramStop &call) { say(call.optional ? "optional_stop" : "stop"); }
    void note(const ProgramEnd &) { say("end"); }
    void note(const PalletShuttle &) { say("pallet"); }
    void note(const Finish &) { say("finish"); }
    void note(const OperatorMessage &call) { say("message" + call.text); }
    void note(const PrintLine &call) { say("print" + call.text); }
    void note(const OpenLog &call) { say("log_open " + call.path); }
    void note(const LogLine &call) { say("log" + call.text); }
    void note(const CloseLog &) { say("log_close"); }
    void note(const CanonError &call) { say("error " + call.text); }
    void note(const UserCode &call) { say("m" + std::to_string(call.code)); }
};

/// Runs program text; an M2 is added at its end.
class Machine {
  public:
    explicit Machine(Settings settings = {}) : frame(record, mill.units) {
        settings.statement_budget = settings.statement_budget == 0 ? 1000000 : settings.statement_budget;
        folder =
            std::filesystem::temp_directory_path() / ("mw_interp_" + std::to_string(::getpid()) + "_" +
                                                      std::to_string(reinterpret_cast<std::uintptr_t>(this)));
        std::filesystem::create_directories(folder);
        settings.subroutine_path.push_back(folder.string());
        interpreter = std::make_unique<Interpreter>(frame, mill, mill, mill, settings);
    }
    ~Machine() { std::filesystem::remove_all(folder); }
    Machine(const Machine &) = delete;
    Machine &operator=(const Machine &) = delete;

    void write(const std::string &name, const std::string &text) const {
        std::ofstream(folder / name) << text;
    }

    Step run(const std::string &text) {
        write("main.ngc", text + "M2\n");
        if (!isBegun) {
            EXPECT_TRUE(interpreter->begin());
            isBegun = true;
        }
        EXPECT_TRUE(interpreter->open((folder / "main.ngc").string()));
        while (true) {
            const Step step = interpreter->step();
            if (step == Step::SYNC) {
                mill.state.position = frame.position();
                mill.state.tool_in_spindle = record.tool_in_spindle;
                interpreter->synch();
            } else if (step != Step::OK) {
                return step;
            }
        }
    }
    std::string error() const { return interpreter->error().str(); }

    Mill mill;
    Recorder record;
    MachineFrame frame;
    std::unique_ptr<Interpreter> interpreter;
    std::filesystem::path folder;
    bool isBegun = false;
};

}  // namespace mw::gcode::test
