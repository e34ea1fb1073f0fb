// SPDX-License-Identifier: GPL-2.0-or-later
// A machine for tests: remembers what a program asks for.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "interp/interpreter.hh"
#include "interp/machine_frame.hh"
#include "mill.hh"

namespace mw::interp::test {

/// Keeps moves; everything else as words in `calls`.
class Recorder : public MachineCanon {
  public:
    std::vector<LineMove> lines;
    std::vector<ArcMove> arcs;
    std::vector<std::string> calls;
    int selected_tool = 0, tool_in_spindle = 0;

    void begin_block(const BlockRef &) override {}
    void line(const LineMove &move) override { lines.push_back(move); }
    void arc(const ArcMove &move) override { arcs.push_back(move); }
    void probe(const LineMove &move, ProbeKind) override { lines.push_back(move); }
    void rigid_tap(const LineMove &move, double) override { lines.push_back(move); }
    void dwell(double) override { calls.emplace_back("dwell"); }
    void tool_offset(const Pose &) override { calls.emplace_back("tool_offset"); }
    void offsets(int, const Pose &, const Pose &, double) override {}
    void set_spindle_mode(int, double) override { calls.emplace_back("spindle_mode"); }
    void set_spindle_speed(int, double, double) override { calls.emplace_back("spindle_speed"); }
    void spindle_on(int, int direction, bool) override {
        calls.emplace_back(direction > 0 ? "spindle_cw" : "spindle_ccw");
    }
    void spindle_off(int) override { calls.emplace_back("spindle_off"); }
    void orient_spindle(int, double, int) override { calls.emplace_back("orient"); }
    void wait_orient_complete(int, double) override { calls.emplace_back("wait_orient"); }
    void select_tool(int toolno) override {
        calls.push_back("select_tool " + std::to_string(toolno));
        selected_tool = toolno;
    }
    void change_tool() override {
        calls.emplace_back("change_tool");
        tool_in_spindle = selected_tool;
    }
    void change_tool_number(int toolno) override {
        calls.push_back("tool_number " + std::to_string(toolno));
        tool_in_spindle = toolno;
    }
    void set_tool_table_entry(int index, const ToolEntry &) override {
        calls.push_back("tool_entry " + std::to_string(index));
    }
    void coolant(bool isMist, bool isOn) override {
        calls.push_back(std::string(isMist ? "mist" : "flood") + (isOn ? "_on" : "_off"));
    }
    void feed_override(bool isEnabled) override { calls.emplace_back(isEnabled ? "fo_on" : "fo_off"); }
    void speed_override(int, bool isEnabled) override { calls.emplace_back(isEnabled ? "so_on" : "so_off"); }
    void feed_hold(bool isEnabled) override { calls.emplace_back(isEnabled ? "hold_on" : "hold_off"); }
    void adaptive_feed(bool isEnabled) override {
        calls.emplace_back(isEnabled ? "adaptive_on" : "adaptive_off");
    }
    void set_digital_output(int index, bool isOn, bool isSynched) override {
        calls.push_back("dout " + std::to_string(index) + (isOn ? " on" : " off") +
                        (isSynched ? " synched" : ""));
    }
    void set_analog_output(int index, double, bool isSynched) override {
        calls.push_back("aout " + std::to_string(index) + (isSynched ? " synched" : ""));
    }
    void wait_input(int index, bool, WaitKind, double) override {
        calls.push_back("wait " + std::to_string(index));
    }
    void program_stop() override { calls.emplace_back("stop"); }
    void optional_program_stop() override { calls.emplace_back("optional_stop"); }
    void program_end() override { calls.emplace_back("end"); }
    void pallet_shuttle() override { calls.emplace_back("pallet"); }
    void finish() override { calls.emplace_back("finish"); }
    void comment(std::string_view) override {}
    void message(std::string_view text) override { calls.push_back("message" + std::string(text)); }
    void print(std::string_view text) override { calls.push_back("print" + std::string(text)); }
    void log_open(std::string_view path, bool) override { calls.push_back("log_open " + std::string(path)); }
    void log(std::string_view text) override { calls.push_back("log" + std::string(text)); }
    void log_close() override { calls.emplace_back("log_close"); }
    void canon_error(std::string_view text) override { calls.push_back("error " + std::string(text)); }
    void user_m_code(int code, double, double) override { calls.push_back("m" + std::to_string(code)); }
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

}  // namespace mw::interp::test
