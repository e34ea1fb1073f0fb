// SPDX-License-Identifier: GPL-2.0-or-later
// Interface between the interpreter and a script language (remap handlers, O words, named parameters, ;py,
// lines). It is independent of the language: an optional shared object implements ScriptHost.
#pragma once

#include <array>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/result.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode {

using ScriptValue = std::variant<bool, std::int64_t, double, std::string>;

/// A remapped code as defined in its INI line.
struct ScriptRemap {
    std::string name, argspec, prolog, epilog, ngc, function;
    int modal_group = 0;
    int motion_code = -1;  ///< ten times the number of a G code
};

/// A block as scripts read it: words, codes, comment. Letters as indices: a is 0.
struct ScriptBlock {
    std::uint32_t present = 0;  ///< bit per letter
    std::array<double, 26> value{};
    std::optional<double> radius, angle;  ///< the polar words @ and ^
    std::array<int, 17> g_modes{};        ///< by modal group number; ten times the code, -1 none
    std::array<int, 11> m_modes{};
    int motion = -1;  ///< the motion code of the block
    int m_count = 0;
    int line = 0;      ///< from 1
    int number = -1;   ///< the N word
    int builtins = 0;  ///< number of uses of a code's built-in meaning by the procedure that remaps it
    std::string comment, o_name;
    std::vector<double> params;  ///< arguments of an O word call
    std::optional<ScriptRemap> remap;
};

/// One call level.
struct ScriptContext {
    std::string name, file;
    int line = 0;
    int kind = 0;    ///< 0 main, 1 procedure, 2 by M98, 3 script of an O word, 4 remap
    int status = 0;  ///< bit 0: modes saved (M70, M73); bit 1: restored at return; bit 2: a remap
    ActiveCodes saved;
    std::array<double, 30> arguments{};  ///< #1 to #30 of the caller
    std::vector<std::pair<std::string, double>> named;
};

/// The reason why a block executed by a script has failed.
struct ScriptFault {
    std::string message;
    int line = 0;
    std::string text;
};

/// The interpreter's interface for scripts. Valid as long as the interpreter; used only while it calls a
/// script.
class InterpreterView {
  public:
    virtual ~InterpreterView() = default;

    /// Runs a block and the subroutines that it calls. True: done; false: a synchronisation point (probe,
    /// tool change, input) is due, and the script must be suspended before it executes more blocks. `line`
    /// names the block; 0: none.
    virtual std::expected<bool, ScriptFault> execute(std::string_view text, int line) = 0;
    /// Canon for the calls of scripts, in program order; deliver() passes them on.
    virtual Canon &canon() = 0;
    virtual void deliver() = 0;
    /// The next synchronisation point reads the result of an input (M66, WAIT) or of a probe.
    virtual void expect_input() = 0;
    virtual void expect_probe() = 0;

    /// #number; 0 for numbers out of range, as in LinuxCNC.
    virtual double parameter(int number) const = 0;
    virtual Result<> set_parameter(int number, double value) = 0;
    virtual std::optional<double> named(std::string_view name) = 0;
    virtual Result<> set_named(std::string_view name, double value) = 0;
    virtual std::vector<std::string> local_names() const = 0;
    virtual std::vector<std::string> global_names() const = 0;
    /// Global names that the interpreter or a script computes; they are read-only.
    virtual std::vector<std::string> predefined_names() const = 0;
    /// Global names that a script computes.
    virtual std::vector<std::string> script_names() const = 0;

    /// State by its name ("feed_rate"); nothing when there is no such name.
    virtual std::optional<ScriptValue> attribute(std::string_view name) const = 0;
    virtual Result<> set_attribute(std::string_view name, const ScriptValue &value) = 0;
    virtual std::vector<std::string_view> attribute_names() const = 0;

    virtual ActiveCodes active_codes() const = 0;
    virtual double spindle_speed(int spindle) const = 0;
    virtual void set_spindle_speed(int spindle, double speed) = 0;
    virtual Pose tool_offset() const = 0;  ///< [program units]
    virtual void set_tool_offset(const Pose &offset) = 0;
    virtual int count_tools() const = 0;
    virtual ToolEntry tool(int index) const = 0;
    virtual int find_tool(int number) const = 0;  ///< -1 when the table has no such tool
    /// Reads the tool of current_pocket as the tool in the spindle: #5400 to #5413 are updated.
    virtual void load_tool() = 0;
    virtual void synch() = 0;

    /// The current block and its outer ones: 0 the block itself, n that of the n-th nested remap.
    virtual ScriptBlock block(int level) const = 0;
    virtual std::vector<ScriptContext> contexts() const = 0;
    virtual const World &world() const = 0;
};

/// Result of calling a script.
struct ScriptOutcome {
    enum class Kind { DONE, VALUE, WAITING, EXIT, FAILED };
    Kind kind = Kind::DONE;
    double value = 0;     ///< result of VALUE
    std::string message;  ///< message of FAILED, with the position in the script
};

/// A suspended script. Destroying the object ends the script without continuing it.
class SuspendedScript {
  public:
    virtual ~SuspendedScript() = default;
    virtual ScriptOutcome resume() = 0;
};

struct ScriptArguments {
    std::vector<double> positional;
    std::vector<std::pair<std::string, double>> words;  ///< names in lower case
};

/// Module of a script function.
enum class ScriptModule { REMAP, OWORD };

class ScriptStop;

class ScriptHost {
  public:
    virtual ~ScriptHost() = default;
    /// Scripts end when `stop`, which outlives the host, receives a request.
    virtual void follow(ScriptStop &stop) { static_cast<void>(stop); }
    /// Runs the top-level script. `view` must outlive the host.
    virtual Result<> load(const ScriptSettings &settings, InterpreterView &view) = 0;
    /// Called when the interpreter is ready. Calls __init__ of the top-level script, if it exists.
    virtual Result<> begin() = 0;
    virtual bool hasFunction(ScriptModule module, std::string_view name) const = 0;
    /// `rest` is set when the outcome is WAITING.
    virtual ScriptOutcome call(ScriptModule module, const std::string &name, const ScriptArguments &arguments,
                               std::unique_ptr<SuspendedScript> &rest) = 0;
    /// Runs the statements of a ;py, line.
    virtual ScriptOutcome run_text(std::string_view text) = 0;
    /// Named parameters (with their leading underscore) that scripts define.
    virtual std::vector<std::string> named_parameters() const = 0;
    virtual Result<double> named_parameter(const std::string &name) = 0;
};

/// Opens the shared object `file` (see script_library()) and creates a host. An error names the package to
/// install.
Result<std::unique_ptr<ScriptHost>> open_script_host(const std::string &file);
/// Path of the host for Python: beside this program, in the build folder or the installation.
std::string script_library();

/// The symbol in that shared object, and the version that both sides must match.
inline constexpr char SCRIPT_HOST_SYMBOL[] = "millwright_script_host";
inline constexpr int SCRIPT_HOST_VERSION = 3;
/// Writes a new host to *host; returns 0 when `version` is not the compiled one.
using ScriptHostFactory = int (*)(int version, ScriptHost **host);

}  // namespace mw::gcode
