// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/hal/convert.hh"

#include <fmt/format.h>

#include "clients/python/hal/instance.hh"

namespace py = pybind11;

namespace mw::python {

namespace {

using hal::Dir;
using hal::Type;
using hal::Value;

[[noreturn]] void throw_overflow(py::handle number) {
    const std::string text = py::str(number);
    PyErr_SetString(PyExc_OverflowError, fmt::format("Value {} out of range", text).c_str());
    throw py::error_already_set();
}

py::int_ as_int(py::handle object) {
    PyObject *whole = PyNumber_Long(object.ptr());
    if (whole == nullptr) {
        throw py::error_already_set();
    }
    return py::reinterpret_steal<py::int_>(whole);
}

std::int64_t signed_in(py::handle object, std::int64_t low, std::int64_t high) {
    const py::int_ whole = as_int(object);
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
    if (overflow != 0 || value < low || value > high) {
        throw_overflow(whole);
    }
    return value;
}

std::uint64_t unsigned_below(py::handle object, std::uint64_t high) {
    const py::int_ whole = as_int(object);
    const unsigned long long value = PyLong_AsUnsignedLongLong(whole.ptr());
    const bool bad = value == static_cast<unsigned long long>(-1) && PyErr_Occurred() != nullptr;
    if (bad) {
        PyErr_Clear();
    }
    if (bad || value > high) {
        throw_overflow(whole);
    }
    return value;
}

double as_double(py::handle object) {
    if (PyNumber_Check(object.ptr()) == 0) {
        PyErr_Format(PyExc_TypeError, "Number expected, not %s", Py_TYPE(object.ptr())->tp_name);
        throw py::error_already_set();
    }
    const double value = PyFloat_AsDouble(object.ptr());
    if (value == -1.0 && PyErr_Occurred() != nullptr) {
        throw py::error_already_set();
    }
    return value;
}

bool isTrue(py::handle object) {
    const int truth = PyObject_IsTrue(object.ptr());
    if (truth < 0) {
        throw py::error_already_set();
    }
    return truth != 0;
}

}  // namespace

py::object to_python(const Value &value) {
    switch (value.type) {
    case Type::BIT: return py::bool_(value.as_bit());
    case Type::FLOAT: return py::float_(value.as_float());
    case Type::S32: return py::int_(value.as_s32());
    case Type::S64: return py::int_(value.as_s64());
    case Type::U64: return py::int_(value.as_u64());
    case Type::U32:
    case Type::PORT: break;
    }
    return py::int_(value.as_u32());
}

Value from_python(Type type, py::handle object) {
    switch (type) {
    case Type::BIT: return Value::of_bit(isTrue(object));
    case Type::FLOAT: return Value::of_float(as_double(object));
    case Type::S32: return Value::of_s32(static_cast<std::int32_t>(signed_in(object, INT32_MIN, INT32_MAX)));
    case Type::U32: return Value::of_u32(static_cast<std::uint32_t>(unsigned_below(object, UINT32_MAX)));
    case Type::S64: return Value::of_s64(signed_in(object, INT64_MIN, INT64_MAX));
    case Type::U64: return Value::of_u64(unsigned_below(object, UINT64_MAX));
    case Type::PORT: break;
    }
    throw_hal_error("a port has no value; use read and write");
}

Value read_place(Type type, const volatile void *place) {
    Value value;
    value.type = type;
    switch (type) {
    case Type::BIT: return Value::of_bit(*static_cast<const volatile bool *>(place));
    case Type::FLOAT: return Value::of_float(*static_cast<const volatile double *>(place));
    case Type::S32: return Value::of_s32(*static_cast<const volatile std::int32_t *>(place));
    case Type::S64: return Value::of_s64(*static_cast<const volatile std::int64_t *>(place));
    case Type::U64: return Value::of_u64(*static_cast<const volatile std::uint64_t *>(place));
    case Type::U32:
    case Type::PORT: value.bits = *static_cast<const volatile std::uint32_t *>(place); break;
    }
    return value;
}

void write_place(const Value &value, volatile void *place) {
    switch (value.type) {
    case Type::BIT: *static_cast<volatile bool *>(place) = value.as_bit(); break;
    case Type::FLOAT: *static_cast<volatile double *>(place) = value.as_float(); break;
    case Type::S32:
    case Type::U32:
        *static_cast<volatile std::uint32_t *>(place) = static_cast<std::uint32_t>(value.bits);
        break;
    case Type::S64:
    case Type::U64: *static_cast<volatile std::uint64_t *>(place) = value.bits; break;
    case Type::PORT: break;
    }
}

Type type_of(int number) {
    constexpr int FIRST = static_cast<int>(Type::BIT);
    constexpr int LAST = static_cast<int>(Type::U64);
    if (number < FIRST || number > LAST) {
        throw_hal_error(
            fmt::format("{} is no HAL type; HAL_BIT, HAL_FLOAT, HAL_S32, HAL_U32, HAL_S64, HAL_U64 "
                        "and HAL_PORT are",
                        number));
    }
    return static_cast<Type>(number);
}

Dir pin_dir_of(int number) {
    const auto dir = static_cast<Dir>(number);
    if (number < 0 || number > 255 || (dir != Dir::IN && dir != Dir::OUT && dir != Dir::IO)) {
        throw_hal_error(fmt::format("{} is no direction of a pin; HAL_IN, HAL_OUT and HAL_IO are", number));
    }
    return dir;
}

Dir param_dir_of(int number) {
    const auto dir = static_cast<Dir>(number);
    if (number < 0 || number > 255 || (dir != Dir::RO && dir != Dir::RW)) {
        throw_hal_error(fmt::format("{} is no direction of a parameter; HAL_RO and HAL_RW are", number));
    }
    return dir;
}

}  // namespace mw::python
