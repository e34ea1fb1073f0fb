// SPDX-License-Identifier: GPL-2.0-or-later
// Interface of interpreters: the RS-274/NGC interpreter, or a plug-in for another language (`rs274 -p`,
// [TASK]INTERPRETER). A plug-in is a shared object compiled against this header; see
// docs/developer/extending/plugins.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "gcode/canon/canon.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode {

enum class Step {
    OK,           ///< one block is done; call again
    SYNC,         ///< the caller must let queued work finish, then call synch() and step() again
    PROGRAM_END,  ///< M2 or M30
    FILE_END,     ///< the closing % or the end of the file
    FAILED,       ///< the block has failed and changed nothing; see error()
};

/// The active codes in the form of LinuxCNC's status.
struct ActiveCodes {
    std::array<int, 17> g{};  ///< [0] sequence number, then ten times the code, -1 none
    std::array<int, 10> m{};
    std::array<double, 5> settings{};  ///< sequence, feed, speed, G64 P, G64 Q
};

/// One object belongs to one thread; calls do not block and throw no exceptions.
class ProgramInterpreter {
  public:
    virtual ~ProgramInterpreter() = default;

    /// Reads the parameter file (RS274NGC_VAR); a missing file is treated as empty. Errors name line and
    /// column.
    virtual Result<> load_parameters(const std::string &) { return {}; }
    /// Writes the file atomically, with the required numbers and all others that the file contained.
    virtual Result<> save_parameters(const std::string &) const { return {}; }
    /// The value of #number; 0 if the interpreter has no parameters.
    virtual double parameter(int) const { return 0.0; }

    /// Called before the first program.
    virtual Result<> begin() = 0;
    /// Reads a file; its lines are executed by step().
    virtual Result<> open(const std::string &path) = 0;
    virtual void close() = 0;
    /// Executes the next block of the open file.
    virtual Step step() = 0;
    /// Executes one line of MDI; step() continues it until FILE_END.
    virtual Step execute(std::string_view line) = 0;
    /// Reads the machine's state as the current one (after a stop, a probe, a tool change).
    virtual void synch() = 0;
    /// Returns to the top level after an abort.
    virtual void abort() = 0;
    /// Announces the active offsets, speeds and switches to a canon that has lost the blocks read ahead.
    virtual void announce() {}

    /// The last failure: message, file:line:column, the block's text, the callers.
    virtual const diagnostics::Diagnostic &error() const = 0;
    virtual ActiveCodes active_codes() const { return {}; }
    virtual int line() const = 0;  ///< line of the last block, in file()
    virtual const std::string &file() const = 0;
    virtual int call_level() const { return 0; }
    /// The open file has no more lines.
    virtual bool isAtFileEnd() const = 0;
    /// True if cutter compensation keeps the last move until the next move, or G40, determines its end.
    virtual bool isMoveHeld() const { return false; }
    /// Warnings of begin().
    virtual const std::vector<std::string> &warnings() const {
        static const std::vector<std::string> NONE;
        return NONE;
    }
};

/// Objects that a plug-in uses; all of them outlive it.
struct PluginParts {
    Canon &canon;
    World &world;
    ToolSource &tools;
    ParameterSource &parameters;
};

inline constexpr int PLUGIN_VERSION = 2;
/// Symbols that a plug-in exports, with C linkage: `int millwright_plugin_version`, which must be
/// PLUGIN_VERSION, and makeInterp, which creates an interpreter (the caller deletes it).
inline constexpr char PLUGIN_VERSION_SYMBOL[] = "millwright_plugin_version";
inline constexpr char PLUGIN_FACTORY_SYMBOL[] = "makeInterp";
using PluginFactory = ProgramInterpreter *(*)(const PluginParts &parts);

}  // namespace mw::gcode
