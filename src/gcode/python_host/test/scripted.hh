// SPDX-License-Identifier: GPL-2.0-or-later
// An interpreter with Python and a machine that waits. Canon calls are recorded as text, and "SYNC" where the
// machine must stop.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/text.hh"
#include "gcode/canon/print_canon.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/interpreter/standalone.hh"

namespace mw::python_host::test {

using namespace mw::gcode;

class WaitingWorld : public Standalone {
  public:
    bool isSynchedAtOnce() const override { return false; }
};

/// A folder with scripts and procedures, and an interpreter that uses it.
class Scripted {
  public:
    explicit Scripted(const std::string &name = "a") {
        folder = std::filesystem::temp_directory_path() /
                 ("mw_pyhost_" + std::to_string(::getpid()) + "_" + name + std::to_string(counter()++));
        std::filesystem::create_directories(folder);
        settings.subroutine_path.push_back(folder.string());
        settings.scripts.path_prepend.push_back(folder.string());
        settings.scripts.top_level = (folder / "toplevel.py").string();
        settings.scripts.place = {"test.ini", 5, 12};
        settings.initial_units = LengthUnits::MM;
        settings.statement_budget = 100000;
        world.units = LengthUnits::MM;
        world.table = built_in_tools();
        write("toplevel.py", "import remap, oword\n");
        write("remap.py", "");
        write("oword.py", "");
    }
    ~Scripted() {
        interpreter.reset();
        canon.reset();
        if (out != nullptr) {
            std::fclose(out);
            std::free(text);
        }
        std::filesystem::remove_all(folder);
    }
    Scripted(const Scripted &) = delete;
    Scripted &operator=(const Scripted &) = delete;

    void write(const std::string &name, const std::string &content) const {
        std::ofstream(folder / name) << content;
    }
    void remap(const std::string &line) {
        settings.remaps.emplace_back(
            line, SourcePlace{"test.ini", 10 + static_cast<int>(settings.remaps.size()), 7});
    }
    /// Adds handlers to the module remap, after the usual imports.
    void handlers(const std::string &content) const {
        write("remap.py",
              "import emccanon, interpreter\nfrom interpreter import *\nfrom stdglue import *\n" + content);
    }
    void owords(const std::string &content) const {
        write("oword.py", "import emccanon\nfrom interpreter import *\n" + content);
    }

    Result<> begin() {
        out = ::open_memstream(&text, &size);
        canon = std::make_unique<PrintCanon>(out);
        interpreter = std::make_unique<Interpreter>(*canon, world, world, world, settings);
        Result<> begun = interpreter->begin();
        shown = 0;
        drain();
        return begun;
    }

    /// The calls since the last drain(), without counter and block number.
    std::vector<std::string> drain() {
        std::fflush(out);
        std::istringstream lines(std::string(text + shown, size - shown));
        shown = size;
        std::vector<std::string> calls;
        for (std::string line; std::getline(lines, line);) {
            const std::size_t name = line.find_first_not_of(" 0123456789");
            const bool is_call =
                name != std::string::npos && line[name] == 'N' && line.find(' ', name) != std::string::npos;
            calls.emplace_back(is_call ? trim(std::string_view(line).substr(line.find(' ', name))) : line);
        }
        return calls;
    }

    /// Runs a program with M2 appended; records calls in order, and "SYNC" where the interpreter waits.
    Step run(const std::string &program) {
        if (interpreter == nullptr) {
            const Result<> begun = begin();
            EXPECT_TRUE(begun) << (begun ? "" : begun.error().str());
        }
        events.clear();
        interpreter->open_text("main.ngc", program + "M2\n");
        while (true) {
            const Step step = interpreter->step();
            take_events();
            if (step == Step::SYNC) {
                events.emplace_back("SYNC");
                machine_rests();
                interpreter->synch();
            } else if (step != Step::OK) {
                return step;
            }
        }
    }
    void take_events() {
        for (std::string &call : drain()) {
            if (call.starts_with("SELECT_TOOL(")) {
                selected_ = static_cast<int>(*parse_int(call.substr(12, call.size() - 13)));
            } else if (call.starts_with("CHANGE_TOOL(")) {
                world.state.tool_in_spindle = selected_;
                world.state.current_pocket = selected_ > 0 ? world.table.index_of_tool(selected_) : 0;
            } else if (call.starts_with("STRAIGHT_")) {
                const std::size_t begin = call.find('(') + 1;
                end_[0] = *parse_double(call.substr(begin, call.find(',') - begin));
            }
            events.push_back(std::move(call));
        }
    }
    /// Recorded events up to those of M2, without the usual ones.
    std::vector<std::string> story() const {
        std::vector<std::string> out_events;
        for (const std::string &event : events) {
            if (event.starts_with("SET_G5X_OFFSET")) {
                break;
            }
            out_events.push_back(event);
        }
        return out_events;
    }
    std::string error() const { return interpreter->error().what.message; }

    std::filesystem::path folder;
    Settings settings;
    WaitingWorld world;
    std::unique_ptr<PrintCanon> canon;
    std::unique_ptr<Interpreter> interpreter;
    std::vector<std::string> events;

  private:
    static int &counter() {
        static int count = 0;
        return count;
    }
    void machine_rests() { world.state.position[0] = end_[0]; }

    std::FILE *out = nullptr;
    char *text = nullptr;
    std::size_t size = 0, shown = 0;
    geometry::Pose end_;
    int selected_ = 0;
};

}  // namespace mw::python_host::test
