// SPDX-License-Identifier: GPL-2.0-or-later
// gcode.parse: interprets a program with a canon object.
#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "base/ini/ini_file.hh"
#include "clients/python/gcode/canon.hh"
#include "gcode/interpreter/ini_settings.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// Result codes of parse, as preview programs read them: numbers above MIN_ERROR are errors.
enum Code {
    CODE_OK = 0,
    CODE_EXIT = 1,
    CODE_EXECUTE_FINISH = 2,
    CODE_ENDFILE = 3,
    CODE_FILE_NOT_OPEN = 4,
    CODE_ERROR = 5
};
constexpr const char *CODE_TEXTS[] = {"done", "the program has ended", "the machine is to finish",
                                      "the file has ended", "no file is open"};

constexpr const char *LAST_ERROR = "_last_error";
/// Interval of checks whether the canon object continues.
constexpr std::chrono::milliseconds ASK_EVERY{100};
constexpr int STEPS_PER_LOOK = 64;

[[noreturn]] void throw_runtime(const std::string &text) {
    PyErr_SetString(PyExc_RuntimeError, text.c_str());
    throw py::error_already_set();
}

double number_from(const py::object &canon, const char *method, double preset) {
    return py::hasattr(canon, method) ? py::float_(canon.attr(method)()).cast<double>() : preset;
}

class Parse {
  public:
    Parse(const py::object &canon, const py::handle &module)
        : object_(canon), module_(module), canon_(canon, tools_) {}

    std::pair<int, int> run(const std::string &file, const std::vector<std::string> &codes) {
        prepare();
        check(interpreter_->begin());
        for (const std::string &code : codes) {
            if (!run_code(code)) {
                return failed(1);
            }
        }
        if (file.empty()) {  // only the codes
            canon_.finish_batch();
            return {CODE_OK, 0};
        }
        check(interpreter_->open(file));
        const std::pair<int, int> result = run_file();
        canon_.finish_batch();
        return result;
    }

  private:
    void check(const Result<> &result) {
        rethrow();
        if (!result) {
            throw_runtime(result.error().str());
        }
    }
    void rethrow() {
        if (canon_.hasException()) {
            throw canon_.take_exception();
        }
    }

    void prepare() {
        diagnostics::Sink problems;
        gcode::Settings settings;
        if (const char *ini = std::getenv("INI_FILE_NAME"); ini != nullptr && *ini != '\0') {
            auto loaded = ini::IniFile::load(ini, problems);
            if (!loaded) {
                throw_runtime(loaded.error().str());
            }
            ini_ = std::move(*loaded);
            ini::IniReader reader(*ini_, problems);
            settings = gcode::settings_from_ini(reader);
            world_.ini = [this](std::string_view section, std::string_view key) {
                return gcode::ini_number(*ini_, section, key);
            };
        }
        settings.startup_code.clear();  // the owner of the canon defines the start-up codes
        settings.user_code_assumed = true;
        settings.initial_units = gcode::LengthUnits::INCH;
        // Preview programs use the inverse of the unit in millimetres: 1 is mm.
        constexpr double BETWEEN_UNITS = 0.5;
        const double units = number_from(object_, "get_external_length_units", 1.0);
        world_.units = units < BETWEEN_UNITS ? gcode::LengthUnits::INCH : gcode::LengthUnits::MM;
        world_.isBlockDelete = number_from(object_, "get_block_delete", 0.0) != 0;
        world_.mask = static_cast<unsigned>(number_from(object_, "get_axis_mask", 0x1ff));
        world_.state.current_pocket = 0;
        tools_.ask(object_);
        world_.state.tool_in_spindle = std::max(0, tools_.entry(0).toolno);
        interpreter_.emplace(canon_, world_, tools_, world_, settings);
        if (py::hasattr(object_, "parameter_file")) {
            const auto path = object_.attr("parameter_file").cast<std::string>();
            check(path.empty() ? Result<>{} : interpreter_->load_parameters(path));
        }
    }

    /// Runs lines of MDI; false if a line fails.
    bool run_code(std::string_view code) {
        while (!code.empty()) {
            const std::size_t end = std::min(code.find('\n'), code.size());
            canon_.set_codes(interpreter_->active_codes());
            gcode::Step step = interpreter_->execute(code.substr(0, end));
            while (step == gcode::Step::OK || step == gcode::Step::SYNC) {
                step = interpreter_->step();
            }
            rethrow();
            if (step == gcode::Step::FAILED) {
                return false;
            }
            code.remove_prefix(std::min(end + 1, code.size()));
        }
        return true;
    }

