// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/python_host/runtime.hh"

#include <dlfcn.h>
#include <pybind11/embed.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "base/own_place.hh"
#include "gcode/python_host/interrupter.hh"

namespace mw::python_host {
namespace {

bool started = false, foreign = false;

/// Sends Python's standard output and error through the C library's, so that its lines and ours keep their
/// order.
class Stream {
  public:
    explicit Stream(bool is_error) : is_error_(is_error) {}

    std::size_t write(const std::string &text) const {
        if (is_error_) {
            std::fflush(stdout);
        }
        std::fwrite(text.data(), 1, text.size(), is_error_ ? stderr : stdout);
        return text.size();
    }
    void flush() const { std::fflush(is_error_ ? stderr : stdout); }
    int fileno() const { return is_error_ ? 2 : 1; }

  private:
    bool is_error_;
};

void redirect_streams() {
    py::module_ types = py::module_::import("types");
    py::object place = types.attr("ModuleType")("_millwright_streams");
    py::class_<Stream>(place, "Stream")
        .def("write", &Stream::write)
        .def("flush", &Stream::flush)
        .def("fileno", &Stream::fileno)
        .def("isatty", [](const Stream &) { return false; })
        .def_property_readonly("encoding", [](const Stream &) { return "utf-8"; });
    py::module_ sys = py::module_::import("sys");
    sys.attr("stdout") = py::cast(new Stream(false), py::return_value_policy::take_ownership);
    sys.attr("stderr") = py::cast(new Stream(true), py::return_value_policy::take_ownership);
}

/// Disables functions that end the process at once: a script must not end the machine. Its child processes
/// may call them.
void keep_machine_up() {
    py::exec(R"(
import os as _os

def _guarded(name):
    own, end = _os.getpid(), getattr(_os, name)
    def guarded(*arguments):
        if _os.getpid() == own:
            raise RuntimeError(f'os.{name} would end the machine')
        end(*arguments)
    setattr(_os, name, guarded)

for _name in ('_exit', 'abort'):
    _guarded(_name)
)",
             py::dict(py::arg("__builtins__") = py::module_::import("builtins")));
}

std::string own_folder() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void *>(&start_python), &info) == 0 || info.dli_fname == nullptr) {
        return ".";
    }
    return std::filesystem::path(info.dli_fname).parent_path().string();
}

std::string one_line(std::string text) {
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) {
        text.replace(at, 1, "; ");
    }
    return text;
}

std::string type_and_text(const py::error_already_set &error) {
    if (error.matches(script_ended())) {
        return "An abort has ended the script";
    }
    const std::string type = py::str(error.type().attr("__name__"));
    const std::string text = error.value() ? std::string(py::str(error.value())) : std::string();
    if (type == "InterpreterException") {
        return one_line(text);
    }
    return text.empty() ? type : fmt::format("{}: {}", type, one_line(text));
}

/// "file:line in function" for each level, the innermost first.
std::vector<std::string> places_of(const py::error_already_set &error) {
    std::vector<std::string> out;
    if (error.matches(PyExc_SyntaxError) && !error.value().attr("filename").is_none()) {
        out.push_back(fmt::format("{}:{}", std::string(py::str(error.value().attr("filename"))),
                                  std::string(py::str(error.value().attr("lineno")))));
    }
    if (!error.trace()) {
        return out;
    }
    const py::module_ traceback = py::module_::import("traceback");
    const py::list frames = traceback.attr("extract_tb")(error.trace());
    for (py::ssize_t i = static_cast<py::ssize_t>(frames.size()) - 1; i >= 0; --i) {
        const py::object frame = frames[static_cast<std::size_t>(i)];
        const std::string file = py::str(frame.attr("filename"));
        if (file.ends_with("/scripts/interpreter.py") || file.starts_with("<frozen")) {
            continue;  // our own code is of no interest to the author of the script
        }
        const std::string function = py::str(frame.attr("name"));
        out.push_back(fmt::format("{}:{}{}", file, std::string(py::str(frame.attr("lineno"))),
                                  function == "<module>" ? "" : " in " + function));
    }
    return out;
}

/// The Python program of the linked library, so that its modules are found whichever python3 is first in
/// PATH; an active virtual environment takes precedence. Empty: not found.
std::string python_program() {
    namespace fs = std::filesystem;
    std::error_code error;
    if (const char *const environment = std::getenv("VIRTUAL_ENV")) {
        const fs::path program = fs::path(environment) / "bin/python3";
        return fs::exists(program, error) ? program.string() : "";
    }
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void *>(&Py_IsInitialized), &info) == 0 ||
        info.dli_fname == nullptr) {
        return "";
    }
    const std::string name = fmt::format("bin/python{}.{}", PY_MAJOR_VERSION, PY_MINOR_VERSION);
    for (fs::path at = fs::canonical(info.dli_fname, error).parent_path(); at.has_relative_path();
         at = at.parent_path()) {
        if (fs::exists(at / name, error)) {
            return (at / name).string();
        }
    }
    return "";
}

void initialize() {
    PyConfig config;
    PyConfig_InitIsolatedConfig(&config);
    config.isolated = 0;
    config.use_environment = 1;
    config.install_signal_handlers = 0;
    if (const std::string program = python_program(); !program.empty()) {
        (void)PyConfig_SetBytesString(&config, &config.program_name, program.c_str());
    }
    py::initialize_interpreter(&config, 0, nullptr, false);
}

}  // namespace

bool isForeignPython() {
    return foreign;
}

void start_python() {
    if (Py_IsInitialized() != 0) {
        foreign = !started;
        return;
    }
    started = true;
    initialize();
    redirect_streams();
    keep_machine_up();
    PyEval_SaveThread();  // from now on each call takes the GIL
}

void add_own_modules() {
    py::list path = py::module_::import("sys").attr("path");
    const std::string own = own_folder();
    for (const std::string &folder : {own + "/scripts", own + "/python", own + "/../python"}) {
        if (std::filesystem::is_directory(folder) && !path.contains(folder)) {
            path.append(folder);
        }
    }
}

std::string error_text(py::error_already_set &error, int log_level) {
    std::string text;
    try {
        text = type_and_text(error);
        const std::vector<std::string> places = places_of(error);
        if (!places.empty()) {
            text += " (" + places.front();
            for (std::size_t i = 1; i < places.size(); ++i) {
                text += ", called from " + places[i];
            }
            text += ")";
        }
        if (log_level > 0) {
            py::module_::import("traceback")
                .attr("print_exception")(error.type(), error.value(),
                                         error.trace() ? error.trace() : py::none());
        }
    } catch (const std::exception &inner) {
        text = text.empty() ? inner.what() : text;
    }
    return text;
}

void run_exit_functions() {
    try {
        py::module_::import("atexit").attr("_run_exitfuncs")();
    } catch (py::error_already_set &error) {
        std::fprintf(stderr, "%s\n", error_text(error, 0).c_str());
    }
    std::fflush(stdout);
}

}  // namespace mw::python_host
