// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/python_host/python_host.hh"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "gcode/python_host/modules.hh"

namespace mw::python_host {

using gcode::ScriptModule;
using gcode::ScriptOutcome;
using Kind = ScriptOutcome::Kind;

namespace {

constexpr int CODE_EXIT = 1, CODE_MIN_ERROR = 3;

const char *module_name(ScriptModule module) {
    return module == ScriptModule::REMAP ? "remap" : "oword";
}

py::dict loaded_modules() {
    return py::module_::import("sys").attr("modules");
}

/// File name as Python uses it: absolute, without dots.
std::string full_path(const std::string &folder) {
    std::error_code ignored;
    std::string out = std::filesystem::absolute(folder, ignored).lexically_normal().string();
    while (out.size() > 1 && out.back() == '/') {
        out.pop_back();
    }
    return out;
}

/// The initial sys.path of Python, with our own folders at its end.
py::list base_path() {
    static const py::handle PATH = py::list(py::module_::import("sys").attr("path")).release();
    return py::reinterpret_borrow<py::list>(PATH);
}

}  // namespace

const PythonHost *PythonHost::active = nullptr;
int PythonHost::hosts = 0;
int PythonHost::entries = 0;

/// Scope of a call from the interpreter: the GIL, the current view, and this host's modules.
class PythonHost::Entry {
  public:
    explicit Entry(const PythonHost &host) : scope_(*host.view_) {
        const bool outermost = entries++ == 0;
        if (outermost && host.interrupter_ != nullptr) {
            interrupter_ = host.interrupter_.get();
            interrupter_->enter();
        }
        if (outermost && isForeignPython()) {
            path_ = py::module_::import("sys").attr("path");
            main_ = loaded_modules()["__main__"];
        }
        host.activate();
    }
    ~Entry() {
        if (interrupter_ != nullptr) {
            interrupter_->leave();
        }
        if (--entries == 0 && path_) {
            py::module_::import("sys").attr("path") = path_;
            loaded_modules()["__main__"] = main_;
        }
    }
    Entry(const Entry &) = delete;
    Entry &operator=(const Entry &) = delete;

  private:
    py::gil_scoped_acquire gil_;
    CurrentScope scope_;
    Interrupter *interrupter_ = nullptr;  ///< interrupter of the outermost scope
    py::object path_, main_;              ///< original sys.path and main module of the process, if Python is
                                          ///< its own
};

/// A generator suspended at its yield.
class SuspendedPython final : public gcode::SuspendedScript {
  public:
    SuspendedPython(PythonHost &host, py::object generator, std::string label, bool is_o_word)
        : host_(host), generator_(std::move(generator)), label_(std::move(label)), is_o_word_(is_o_word) {}

    ~SuspendedPython() override {
        const PythonHost::Entry entry(host_);
        if (!generator_.is_none()) {
            try {
                generator_.attr("close")();
            } catch (py::error_already_set &error) {
                std::fprintf(stderr, "%s\n", error_text(error, host_.settings_.log_level).c_str());
            }
        }
        generator_.release().dec_ref();
    }
    SuspendedPython(const SuspendedPython &) = delete;
    SuspendedPython &operator=(const SuspendedPython &) = delete;

    ScriptOutcome resume() override {
        const PythonHost::Entry entry(host_);
        return generator_.is_none() ? ScriptOutcome{} : host_.advance(generator_, label_, is_o_word_);
    }

