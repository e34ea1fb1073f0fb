// SPDX-License-Identifier: GPL-2.0-or-later
// The functions and constants of the module that need no component.
#include <cstdio>

#include <fmt/format.h>

#include "base/text.hh"
#include "clients/python/hal/convert.hh"
#include "clients/python/hal/instance.hh"
#include "hal/include/hal.h"
#include "hal/tools/stream/keys.hh"

namespace py = pybind11;

namespace mw::python {

namespace {

using hal::Type;
using hal::Value;

[[noreturn]] void throw_runtime(const std::string &text) {
    PyErr_SetString(PyExc_RuntimeError, text.c_str());
    throw py::error_already_set();
}

/// True, or False after the reason was written to standard error, because callers of connect, disconnect and
/// new_sig test a truth value.
bool succeeded(const Result<> &result) {
    if (!result) {
        PySys_WriteStderr("hal: %s\n", result.error().str().c_str());
    }
    return result.has_value();
}

/// Parses a bit; other types are parsed by HAL.
Result<Value> value_of_text(Type type, const std::string &text) {
    if (type == Type::BIT) {
        std::string word = text;
        for (char &c : word) {
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
        if (word == "on" || word == "yes" || word == "true" || word == "1") {
            return Value::of_bit(true);
        }
        if (word == "off" || word == "no" || word == "false" || word == "0") {
            return Value::of_bit(false);
        }
    }
    return hal::parse_value(type, text);
}

Value value_for(Type type, py::handle object) {
    if (!py::isinstance<py::str>(object)) {
        return from_python(type, object);
    }
    const auto value = value_of_text(type, object.cast<std::string>());
    if (!value) {
        throw_runtime(value.error().str());
    }
    return *value;
}

bool set_pin_or_param(const std::string &name, py::handle object) {
    const HalHandle hal = instance();
    const auto now = hal->values().get(name);
    if (!now) {
        throw_runtime(now.error().str());
    }
    const Result<> done = hal->values().set(name, value_for(now->type, object));
    if (!done) {
        throw_runtime(done.error().str());
    }
    return true;
}

bool set_signal(const std::string &name, py::handle object) {
    const HalHandle hal = instance();
    const auto now = hal->signals().get(name);
    if (!now) {
        throw_runtime(now.error().str());
    }
    // The value of a port signal is the size of its queue.
    const Result<> done = now->type == Type::PORT
                              ? hal->signals().set(name, py::str(object).cast<std::string>())
                              : hal->signals().set(name, value_for(now->type, object));
    if (!done) {
        throw_runtime(done.error().str());
    }
    return true;
}

py::object value_or_throw(const Result<Value> &value) {
    if (!value) {
        throw_runtime(value.error().str());
    }
    return to_python(*value);
}

/// Value of a pin, parameter or signal.
py::object get_value(const std::string &name) {
    const HalHandle hal = instance();
    for (const auto &value : {hal->pins().get(name), hal->params().get(name), hal->signals().get(name)}) {
        if (value) {
            return to_python(*value);
        }
    }
    throw_runtime(fmt::format("there is no pin, parameter or signal '{}'", name));
}

bool pin_has_writer(const std::string &name) {
    const HalHandle hal = instance();
    const auto pin = hal->pins().find(name);
    if (!pin) {
        PyErr_SetString(PyExc_NameError, pin.error().str().c_str());
        throw py::error_already_set();
    }
    const auto signal = pin->signal.empty() ? fail("not linked") : hal->signals().find(pin->signal);
    return signal && signal->writers > 0;
}

py::list info_pins() {
    py::list all;
    for (const hal::PinInfo &pin : instance()->pins().list()) {
        all.append(py::dict(py::arg("NAME") = pin.name, py::arg("VALUE") = to_python(pin.value),
                            py::arg("DIRECTION") = static_cast<int>(pin.dir),
                            py::arg("TYPE") = static_cast<int>(pin.type)));
    }
    return all;
}

py::list info_params() {
    py::list all;
    for (const hal::ParamInfo &param : instance()->params().list()) {
        all.append(py::dict(py::arg("NAME") = param.name, py::arg("VALUE") = to_python(param.value),
                            py::arg("DIRECTION") = static_cast<int>(param.dir),
                            py::arg("TYPE") = static_cast<int>(param.type)));
    }
    return all;
}

py::list info_signals() {
    py::list all;
    for (const hal::SignalInfo &signal : instance()->signals().list()) {
        py::object driver = py::none();
        for (const hal::SignalPin &pin : signal.pins) {
            if (pin.dir == hal::Dir::OUT) {
                driver = py::str(pin.name);
            }
        }
        all.append(py::dict(py::arg("NAME") = signal.name, py::arg("VALUE") = to_python(signal.value),
                            py::arg("DRIVER") = driver, py::arg("TYPE") = static_cast<int>(signal.type)));
    }
    return all;
}

void define_constants(py::module_ &module) {
    for (const auto &[name, number] : std::initializer_list<std::pair<const char *, long>>{
             {"HAL_BIT", HAL_BIT},
             {"HAL_FLOAT", HAL_FLOAT},
             {"HAL_S32", HAL_S32},
             {"HAL_U32", HAL_U32},
             {"HAL_S64", HAL_S64},
             {"HAL_U64", HAL_U64},
             {"HAL_PORT", HAL_PORT},
             {"HAL_IN", HAL_IN},
             {"HAL_OUT", HAL_OUT},
             {"HAL_IO", HAL_IO},
             {"HAL_RO", HAL_RO},
             {"HAL_RW", HAL_RW},
             {"MSG_NONE", RTAPI_MSG_NONE},
             {"MSG_ERR", RTAPI_MSG_ERR},
             {"MSG_WARN", RTAPI_MSG_WARN},
             {"MSG_INFO", RTAPI_MSG_INFO},
             {"MSG_DBG", RTAPI_MSG_DBG},
             {"MSG_ALL", RTAPI_MSG_ALL},
             {"REALTIME_TYPE_UNINITIALIZED", REALTIME_TYPE_UNINITIALIZED},
             {"REALTIME_TYPE_NONE", REALTIME_TYPE_NONE},
             {"REALTIME_TYPE_UNKNOWN", REALTIME_TYPE_UNKNOWN},
             {"REALTIME_TYPE_PREEMPT_DYNAMIC", REALTIME_TYPE_PREEMPT_DYNAMIC},
             {"REALTIME_TYPE_PREEMPT_RT", REALTIME_TYPE_PREEMPT_RT},
             {"REALTIME_TYPE_RTAI", REALTIME_TYPE_RTAI},
             {"REALTIME_TYPE_LXRT", REALTIME_TYPE_LXRT},
             {"REALTIME_TYPE_XENOMAI", REALTIME_TYPE_XENOMAI},
             {"REALTIME_TYPE_XENOMAI_EVL", REALTIME_TYPE_XENOMAI_EVL},
             {"is_kernelspace", 0},
             {"is_userspace", 1},
             {"sampler_base", hal::stream_tools::SAMPLER_KEY},
             {"streamer_base", hal::stream_tools::STREAMER_KEY}}) {
        module.attr(name) = number;
    }
    module.attr("stream_base") = module.attr("streamer_base");
    module.attr("kernel_version") = "Not Available";
}

void define_value_functions(py::module_ &module) {
    module.def("get_value", &get_value, "get_value(name): of a pin, parameter or signal.");
    module.def(
        "get_p", [](const std::string &name) { return value_or_throw(instance()->values().get(name)); },
        "get_p(name): of a pin or parameter.");
    module.def(
        "get_s", [](const std::string &name) { return value_or_throw(instance()->signals().get(name)); },
        "get_s(name): of a signal.");
    module.def("set_p", &set_pin_or_param, "set_p(name, value): a pin or parameter, as setp does.");
    module.def("set_s", &set_signal, "set_s(name, value): a signal without writer, as sets does.");
    module.def("get_info_pins", &info_pins);
    module.def("get_info_params", &info_params);
    module.def("get_info_signals", &info_signals);
}

}  // namespace

void define_functions(py::module_ &module) {
    define_constants(module);
    define_value_functions(module);
    module.def(
        "is_initialized", [] { return live_components() > 0; }, "True while this program has a component.");
    module.def("get_realtime_type", [] { return static_cast<int>(rtapi_get_realtime_type()); });
    module.def("component_exists",
               [](const std::string &name) { return instance()->components().find(name).has_value(); });
    module.def("component_is_ready", [](const std::string &name) {
        const auto found = instance()->components().find(name);
        return found && found->isReady;
    });
    module.def("new_sig", [](const std::string &name, int type) {
        return succeeded(instance()->signals().create(name, type_of(type)));
    });
    module.def("connect", [](const std::string &pin, const std::string &signal) {
        return succeeded(instance()->signals().link(pin, signal));
    });
    module.def("disconnect",
               [](const std::string &pin) { return succeeded(instance()->signals().unlink(pin)); });
    module.def("pin_has_writer", &pin_has_writer);
    module.def("get_msg_level", [] { return rtapi_get_msg_level(); });
    module.def("set_msg_level", [](int level) {
        if (rtapi_set_msg_level(level) < 0) {
            throw_runtime(fmt::format("{} is no message level; MSG_NONE to MSG_ALL are 0 to 5", level));
        }
    });
    module.def(
        "is_rt_now", [] { return instance()->host_status().isRealtime(); },
        "True when the threads have realtime priority.");
}

}  // namespace mw::python
