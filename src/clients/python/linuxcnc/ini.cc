// SPDX-License-Identifier: GPL-2.0-or-later
// INI files for scripts.
#include <pybind11/stl.h>

#include <fmt/format.h>

#include "base/ini/ini_escape.hh"
#include "base/ini/ini_file.hh"
#include "base/ini/ini_script.hh"
#include "clients/python/linuxcnc/module.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// An INI file, as it was when opened.
class Ini {
  public:
    explicit Ini(const std::string &path) : file_(load(path)) {}

    /// The value; None if the key is not set or its value is empty.
    py::object find(const std::string &section, const std::string &key, int number) const {
        const ini::IniEntry *entry = file_.find(section, key, number < 1 ? 1 : number);
        return entry == nullptr || entry->value.empty() ? py::object(py::none()) : py::str(text_of(*entry));
    }
    /// All values of a key, or of the whole section if the key is empty.
    py::list find_all(const std::string &section, const std::string &key) const {
        py::list out;
        for (const ini::IniEntry &entry : file_.entries()) {
            const bool wanted = entry.section == section && (key.empty() || entry.key == key);
            if (wanted && !entry.value.empty()) {
                out.append(py::str(text_of(entry)));
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
        const bool of_all = section.is_none();
        const std::string name = of_all ? std::string() : section.cast<std::string>();
        py::list out;
        for (const ini::IniEntry &entry : file_.entries()) {
            if (of_all || entry.section == name) {
                out.append(py::make_tuple(entry.key, text_of(entry)));
            }
        }
        return out;
    }
    py::tuple line_of(const std::string &section, const std::string &key, int number) const {
        const ini::IniEntry *entry = file_.find(section, key, number);
        return entry == nullptr ? py::make_tuple(py::none(), py::none())
                                : py::make_tuple(entry->place.file, entry->place.line);
    }

    /// A value of one type; `read` converts it and reports an error.
    template <class Reader>
    py::object value(const std::string &section, const std::string &key, int number,
                     const py::object &fallback, Reader read) const {
        const ini::IniEntry *entry = file_.find(section, key, number);
        if (entry == nullptr) {
            return fallback;
        }
        std::string messages;
        ini::IniEntry decoded = *entry;
        decoded.value = text_of(*entry);
        const auto result = read(decoded, messages);
        if (!messages.empty()) {
            py::module_::import("sys").attr("stderr").attr("write")(messages);
        }
        return py::cast(result);  // None if the value has another type, never the fallback
    }

  private:
    static ini::IniFile load(const std::string &path) {
        diagnostics::Sink ignored;  // the machine that runs the file reports other errors
        auto file = ini::IniFile::load(path, ignored);
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
    /// The value with its escapes replaced.
    static std::string text_of(const ini::IniEntry &entry) {
        auto text = ini::decode_ini_value(entry.value);
        if (!text) {
            throw_error(ini::script_place(entry.place) + "error: " + text.error().message);
        }
        return *std::move(text);
    }

    ini::IniFile file_;
};

std::optional<std::string> script_text(const ini::IniEntry &entry, std::string &) {
    return entry.value;
}

/// Defines one method that reads a typed value, under each of its names.
template <class Reader>
void define_getter(py::class_<Ini> &ini, std::initializer_list<const char *> names, Reader read) {
    for (const char *name : names) {
        ini.def(
            name,
            [read](const Ini &self, const std::string &section, const std::string &variable, int num,
                   const py::object &fallback) { return self.value(section, variable, num, fallback, read); },
            py::arg("section"), py::arg("variable"), py::arg("num") = 1, py::kw_only(),
            py::arg("fallback") = py::none(),
            "The num-th value; fallback when there is none, None (with a message on stderr) when it is "
            "another "
            "type's.");
    }
}

}  // namespace

void define_ini(py::module_ &module) {
    py::class_<Ini> ini(module, "ini", "ini(path): an INI file. linuxcnc.error when it cannot be read.");
    ini.def(py::init<const std::string &>(), py::arg("path"))
        .def("find", &Ini::find, py::arg("section"), py::arg("variable"), py::arg("num") = 1,
             "The num-th value as text, None when there is none or it is empty.")
        .def("findall", &Ini::find_all, py::arg("section"), py::arg("variable"),
             "All values, as a list; with an empty variable, those of the whole section.")
        .def("hassection", &Ini::hasSection, py::arg("section"))
        .def("hasvariable", &Ini::hasVariable, py::arg("section"), py::arg("variable"), py::arg("num") = 1)
        .def("getsections", &Ini::sections, "The names of all sections, in their order.")
        .def("getvariables", &Ini::variables, py::arg("section") = py::none(),
             "Tuples (name, value) of a section; without one, of all sections.")
        .def("lineof", &Ini::line_of, py::arg("section"), py::arg("variable"), py::arg("num") = 1,
             "(file, line) of a value, which may be in an included file; (None, None) when there is none.");
    define_getter(ini, {"getbool"}, &ini::script_bool);
    define_getter(ini, {"getsint", "getint"}, &ini::script_signed);
    define_getter(ini, {"getuint"}, &ini::script_unsigned);
    define_getter(ini, {"getreal", "getfloat"}, &ini::script_real);
    define_getter(ini, {"getstring"}, &script_text);
}

}  // namespace mw::python
