// SPDX-License-Identifier: GPL-2.0-or-later
// hal.stream: queues of records between a program and a realtime component; hal.shm: blocks of shared memory.
#include <pybind11/stl.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "clients/python/hal/component.hh"
#include "clients/python/hal/convert.hh"
#include "hal/include/hal.h"

namespace py = pybind11;

namespace mw::python {

namespace {

[[noreturn]] void throw_os_error(int code) {
    errno = code;
    PyErr_SetFromErrno(PyExc_OSError);
    throw py::error_already_set();
}

class Stream {
  public:
    Stream(std::shared_ptr<Component> component, int key, unsigned depth, const std::string &types)
        : component_(std::move(component)), key_(key), isCreator_(true) {
        finish(hal_stream_create(&stream_, component_->id(), key, depth, types.c_str()));
    }
    Stream(std::shared_ptr<Component> component, int key, const std::string &types)
        : component_(std::move(component)), key_(key), isCreator_(false) {
        finish(hal_stream_attach(&stream_, component_->id(), key, types.empty() ? nullptr : types.c_str()));
    }
    ~Stream() {
        if (isCreator_) {
            hal_stream_destroy(&stream_);
        } else {
            hal_stream_detach(&stream_);
        }
    }
    Stream(const Stream &) = delete;
    Stream &operator=(const Stream &) = delete;

    py::object read() {
        hal_stream_data_u record[HAL_STREAM_MAX_PINS];
        unsigned number = 0;
        if (hal_stream_read(&stream_, record, &number) < 0) {
            return py::none();
        }
        sampleno_ = number;
        py::tuple values(fields());
        for (std::size_t i = 0; i < fields(); ++i) {
            values[i] = to_python(read_place(type(i), &record[i]));
        }
        return values;
    }

    void write(const py::sequence &values) {
        if (values.size() != fields()) {
            PyErr_SetString(
                PyExc_ValueError,
                fmt::format("the stream takes {} values, not {}", fields(), values.size()).c_str());
            throw py::error_already_set();
        }
        hal_stream_data_u record[HAL_STREAM_MAX_PINS];
        for (std::size_t i = 0; i < fields(); ++i) {
            write_place(from_python(type(i), values[i]), &record[i]);
        }
        const int status = hal_stream_write(&stream_, record);
        if (status < 0) {
            throw_os_error(-status);
        }
    }

    py::bytes element_types() {
        std::string letters;
        for (std::size_t i = 0; i < fields(); ++i) {
            constexpr const char *LETTER = " bfsu?lk";
            letters += LETTER[static_cast<int>(type(i))];
        }
        return {letters};
    }

    std::string describe() const {
        return fmt::format("<stream 0x{:x}{}>", static_cast<unsigned>(key_), isCreator_ ? " creator" : "");
    }
    hal_stream_t *raw() noexcept { return &stream_; }
    unsigned sampleno() const noexcept { return sampleno_; }

  private:
    void finish(int status) const {
        if (status < 0) {
            throw_os_error(-status);
        }
    }
    std::size_t fields() { return static_cast<std::size_t>(hal_stream_element_count(&stream_)); }
    hal::Type type(std::size_t i) {
        return static_cast<hal::Type>(hal_stream_element_type(&stream_, static_cast<int>(i)));
    }

    std::shared_ptr<Component> component_;
    int key_;
    bool isCreator_;
    unsigned sampleno_ = 0;
    hal_stream_t stream_{};
};

struct SharedBlock {
    SharedBlock(const std::shared_ptr<Component> &owner, int block_key, std::size_t bytes)
        : hal(owner->hal()), key(block_key), size(bytes) {
        const auto block = hal->memory().shared_block(key, size);
        if (!block) {
            throw_hal_error(block.error().str());
        }
        memory = *block;
    }
    HalHandle hal;
    int key;
    std::size_t size;
    void *memory = nullptr;
};

}  // namespace

void define_stream(py::module_ &module) {
    using Depth = unsigned;
    py::class_<Stream>(module, "stream",
                       "stream(comp, key, depth, types) makes a queue; stream(comp, key[, types]) joins one.")
        .def(py::init<std::shared_ptr<Component>, int, Depth, const std::string &>())
        .def(py::init<std::shared_ptr<Component>, int, const std::string &>(), py::arg("comp"),
             py::arg("key"), py::arg("types") = "")
        .def("read", &Stream::read, "The next record as a tuple, or None.")
        .def("write", &Stream::write, "Appends a record; OSError when the queue is full.")
        .def_property_readonly("readable", [](Stream &self) { return hal_stream_readable(self.raw()); })
        .def_property_readonly("writable", [](Stream &self) { return hal_stream_writable(self.raw()); })
        .def_property_readonly("depth", [](Stream &self) { return hal_stream_depth(self.raw()); })
        .def_property_readonly("maxdepth", [](Stream &self) { return hal_stream_maxdepth(self.raw()); })
        .def_property_readonly("num_overruns",
                               [](Stream &self) { return hal_stream_num_overruns(self.raw()); })
        .def_property_readonly("num_underruns",
                               [](Stream &self) { return hal_stream_num_underruns(self.raw()); })
        .def_property_readonly("element_types", &Stream::element_types)
        .def_property_readonly("sampleno", &Stream::sampleno,
                               "The number of the last successfully read sample.")
        .def("__repr__", &Stream::describe);

    py::class_<SharedBlock>(module, "shm", py::buffer_protocol(),
                            "shm(comp, key, size): shared memory by key.")
        .def(py::init<const std::shared_ptr<Component> &, int, std::size_t>())
        .def_buffer([](SharedBlock &self) {
            return py::buffer_info(static_cast<std::uint8_t *>(self.memory),
                                   static_cast<py::ssize_t>(self.size));
        })
        .def(
            "getbuffer",
            [](const SharedBlock &self) {
                return py::memoryview::from_memory(self.memory, static_cast<py::ssize_t>(self.size));
            },
            py::keep_alive<0, 1>())
        .def("__len__", [](const SharedBlock &self) { return self.size; })
        .def("__repr__", [](const SharedBlock &self) {
            return fmt::format("<shared memory buffer key={:08x} size={}>", static_cast<unsigned>(self.key),
                               self.size);
        });
}

}  // namespace mw::python
