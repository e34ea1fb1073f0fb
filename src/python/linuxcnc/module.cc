// SPDX-License-Identifier: GPL-2.0-or-later
// The extension behind `import linuxcnc` (python/linuxcnc/__init__.py): INI files.
#include <pybind11/pybind11.h>

#include <fmt/format.h>

#include "base/text.hh"
#include "config/ini_file.hh"
#include "config/ini_value.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

[[noreturn]] void throw_error(const std::string &text) {
    const py::object error = py::module_::import("linuxcnc").attr("error");
    PyErr_SetString(error.ptr(), text.c_str());
    throw py::error_already_set();
}

/// An INI file as it was when it was opened.
class Ini {
  public:
    explicit Ini(const std::string &path) : file_(load(path)) {}

    /// The value, or None when there is none or it is empty.
    py::object find(const std::string &section, const std::string &key, int number) const {
        const config::IniEntry *entry = file_.find(section, key, number < 1 ? 1 : number);
        return entry == nullptr || entry->value.empty() ? py::object(py::none()) : py::str(entry->value);
    }
    py::list find_all(const std::string &section, const std::string &key) const {
        py::list out;
        for (const config::IniEntry *entry : file_.find_all(section, key)) {
            if (!entry->value.empty()) {
                out.append(py::str(entry->value));
            }
        }
        return out;
    }
    bool hasSection(const std::string &section) const { return file_.hasSection(section); }
    bool hasVariable(const std::string &section, const std::string &key, int number) const {
        return file_.find(section, key, number) != nullptr;
    }
    py::list sections() const { return list_of(file_.sections()); }
    py::list variables(const py::object &section) const {
        if (!section.is_none()) {
            return list_of(file_.keys(section.cast<std::string>()));
        }
        py::list out;
        for (const std::string &name : file_.sections()) {
            for (const std::string &key : file_.keys(name)) {
                out.append(py::make_tuple(name, key));
            }
        }
        return out;
    }
    py::tuple line_of(const std::string &section, const std::string &key, int number) const {
        const config::IniEntry *entry = file_.find(section, key, number);
        if (entry == nullptr) {
            missing(section, key, number);
        }
        return py::make_tuple(entry->place.file, entry->place.line);
    }

    /// A value of one type; `read` says what its text means, nothing when it is another type's.
    template <class Reader>
    py::object value(const std::string &section, const std::string &key, int number,
                     const py::object &fallback, const char *type, Reader read) const {
        const config::IniEntry *entry = file_.find(section, key, number);
        if (entry == nullptr) {
            if (fallback.is_none()) {
                missing(section, key, number);
            }
            return fallback;
        }
        const auto result = read(entry->value);
        if (!result) {
            throw_error(fmt::format("{}: [{}]{} = '{}' is no {}", entry->place.str(), section, key,
                                    entry->value, type));
        }
        return py::cast(*result);
    }

  private:
    static config::IniFile load(const std::string &path) {
        diag::Sink ignored;  // what else is wrong with the file is told by the machine that runs it
        auto file = config::IniFile::load(path, ignored);
        if (!file) {
            throw_error(file.error().str());
        }
        return std::move(*file);
    }
    static py::list list_of(const std::vector<std::string> &names) {
        py::list out;
        for (const std::string &name : names) {
            out.append(py::str(name));
        }
        return out;
    }
    [[noreturn]] void missing(const std::string &section, const std::string &key, int number) const {
        throw_error(fmt::format("{}: there is no [{}]{}{}", file_.path(), section, key,
                                number > 1 ? fmt::format(" with number {}", number) : std::string()));
    }

    config::IniFile file_;
};

std::optional<std::string> same_text(const std::string &text) {
    return text;
}

/// One method that reads a typed value, under each of its names.
template <class Reader>
void define_getter(py::class_<Ini> &ini, std::initializer_list<const char *> names, const char *type,
                   Reader read) {
    for (const char *name : names) {
        ini.def(
            name,
            [type, read](const Ini &self, const std::string &section, const std::string &variable, int num,
                         const py::object &fallback) {
                return self.value(section, variable, num, fallback, type, read);
            },
            py::arg("section"), py::arg("variable"), py::arg("num") = 1, py::kw_only(),
            py::arg("fallback") = py::none(),
            "The num-th value; fallback when there is none, linuxcnc.error without one or when it is another "
            "type's.");
    }
}

}  // namespace
}  // namespace mw::python

PYBIND11_MODULE(_core, module) {
    using mw::python::Ini;
    module.doc() = "INI files from Python; see the package linuxcnc.";
    py::class_<Ini> ini(module, "ini", "ini(path): an INI file. linuxcnc.error when it cannot be read.");
    ini.def(py::init<const std::string &>(), py::arg("path"))
        .def("find", &Ini::find, py::arg("section"), py::arg("variable"), py::arg("num") = 1,
             "The num-th value as text, None when there is none or it is empty.")
        .def("findall", &Ini::find_all, py::arg("section"), py::arg("variable"), "All values, as a list.")
        .def("hassection", &Ini::hasSection, py::arg("section"))
        .def("hasvariable", &Ini::hasVariable, py::arg("section"), py::arg("variable"), py::arg("num") = 1)
        .def("getsections", &Ini::sections, "The names of all sections, in their order.")
        .def("getvariables", &Ini::variables, py::arg("section") = py::none(),
             "The names in a section; without one, tuples (section, name).")
        .def("lineof", &Ini::line_of, py::arg("section"), py::arg("variable"), py::arg("num") = 1,
             "(file, line) of a value, which may be in an included file.");
    mw::python::define_getter(ini, {"getbool"}, "bool",
                              [](const std::string &t) { return mw::config::ini_bool(t); });
    mw::python::define_getter(ini, {"getsint", "getint"}, "integer",
                              [](const std::string &t) { return mw::parse_int(t); });
    mw::python::define_getter(ini, {"getuint"}, "integer from 0",
                              [](const std::string &t) { return mw::parse_uint(t); });
    mw::python::define_getter(ini, {"getreal", "getfloat"}, "number",
                              [](const std::string &t) { return mw::parse_double(t); });
    mw::python::define_getter(ini, {"getstring"}, "text", &mw::python::same_text);
}