    std::pair<int, int> run_file() {
        auto asked = std::chrono::steady_clock::now();
        for (int steps = 1;; ++steps) {
            canon_.set_codes(interpreter_->active_codes());
            const gcode::Step step = interpreter_->step();
            rethrow();
            if (step == gcode::Step::FAILED) {
                return failed(interpreter_->error().what.place.line);
            }
            if (step == gcode::Step::PROGRAM_END || step == gcode::Step::FILE_END) {
                return {step == gcode::Step::PROGRAM_END ? CODE_EXIT : CODE_ENDFILE, interpreter_->line()};
            }
            const auto now = std::chrono::steady_clock::now();
            if (steps % STEPS_PER_LOOK == 0 && now - asked >= ASK_EVERY) {
                asked = now;
                look_around();
            }
        }
    }

    void look_around() {
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
        if (py::hasattr(object_, "check_abort") && py::bool_(object_.attr("check_abort")())) {
            PyErr_SetString(PyExc_KeyboardInterrupt, "Load aborted");
            throw py::error_already_set();
        }
    }

    std::pair<int, int> failed(int line) {
        canon_.finish_batch();
        const diagnostics::Diagnostic &error = interpreter_->error();
        module_.attr(LAST_ERROR) = error.what.message;
        return {CODE_ERROR, line};
    }

    /// A machine at the origin, with the axes that the canon object names.
    class PreviewWorld final : public gcode::Standalone {
      public:
        unsigned mask = 0x1ff;
        unsigned axis_mask() const override { return mask == 0 ? 0x1ffU : mask; }
    };

    py::object object_;
    py::handle module_;
    PreviewWorld world_;
    PythonTools tools_;
    PythonCanon canon_;
    std::optional<ini::IniFile> ini_;
    std::optional<gcode::Interpreter> interpreter_;
};

std::string text_of(const py::object &code) {
    return code.is_none() ? std::string() : code.cast<std::string>();
}

/// A text, or a list of texts.
std::vector<std::string> codes_of(const py::object &codes) {
    if (!py::isinstance<py::list>(codes) && !py::isinstance<py::tuple>(codes)) {
        return {text_of(codes)};
    }
    std::vector<std::string> out;
    for (const py::handle code : codes) {
        out.push_back(text_of(py::reinterpret_borrow<py::object>(code)));
    }
    return out;
}

}  // namespace

void define_parse(py::module_ &module) {
    module.attr("MIN_ERROR") = static_cast<int>(CODE_ENDFILE);
    module.attr("MAX_ERROR") = -1;
    module.attr(LAST_ERROR) = "";
    const py::handle self = module;
    module.def(
        "parse",
        [self](const std::string &file, const py::object &canon, const py::object &unitcode,
               const py::object &initcode, const py::object &interpname) {
            // The arguments may also be (file, canon, [code, ...], interpname); the fourth argument is then
            // the name.
            const bool is_list = py::isinstance<py::list>(unitcode) || py::isinstance<py::tuple>(unitcode);
            const std::string name = text_of(is_list ? initcode : interpname);
            if (!name.empty()) {
                throw_runtime("gcode.parse: interpreters other than the built-in one are not supported, but "
                              "interpname is '" +
                              name + "'");
            }
            std::vector<std::string> codes = codes_of(unitcode);
            if (!is_list) {
                codes.push_back(text_of(initcode));
            }
            return Parse(canon, self).run(file, codes);
        },
        py::arg("file"), py::arg("canon"), py::arg("unitcode") = "", py::arg("initcode") = "",
        py::arg("interpname") = "",
        "parse(file, canon, unitcode='', initcode='', interpname='') -> (result, line)\n"
        "parse(file, canon, [code, ...], interpname='') -> (result, line)\n\n"
        "An empty file name: the codes alone. "
        "Interprets a program and calls the canon object's methods. A result above MIN_ERROR is an error, in "
        "`line` of the file; strerror(result) is its text. An exception in a method ends the program.");
    module.def(
        "strerror",
        [self](int code) -> py::object {
            if (code == CODE_ERROR) {
                return self.attr(LAST_ERROR);
            }
            if (code < CODE_OK || code > CODE_ERROR) {
                return py::str(fmt::format("unknown result {}", code));
            }
            return py::str(CODE_TEXTS[code]);
        },
        py::arg("result"), "What a result of parse means; for an error, the message of the last one.");
}

}  // namespace mw::python
