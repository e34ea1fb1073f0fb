// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/scripts.hh"

#include <algorithm>

#include <fmt/format.h>

#include "gcode/interpreter/scripts/script_stop.hh"

namespace mw::gcode::detail {
namespace {

constexpr const char *FORBIDDEN = "the effect of Python code is unknown before it runs";

ScriptOutcome forbidden() {
    ScriptOutcome outcome;
    outcome.kind = ScriptOutcome::Kind::FAILED;
    outcome.message = FORBIDDEN;
    return outcome;
}

}  // namespace

Result<> Scripts::need(const std::string &what, const SourcePlace &place, const Settings &settings,
                       InterpreterView &view) {
    if (limits_.are_scripts_forbidden) {
        return fail(FORBIDDEN, place);
    }
    if (host_ != nullptr) {
        return {};
    }
    Result<std::unique_ptr<ScriptHost>> made =
        settings.make_script_host ? settings.make_script_host() : open_script_host(script_library());
    if (!made) {
        Error error = made.error();
        error.message = fmt::format("{} needs Python: {}", what, error.message);
        error.place = place;
        return std::unexpected(std::move(error));
    }
    (*made)->follow(script_stop());
    ++depth_;
    Result<> loaded = (*made)->load(settings.scripts, view);
    --depth_;
    if (!loaded) {
        if (loaded.error().place.file.empty()) {
            loaded.error().place = place;
        }
        return loaded;
    }
    host_ = std::move(*made);
    return {};
}

Result<> Scripts::check(const Remap &remap) const {
    for (const std::string *name : {&remap.function, &remap.prolog, &remap.epilog}) {
        if (!name->empty() && !host_->hasFunction(ScriptModule::REMAP, *name)) {
            return fail(fmt::format("REMAP of {}: '{}' is not a Python function of the module remap",
                                    remap.name, *name),
                        remap.place,
                        "define it in remap.py, and import remap in the file that [PYTHON]TOPLEVEL names");
        }
    }
    return {};
}

Result<> Scripts::load(const Settings &settings, const Remaps &remaps, const BuiltIns &built_ins,
                       InterpreterView &view) {
    const ScriptSettings &wanted = settings.scripts;
    warnings_ = remaps.refused();
    if (!wanted.top_level.empty()) {
        if (Result<> made = need("[PYTHON]TOPLEVEL", wanted.place, settings, view); !made) {
            return made;
        }
    }
    for (const Remap &remap : remaps.all()) {
        if (remap.needsScripts() && wanted.top_level.empty()) {
            return fail(fmt::format("REMAP of {} uses a Python function, but [PYTHON]TOPLEVEL is missing",
                                    remap.name),
                        remap.place, "TOPLEVEL names the script that imports the module remap");
        }
        if (Result<> checked = check(remap); !checked) {
            return checked;
        }
    }
    if (host_ == nullptr) {
        return {};
    }
    for (std::string &name : host_->named_parameters()) {
        if (built_ins.isBuiltInName(name)) {
            warnings_.push_back(fmt::format("Python redefines the named parameter #<{}>", name));
        }
        names_.push_back(std::move(name));
    }
    return {};
}

Result<> Scripts::begin() {
    ++depth_;
    Result<> begun = host_->begin();
    --depth_;
    return begun;
}

ScriptOutcome Scripts::call(ScriptModule module, const std::string &name, const ScriptArguments &arguments,
                            std::unique_ptr<SuspendedScript> &rest) {
    if (limits_.are_scripts_forbidden) {
        return forbidden();
    }
    error_text.clear();
    ++depth_;
    ++calls_;
    ScriptOutcome outcome = host_->call(module, name, arguments, rest);
    --depth_;
    return outcome;
}

ScriptOutcome Scripts::resume(SuspendedScript &script) {
    ++depth_;
    ++calls_;
    ScriptOutcome outcome = script.resume();
    --depth_;
    return outcome;
}

ScriptOutcome Scripts::run_text(std::string_view text) {
    if (limits_.are_scripts_forbidden) {
        return forbidden();
    }
    ++depth_;
    ++calls_;
    ScriptOutcome outcome = host_->run_text(text);
    --depth_;
    return outcome;
}

bool Scripts::hasName(std::string_view name) const {
    return std::ranges::find(names_, name) != names_.end();
}

std::optional<double> Scripts::value_of(std::string_view name) {
    if (limits_.are_scripts_forbidden) {
        fault_.set(FORBIDDEN);
        return std::nullopt;
    }
    const bool was_reading = is_reading_name_;
    is_reading_name_ = true;
    ++calls_;
    const Result<double> value = host_->named_parameter(std::string(name));
    is_reading_name_ = was_reading;
    if (!value) {
        fault_.set(value.error().message);
        return std::nullopt;
    }
    return *value;
}

}  // namespace mw::gcode::detail
