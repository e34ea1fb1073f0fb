// SPDX-License-Identifier: GPL-2.0-or-later
// Lists of all HAL objects as dicts; hal/query.py creates the enums from the numbers.
#include <pybind11/stl.h>

#include "clients/python/hal/convert.hh"
#include "clients/python/hal/instance.hh"

namespace py = pybind11;

namespace mw::python {

namespace {

py::object text_or_none(const std::string &text) {
    return text.empty() ? py::object(py::none()) : py::object(py::str(text));
}

py::dict dict_of(const hal::PinInfo &pin) {
    return py::dict(py::arg("name") = pin.name, py::arg("original_name") = text_or_none(pin.original_name),
                    py::arg("type") = static_cast<int>(pin.type), py::arg("dir") = static_cast<int>(pin.dir),
                    py::arg("value") = to_python(pin.value), py::arg("comp") = pin.owner,
                    py::arg("comp_id") = pin.owner_id, py::arg("signal") = text_or_none(pin.signal));
}

py::dict dict_of(const hal::ParamInfo &param) {
    return py::dict(py::arg("name") = param.name,
                    py::arg("original_name") = text_or_none(param.original_name),
                    py::arg("type") = static_cast<int>(param.type),
                    py::arg("dir") = static_cast<int>(param.dir), py::arg("value") = to_python(param.value),
                    py::arg("comp") = param.owner, py::arg("comp_id") = param.owner_id);
}

py::dict dict_of(const hal::SignalInfo &signal) {
    py::list pins;
    for (const hal::SignalPin &pin : signal.pins) {
        pins.append(py::dict(py::arg("name") = pin.name, py::arg("dir") = static_cast<int>(pin.dir)));
    }
    return py::dict(py::arg("name") = signal.name, py::arg("type") = static_cast<int>(signal.type),
                    py::arg("value") = to_python(signal.value), py::arg("readers") = signal.readers,
                    py::arg("writers") = signal.writers, py::arg("bidirs") = signal.bidirectionals,
                    py::arg("pins") = pins);
}

py::dict dict_of(const hal::CompInfo &comp) {
    return py::dict(py::arg("name") = comp.name, py::arg("id") = comp.id,
                    py::arg("type") = static_cast<int>(comp.type), py::arg("ready") = comp.isReady,
                    py::arg("pid") = comp.pid, py::arg("args") = text_or_none(comp.insmod_args));
}

py::dict dict_of(const hal::FunctionInfo &funct) {
    return py::dict(py::arg("name") = funct.name, py::arg("comp") = funct.owner,
                    py::arg("comp_id") = funct.owner_id, py::arg("users") = funct.users,
                    py::arg("reentrant") = funct.reentrant);
}

py::dict dict_of(const hal::ThreadInfo &thread) {
    return py::dict(py::arg("name") = thread.name, py::arg("period") = thread.period_ns,
                    py::arg("init_functs") = py::cast(thread.init_functions),
                    py::arg("functs") = py::cast(thread.functions), py::arg("overruns") = thread.overruns,
                    py::arg("time") = thread.time_ns, py::arg("tmax") = thread.tmax_ns);
}

template <class Info>
py::list list_of(const std::vector<Info> &infos) {
    py::list all;
    for (const Info &info : infos) {
        all.append(dict_of(info));
    }
    return all;
}

}  // namespace

void define_query(py::module_ &module) {
    py::module_ query = module.def_submodule("_query", "What is in HAL now, as lists of dicts.");
    query.def(
        "pins", [](const std::string &glob) { return list_of(instance()->pins().list(glob)); },
        py::arg("glob") = "*");
    query.def(
        "params", [](const std::string &glob) { return list_of(instance()->params().list(glob)); },
        py::arg("glob") = "*");
    query.def(
        "signals", [](const std::string &glob) { return list_of(instance()->signals().list(glob)); },
        py::arg("glob") = "*");
    query.def(
        "comps", [](const std::string &glob) { return list_of(instance()->components().list(glob)); },
        py::arg("glob") = "*");
    query.def(
        "functs", [](const std::string &glob) { return list_of(instance()->functions().list(glob)); },
        py::arg("glob") = "*");
    query.def(
        "threads", [](const std::string &glob) { return list_of(instance()->threads().list(glob)); },
        py::arg("glob") = "*");
}

}  // namespace mw::python