  private:
    PythonHost &host_;
    py::object generator_;  ///< None: a function has returned INTERP_EXECUTE_FINISH
    std::string label_;
    bool is_o_word_;
};

PythonHost::PythonHost() {
    start_python();
    const py::gil_scoped_acquire gil;
    ++hosts;
    add_own_modules();
    base_path();
    add_native_modules();
    self_ = py::none();
    main_ = py::none();
    modules_ = py::dict();
    path_ = py::list();
}

void PythonHost::follow(gcode::ScriptStop &stop) {
    if (!isForeignPython()) {
        interrupter_ = std::make_unique<Interrupter>(stop);
    }
}

PythonHost::~PythonHost() {
    interrupter_.reset();
    if (view_ != nullptr) {
        const Entry entry(*this);
        if (const Result<> ended = call_hook("__delete__"); !ended) {
            std::fprintf(stderr, "%s\n", ended.error().message.c_str());
        }
    }
    const py::gil_scoped_acquire gil;
    if (active == this) {
        stash();
        active = nullptr;
        py::module_::import("interpreter").attr("this") = py::none();
    }
    --hosts;
    if (hosts == 0 && !isForeignPython()) {
        run_exit_functions();
    }
    if (handle_ != nullptr) {
        handle_->view = nullptr;
    }
    for (py::object *object : {&self_, &main_, &modules_, &path_}) {
        *object = py::object();
    }
}

// ---------------------------------------------------------------------------------------- own modules

bool PythonHost::isOwnModule(const py::handle &module) const {
    if (!py::hasattr(module, "__file__") || module.attr("__file__").is_none()) {
        return false;
    }
    const std::string file = py::str(module.attr("__file__"));
    for (const py::handle folder : py::list(path_)) {
        const std::string name = py::str(folder);
        if (!base_path().contains(folder) && file.starts_with(name + "/")) {
            return true;
        }
    }
    return false;
}

/// Removes this host's modules from sys.modules, so that another host loads its own modules of the same
/// names.
void PythonHost::stash() const {
    py::dict loaded = loaded_modules();
    py::dict own = modules_;
    own.clear();
    for (const auto &[name, module] : py::dict(loaded.attr("copy")())) {
        if (isOwnModule(module)) {
            own[name] = module;
            loaded.attr("pop")(name);
        }
    }
}

void PythonHost::activate() const {
    if (active == this && !isForeignPython()) {
        return;
    }
    if (active != nullptr && active != this) {
        active->stash();
    }
    if (active != this) {
        active = this;
        loaded_modules().attr("update")(modules_);
    }
    loaded_modules()["__main__"] = main_;
    py::module_::import("sys").attr("path") = path_;
    py::module_::import("interpreter").attr("this") = self_;
}

// --------------------------------------------------------------------------------------------- loading

Result<> PythonHost::load(const gcode::ScriptSettings &settings, gcode::InterpreterView &view) {
    settings_ = settings;
    settings_.top_level = settings.top_level.empty() ? "" : full_path(settings.top_level);
    view_ = &view;
    handle_ = std::make_shared<ViewHandle>();
    handle_->view = &view;
    const py::gil_scoped_acquire gil;
    try {
        main_ = py::module_::import("types").attr("ModuleType")("__main__");
        main_.attr("__builtins__") = py::module_::import("builtins");
        py::list path;
        for (const std::string &folder : settings.path_prepend) {
            path.append(full_path(folder));
        }
        for (const py::handle folder : base_path()) {
            path.append(folder);
        }
        for (const std::string &folder : settings.path_append) {
            path.append(full_path(folder));
        }
        path_ = path;
        const Entry entry(*this);
        self_ = make_interpreter(handle_);
        main_.attr("this") = self_;
        main_.attr("self") = self_;
        py::module_::import("interpreter").attr("this") = self_;
        run_top_level();
    } catch (py::error_already_set &error) {
        return fail(fmt::format("[PYTHON]TOPLEVEL={} failed: {}", settings.top_level,
                                error_text(error, settings.log_level)));
    } catch (const std::exception &error) {
        return fail(error.what());
    }
    return {};
}

void PythonHost::run_top_level() {
    if (settings_.top_level.empty()) {
        return;
    }
    const Result<std::string> text = read_file(settings_.top_level);
    if (!text) {
        throw std::runtime_error(text.error().str());
    }
    main_.attr("__file__") = settings_.top_level;
    const py::object code =
        py::module_::import("builtins").attr("compile")(*text, settings_.top_level, "exec");
    py::module_::import("builtins").attr("exec")(code, main_.attr("__dict__"));
    if (!settings_.reloading) {
        return;
    }
    std::error_code ignored;
    times_.clear();
    times_[settings_.top_level] = std::filesystem::last_write_time(settings_.top_level, ignored);
    for (const auto &[name, module] : loaded_modules()) {
        if (isOwnModule(module)) {
            const std::string file = py::str(module.attr("__file__"));
            times_[file] = std::filesystem::last_write_time(file, ignored);
        }
    }
}

void PythonHost::reload_if_changed() {
    bool changed = false;
    for (const auto &[file, time] : times_) {
        std::error_code missing;
        const auto now = std::filesystem::last_write_time(file, missing);
        changed = changed || (!missing && now != time);
    }
    if (changed) {
        stash();
        modules_.attr("clear")();
        py::module_::import("importlib").attr("invalidate_caches")();
        run_top_level();
    }
}

Result<> PythonHost::call_hook(const char *name) {
    try {
        const py::dict names = main_.attr("__dict__");
        if (names.contains(name)) {
            names[name](self_);
        }
    } catch (py::error_already_set &error) {
        return fail(fmt::format("{} of {} failed: {}", name, settings_.top_level,
                                error_text(error, settings_.log_level)),
                    settings_.place);
    }
    return {};
}

Result<> PythonHost::begin() {
    const Entry entry(*this);
    return call_hook("__init__");
}

// --------------------------------------------------------------------------------------------- calling

/// A callable of a module that the top-level script has imported; none if it does not exist.
py::object PythonHost::find_function(const char *module, std::string_view name) const {
    const py::dict names = main_.attr("__dict__");
    const std::string text(name);
    if (!names.contains(module) || !py::hasattr(names[module], text.c_str())) {
        return {};
    }
    py::object found = names[module].attr(text.c_str());
    return PyCallable_Check(found.ptr()) != 0 ? found : py::object();
}

bool PythonHost::hasFunction(ScriptModule module, std::string_view name) const {
    const Entry entry(*this);
    return static_cast<bool>(find_function(module_name(module), name));
}

ScriptOutcome PythonHost::failed(std::string message) const {
    return {Kind::FAILED, 0.0, std::move(message)};
}

ScriptOutcome PythonHost::call(ScriptModule module, const std::string &name,
                               const gcode::ScriptArguments &arguments,
                               std::unique_ptr<gcode::SuspendedScript> &rest) {
    const Entry entry(*this);
    try {
        reload_if_changed();
        const py::object function = find_function(module_name(module), name);
        const std::string label = fmt::format("{}.{}", module_name(module), name);
        if (!function) {
            return failed(fmt::format("there is no Python function {}", label));
        }
        py::list positional;
        positional.append(self_);
        for (const double value : arguments.positional) {
            positional.append(value);
        }
        py::dict words;
        for (const auto &[word, value] : arguments.words) {
            words[word.c_str()] = value;
        }
        const py::object result = function(*positional, **words);
        return outcome_of(result, label, module == ScriptModule::OWORD, rest);
    } catch (py::error_already_set &error) {
        return failed(error_text(error, settings_.log_level));
    } catch (const std::exception &error) {
        return failed(error.what());
    }
}

ScriptOutcome PythonHost::outcome_of(const py::object &result, const std::string &label, bool is_o_word,
                                     std::unique_ptr<gcode::SuspendedScript> &rest) {
    ScriptOutcome outcome;
    py::object generator = py::none();
    if (PyGen_Check(result.ptr())) {
        generator = result;
        outcome = advance(result, label, is_o_word);
    } else {
        outcome = number_outcome(result, label, is_o_word);
    }
    if (outcome.kind == Kind::WAITING) {
        rest = std::make_unique<SuspendedPython>(*this, std::move(generator), label, is_o_word);
    }
    return outcome;
}

/// Runs a generator to its next yield or its end.
ScriptOutcome PythonHost::advance(const py::object &generator, const std::string &label, bool is_o_word) {
    try {
        const py::object yielded = generator.attr("__next__")();
        const ScriptOutcome outcome = number_outcome(yielded, label, is_o_word);
        if (outcome.kind != Kind::WAITING) {
            generator.attr("close")();
        }
        return outcome;
    } catch (py::error_already_set &error) {
        if (error.matches(PyExc_StopIteration)) {
            return number_outcome(error.value().attr("value"), label, is_o_word);
        }
        return failed(error_text(error, settings_.log_level));
    }
}

/// Converts the result of a function: nothing, an INTERP_ code, a number (the value of an O word), or a text
/// (an error).
ScriptOutcome PythonHost::number_outcome(const py::object &result, const std::string &label,
                                         bool is_o_word) const {
    if (result.is_none()) {
        return {};
    }
    if (py::isinstance<py::str>(result)) {
        return failed(result.cast<std::string>());
    }
    const py::object code_type = py::module_::import("interpreter").attr("InterpReturn");
    const bool is_code =
        py::isinstance(result, code_type) || (py::isinstance<py::int_>(result) && !is_o_word);
    if (is_code) {
        const int code = result.cast<int>();
        if (code >= CODE_MIN_ERROR) {
            const auto set = view_->attribute("errormsg");
            const std::string text = set ? std::get<std::string>(*set) : std::string();
            return failed(text.empty() ? fmt::format("Python function {} returned an error without a text: "
                                                     "return a text, or call set_errormsg()",
                                                     label)
                                       : text);
        }
        return {code == CODE_OK               ? Kind::DONE
                : code == CODE_EXECUTE_FINISH ? Kind::WAITING
                : code == CODE_EXIT           ? Kind::EXIT
                                              : Kind::DONE,
                0.0,
                {}};
    }
    if (py::isinstance<py::int_>(result) || py::isinstance<py::float_>(result)) {
        const double value = result.cast<double>();
        return std::isfinite(value) ? ScriptOutcome{Kind::VALUE, value, {}}
                                    : failed(fmt::format("Python function {} returned {}", label, value));
    }
    return failed(
        fmt::format("Python function {} returned an object of type {}: expected are INTERP_OK, nothing, "
                    "a number, a text (an error), or a generator",
                    label, std::string(py::str(py::type::of(result).attr("__name__")))));
}

ScriptOutcome PythonHost::run_text(std::string_view text) {
    const Entry entry(*this);
    try {
        const py::object code =
            py::module_::import("builtins").attr("compile")(std::string(text), ";py,", "exec");
        py::module_::import("builtins").attr("exec")(code, main_.attr("__dict__"));
    } catch (py::error_already_set &error) {
        return failed(error_text(error, settings_.log_level));
    }
    return {};
}

std::vector<std::string> PythonHost::named_parameters() const {
    const Entry entry(*this);
    std::vector<std::string> out;
    const py::dict names = main_.attr("__dict__");
    if (!names.contains("namedparams")) {
        return out;
    }
    for (const auto &[name, value] : py::dict(names["namedparams"].attr("__dict__"))) {
        std::string text = py::str(name);
        if (text.starts_with("_") && !text.starts_with("__") && PyCallable_Check(value.ptr()) != 0) {
            out.push_back(std::move(text));
        }
    }
    return out;
}

Result<double> PythonHost::named_parameter(const std::string &name) {
    const Entry entry(*this);
    try {
        const py::object function = find_function("namedparams", name);
        const py::object result = function ? function(self_) : py::none();
        if (py::isinstance<py::str>(result)) {
            return fail(result.cast<std::string>());
        }
        if (py::isinstance<py::float_>(result) || py::isinstance<py::int_>(result)) {
            return result.cast<double>();
        }
        return fail(fmt::format("Python function namedparams.{} returns no number", name));
    } catch (py::error_already_set &error) {
        return fail(error_text(error, settings_.log_level));
    }
}

}  // namespace mw::python_host

extern "C" __attribute__((visibility("default"))) int millwright_script_host(int version,
                                                                             mw::gcode::ScriptHost **host) {
    if (version != mw::gcode::SCRIPT_HOST_VERSION) {
        return 0;
    }
    *host = new mw::python_host::PythonHost();
    return 1;
}
