// SPDX-License-Identifier: GPL-2.0-or-later
// Python as the interpreter's script language. One host per interpreter; several share the embedded Python,
// each with its own top-level namespace and user modules.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/python_host/interrupter.hh"
#include "gcode/python_host/modules.hh"

namespace mw::python_host {

class PythonHost final : public gcode::ScriptHost {
  public:
    PythonHost();
    ~PythonHost() override;
    PythonHost(const PythonHost &) = delete;
    PythonHost &operator=(const PythonHost &) = delete;

    void follow(gcode::ScriptStop &stop) override;
    Result<> load(const gcode::ScriptSettings &settings, gcode::InterpreterView &view) override;
    Result<> begin() override;
    bool hasFunction(gcode::ScriptModule module, std::string_view name) const override;
    gcode::ScriptOutcome call(gcode::ScriptModule module, const std::string &name,
                              const gcode::ScriptArguments &arguments,
                              std::unique_ptr<gcode::SuspendedScript> &rest) override;
    gcode::ScriptOutcome run_text(std::string_view text) override;
    std::vector<std::string> named_parameters() const override;
    Result<double> named_parameter(const std::string &name) override;

  private:
    friend class SuspendedPython;
    class Entry;

    void activate() const;
    void stash() const;
    bool isOwnModule(const py::handle &module) const;
    void run_top_level();
    void reload_if_changed();
    py::object find_function(const char *module, std::string_view name) const;
    Result<> call_hook(const char *name);
    gcode::ScriptOutcome outcome_of(const py::object &result, const std::string &label, bool is_o_word,
                                    std::unique_ptr<gcode::SuspendedScript> &rest);
    gcode::ScriptOutcome advance(const py::object &generator, const std::string &label, bool is_o_word);
    gcode::ScriptOutcome number_outcome(const py::object &result, const std::string &label,
                                        bool is_o_word) const;
    gcode::ScriptOutcome failed(std::string message) const;

    static const PythonHost *active;  ///< the host whose modules are in sys.modules
    static int entries;               ///< number of nested calls into Python
    static int hosts;

    std::unique_ptr<Interrupter> interrupter_;  ///< null: scripts cannot be ended
    gcode::ScriptSettings settings_;
    gcode::InterpreterView *view_ = nullptr;
    std::shared_ptr<ViewHandle> handle_;
    py::object self_, main_;
    py::object modules_;  ///< dict: own modules while another host is active
    py::object path_;     ///< list: sys.path for this host
    std::map<std::string, std::filesystem::file_time_type>
        times_;  ///< times of the files that RELOAD watches
};

}  // namespace mw::python_host
