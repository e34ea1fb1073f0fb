// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/hal/component.hh"

#include <fmt/format.h>

#include "clients/python/hal/convert.hh"
#include "hal/include/hal.h"

namespace py = pybind11;

namespace mw::python {

namespace {

int components_alive = 0;  // guarded by the GIL

hal_port_t *port_of(const Item &item) {
    if (item.type != hal::Type::PORT) {
        throw_hal_error(fmt::format("'{}' is no port", item.name));
    }
    return static_cast<hal_port_t *>(item.address());
}

py::object read_port(const Item &item, unsigned size, bool (*take)(const hal_port_t *, char *, unsigned)) {
    std::string bytes(size, '\0');
    if (!take(port_of(item), bytes.data(), size)) {
        return py::bool_(false);
    }
    return py::bytes(bytes);
}

bool write_port(const Item &item, py::handle data) {
    // A str is converted to UTF-8; other objects provide their bytes.
    const std::string bytes =
        py::isinstance<py::str>(data)
            ? data.cast<std::string>()
            : py::reinterpret_steal<py::bytes>(PyBytes_FromObject(data.ptr())).cast<std::string>();
    return hal_port_write(port_of(item), bytes.data(), static_cast<unsigned>(bytes.size()));
}

std::string describe(const Item &item) {
    std::string type = hal::type_name(item.type);
    for (char &c : type) {
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return fmt::format("<hal {} \"{}\" {}-{}>", item.isPin ? "pin" : "param", item.name, type,
                       hal::dir_name(item.dir));
}

[[noreturn]] void throw_unknown(const std::string &name) {
    PyErr_SetString(PyExc_AttributeError, fmt::format("Pin '{}' does not exist", name).c_str());
    throw py::error_already_set();
}

}  // namespace

int live_components() {
    return components_alive;
}

volatile void *Item::address() const {
    if (isEnded) {
        throw_hal_error(fmt::format("the component of '{}' has ended", name));
    }
    return isPin ? *const_cast<void *volatile *>(slot) : place;
}

py::object Item::get() const {
    return to_python(read_place(type, address()));
}

void Item::set(py::handle value) {
    write_place(from_python(type, value), address());
}

Component::Component(const std::string &component_name, const std::string &item_prefix)
    : name(component_name), prefix(item_prefix.empty() ? component_name : item_prefix), hal_(instance()) {
    const auto id = hal_->components().create(name);
    if (!id) {
        throw_hal_error(id.error().str());
    }
    id_ = *id;
    ++components_alive;
}

Component::~Component() {
    if (id_ != 0) {
        // An error means that the instance has ended, and the component with it.
        static_cast<void>(hal_->components().remove(id_));
        --components_alive;
    }
    for (auto &[key, item] : items) {
        item->isEnded = true;
    }
}

int Component::id() const {
    if (id_ == 0) {
        throw_hal_error(fmt::format("the component '{}' has ended", name));
    }
    return id_;
}

std::shared_ptr<Item> Component::new_item(const std::string &item_name, int type, int dir, bool isPin) {
    if (items.contains(item_name)) {
        PyErr_SetString(PyExc_ValueError, fmt::format("Duplicate pin name '{}'", item_name).c_str());
        throw py::error_already_set();
    }
    auto item = std::make_shared<Item>();
    item->hal = hal_;
    item->name = item_name;
    item->isPin = isPin;
    item->type = type_of(type);
    item->dir = isPin ? pin_dir_of(dir) : param_dir_of(dir);
    const std::string full = prefix + "." + item_name;
    if (isPin) {
        const auto slot = hal_->pins().create(full, item->type, item->dir, id());
        if (!slot) {
            throw_hal_error(slot.error().str());
        }
        item->slot = *slot;
    } else {
        item->place = hal_->memory().allocate(sizeof(std::uint64_t));
        if (item->place == nullptr) {
            throw_hal_error("no HAL memory left");
        }
        check(hal_->params().create(full, item->type, item->dir, item->place, id()));
    }
    items.emplace(item_name, item);
    return item;
}

std::shared_ptr<Item> Component::item(const std::string &item_name) const {
    const auto found = items.find(item_name);
    if (found == items.end()) {
        throw_unknown(item_name);
    }
    return found->second;
}

std::shared_ptr<Item> Component::item(const std::string &item_name, bool isPin) const {
    auto found = item(item_name);
    if (found->isPin != isPin) {
        throw_unknown(item_name);
    }
    return found;
}

void Component::set_ready(bool ready) {
    check(hal_->components().set_ready(id(), ready));
}

void Component::exit() {
    const int ending = id();
    id_ = 0;
    --components_alive;
    for (auto &[key, item] : items) {
        item->isEnded = true;
    }
    check(hal_->components().remove(ending));
}

namespace {

void define_item(py::module_ &module) {
    py::class_<Item, std::shared_ptr<Item>> item(module, "item", "A pin or parameter of this process.");
    item.def("get", &Item::get, "The value.")
        .def("set", &Item::set, "Sets the value.")
        .def_property("value", &Item::get, &Item::set, "The value.")
        .def(
            "get_name", [](const Item &self) { return self.name; }, "The name without the prefix.")
        .def_property_readonly("name", [](const Item &self) { return self.name; })
        .def("get_type", [](const Item &self) { return static_cast<int>(self.type); })
        .def_property_readonly("type", [](const Item &self) { return static_cast<int>(self.type); })
        .def("get_dir", [](const Item &self) { return static_cast<int>(self.dir); })
        .def_property_readonly("dir", [](const Item &self) { return static_cast<int>(self.dir); })
        .def(
            "is_pin", [](const Item &self) { return self.isPin; }, "True for a pin, False for a parameter.")
        .def("__repr__", &describe);
    item.def(
            "readable", [](const Item &self) { return hal_port_readable(port_of(self)); },
            "Port: bytes that can be read.")
        .def(
            "writable", [](const Item &self) { return hal_port_writable(port_of(self)); },
            "Port: bytes that can be written.")
        .def(
            "size", [](const Item &self) { return hal_port_buffer_size(port_of(self)); },
            "Port: size of the queue, 0 when there is none.")
        .def(
            "clear", [](const Item &self) { hal_port_clear(port_of(self)); }, "Port: empties the queue.")
        .def("write", &write_port,
             "Port: writes all bytes (a str as UTF-8) or, when they do not fit, none: False.")
        .def(
            "read", [](const Item &self, unsigned size) { return read_port(self, size, hal_port_read); },
            "Port: takes so many bytes, or returns False when there are fewer.")
        .def(
            "peek", [](const Item &self, unsigned size) { return read_port(self, size, hal_port_peek); },
            "Port: as read, and leaves them in the queue.")
        .def(
            "peek_commit",
            [](const Item &self, unsigned size) { return hal_port_peek_commit(port_of(self), size); },
            "Port: drops so many bytes; False when there are fewer.");
}

py::dict values_of(const Component &self) {
    py::dict values;
    for (const auto &[name, item] : self.items) {
        values[py::str(name)] = item->get();
    }
    return values;
}

}  // namespace

void define_component(py::module_ &module) {
    define_item(module);
    py::class_<Component, std::shared_ptr<Component>>(
        module, "component", "component(name[, prefix]): a HAL component of this program.")
        .def(py::init<const std::string &, const std::string &>(), py::arg("name"), py::arg("prefix") = "")
        .def(
            "newpin",
            [](Component &self, const std::string &name, int type, int dir) {
                return self.new_item(name, type, dir, true);
            },
            "newpin(name, type, dir): a pin PREFIX.name.")
        .def(
            "newparam",
            [](Component &self, const std::string &name, int type, int dir) {
                return self.new_item(name, type, dir, false);
            },
            "newparam(name, type, dir): a parameter PREFIX.name.")
        .def("getitem", [](const Component &self, const std::string &name) { return self.item(name); })
        .def("getpin", [](const Component &self, const std::string &name) { return self.item(name, true); })
        .def("getparam",
             [](const Component &self, const std::string &name) { return self.item(name, false); })
        .def("getpins", &values_of, "All pins and parameters with their values.")
        .def(
            "ready", [](Component &self) { self.set_ready(true); }, "All pins are made.")
        .def(
            "unready", [](Component &self) { self.set_ready(false); }, "More pins are to come.")
        .def("exit", &Component::exit, "Ends the component.")
        .def("getprefix", [](const Component &self) { return self.prefix; })
        .def("setprefix", [](Component &self, const std::string &prefix) { self.prefix = prefix; })
        .def_property_readonly("name", [](const Component &self) { return self.name; })
        .def_property_readonly("id", [](const Component &self) { return self.id(); })
        .def("__len__", [](const Component &self) { return self.items.size(); })
        .def("__contains__",
             [](const Component &self, const std::string &name) { return self.items.contains(name); })
        .def("__getitem__",
             [](const Component &self, const std::string &name) { return self.item(name)->get(); })
        .def("__setitem__", [](const Component &self, const std::string &name,
                               py::handle value) { self.item(name)->set(value); })
        .def("__getattr__",
             [](const Component &self, const std::string &name) { return self.item(name)->get(); })
        .def("__setattr__", [](const Component &self, const std::string &name,
                               py::handle value) { self.item(name)->set(value); })
        .def("__repr__", [](const Component &self) {
            return fmt::format("<hal component {} with {} pins and params>", self.name, self.items.size());
        });
}

}  // namespace mw::python
