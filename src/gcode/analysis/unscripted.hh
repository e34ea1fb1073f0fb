// SPDX-License-Identifier: GPL-2.0-or-later
// A script host that runs nothing: for checking a program before user code may affect the machine.
#pragma once

#include <functional>

#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::gcode {

/// Every function of a remap exists and does nothing; `asked` is called for each function call that was
/// skipped.
class UnscriptedHost final : public ScriptHost {
  public:
    explicit UnscriptedHost(std::function<void()> asked) : asked_(std::move(asked)) {}

    Result<> load(const ScriptSettings &, InterpreterView &) override { return {}; }
    Result<> begin() override { return {}; }
    /// Assumes a file, because it is unknown whether a script or a file implements an O word.
    bool hasFunction(ScriptModule module, std::string_view) const override {
        return module == ScriptModule::REMAP;
    }
    ScriptOutcome call(ScriptModule, const std::string &, const ScriptArguments &,
                       std::unique_ptr<SuspendedScript> &) override {
        asked_();
        return {};
    }
    ScriptOutcome run_text(std::string_view) override {
        asked_();
        return {};
    }
    std::vector<std::string> named_parameters() const override { return {}; }
    Result<double> named_parameter(const std::string &) override { return 0.0; }

  private:
    std::function<void()> asked_;
};

/// Returns 0 for HAL values and calls `asked` for each, because they are known only while the machine runs.
class UnknownHalValues final : public ParameterSource {
  public:
    UnknownHalValues(ParameterSource &values, std::function<void()> asked)
        : values_(values), asked_(std::move(asked)) {}

    std::optional<double> ini_value(std::string_view section, std::string_view key) const override {
        return values_.ini_value(section, key);
    }
    std::optional<double> hal_value(std::string_view) const override {
        asked_();
        return 0.0;
    }

  private:
    ParameterSource &values_;
    std::function<void()> asked_;
};

}  // namespace mw::gcode
