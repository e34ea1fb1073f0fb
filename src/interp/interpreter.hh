// SPDX-License-Identifier: GPL-2.0-or-later
// The RS-274/NGC interpreter. Parse once, run many; one block per step; never blocks.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "diag/sink.hh"
#include "interp/canon.hh"
#include "interp/world.hh"

namespace mw::interp {

struct Settings {
    std::vector<std::string>
        subroutine_path;  ///< [RS274NGC]SUBROUTINE_PATH and [DISPLAY]PROGRAM_PREFIX, in order
    std::vector<std::string> user_m_path;  ///< [RS274NGC]USER_M_PATH and PROGRAM_PREFIX: where M100..M199 are
    std::string startup_code;              ///< [RS274NGC]RS274NGC_STARTUP_CODE
    bool isG92PersistenceDisabled = false;
    bool isFanucSubDisabled = false;
    bool isCoordinateSystemKept = false;  ///< M2 and M30 do not go back to G54
    double max_velocity_mm_s = 0;         ///< threads that need more are refused; 0: not known
    double center_arc_radius_tolerance_mm = 0.00127;
    double center_arc_radius_tolerance_inch = 0.00005;
    bool isLathe = false;
    bool isTask = false;                ///< #<_task>: a machine runs the program
    bool isArgumentCountNamed = false;  ///< [RS274NGC]OWORD_NARGS: #<n_args> in subroutines
    double orient_offset_deg = 0;
    double parameter_g73_peck_clearance_mm = 0.254, parameter_g83_peck_clearance_mm = 0.254;
    std::vector<std::string> remaps;  ///< [RS274NGC]REMAP lines, as written
    std::string ini_folder;
    std::optional<LengthUnits> initial_units;  ///< G20 or G21 at the start; the machine's when not given
    /// Statements per step() and in all; 0: without bound. A bound makes check runs of endless loops end in
    /// an error.
    std::uint64_t statement_budget = 0;
};

enum class Step {
    OK,           ///< one block done; call again
    SYNC,         ///< the caller must let queued work finish, then call synch() and step() again
    PROGRAM_END,  ///< M2 or M30
    FILE_END,     ///< the closing % or the end of the file
    FAILED,       ///< see error(); the block changed nothing
};

/// The codes in force, in the shapes that status displays rely on (facts.md).
struct ActiveCodes {
    std::array<int, 17> g{};  ///< [0] sequence number, then ten times the code, -1 none
    std::array<int, 10> m{};
    std::array<double, 5> settings{};  ///< sequence, feed, speed, G64 P, G64 Q
};

class Interpreter {
  public:
    /// All references must outlive the interpreter.
    Interpreter(Canon &canon, World &world, ToolSource &tools, ParameterSource &parameters,
                Settings settings);
    ~Interpreter();

    /// Reads the parameter file (RS274NGC_VAR); a missing file is an empty one. Errors name line and column.
    Result<> load_parameters(const std::string &path);
    /// Writes it atomically; keeps the numbers that the file had and those that must be there.
    Result<> save_parameters(const std::string &path) const;

    /// Announces offsets, units and modes to the canon and runs the start-up code.
    Result<> begin();
    /// Reads and parses a whole file. Syntax errors outside executed blocks are reported when they are
    /// reached.
    Result<> open(const std::string &path);
    /// The same for a program in memory; `name` stands for its file in messages.
    void open_text(const std::string &name, std::string text);
    void close();

    /// Executes the next block of the open file. [task]
    Step step();
    /// Executes one line of MDI; subroutine calls in it go on with step() until FILE_END.
    Step execute(std::string_view line);
    /// Takes the machine's state as the current one (after a stop, a probe, a tool change). [task]
    void synch();
    /// Back to the top level after an abort: drops calls and loops, keeps modes.
    void abort();

    /// The last failure: message, file:line:column, the block's text, the callers.
    const diag::Diagnostic &error() const;
    ActiveCodes active_codes() const;
    int line() const;  ///< of the block last read, in file()
    const std::string &file() const;
    int call_level() const;
    /// No line of the open file is left.
    bool isAtFileEnd() const;
    double parameter(int number) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::interp
