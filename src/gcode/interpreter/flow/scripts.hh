// SPDX-License-Identifier: GPL-2.0-or-later
// The script language while programs run: its host, the names that scripts define, and the running scripts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/interpreter/codes/executor.hh"
#include "gcode/interpreter/codes/remaps.hh"
#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::gcode::detail {

class Scripts final : public ScriptNames {
  public:
    /// `fault` receives errors of named parameters.
    explicit Scripts(Fault &fault) : fault_(fault) {}

    /// Opens the host when the settings or a remap need one, runs the top-level script, and checks that all
    /// names in the remaps exist. Errors name the position in the INI file. `view` must outlive the host.
    Result<> load(const Settings &settings, const Remaps &remaps, const BuiltIns &built_ins,
                  InterpreterView &view);
    /// Opens the host if it is not open. `what`, at position `place`, requires it.
    Result<> need(const std::string &what, const SourcePlace &place, const Settings &settings,
                  InterpreterView &view);
    Result<> begin();
    ProgramLimits &limits() { return limits_; }
    const ProgramLimits &limits() const { return limits_; }
    void close() { host_.reset(); }

    bool isOpen() const { return host_ != nullptr; }
    bool hasFunction(ScriptModule module, std::string_view name) const {
        return host_ != nullptr && host_->hasFunction(module, name);
    }
    /// `rest` is set when the outcome is WAITING.
    ScriptOutcome call(ScriptModule module, const std::string &name, const ScriptArguments &arguments,
                       std::unique_ptr<SuspendedScript> &rest);
    ScriptOutcome resume(SuspendedScript &script);
    ScriptOutcome run_text(std::string_view text);
    /// Number of nested running scripts.
    int depth() const { return depth_; }
    /// Number of calls, resumes and queries.
    std::uint64_t count_calls() const { return calls_; }
    /// True while the script of a named parameter runs; it may only read.
    bool isReadingName() const { return is_reading_name_; }

    bool hasName(std::string_view name) const override;
    std::optional<double> value_of(std::string_view name) override;
    /// Named parameters that scripts compute.
    const std::vector<std::string> &names() const { return names_; }
    const std::vector<std::string> &warnings() const { return warnings_; }

    std::string error_text;  ///< set by a script

  private:
    Result<> check(const Remap &remap) const;

    Fault &fault_;
    std::unique_ptr<ScriptHost> host_;
    std::vector<std::string> names_, warnings_;
    int depth_ = 0;
    std::uint64_t calls_ = 0;
    bool is_reading_name_ = false;
    ProgramLimits limits_;
};

}  // namespace mw::gcode::detail
