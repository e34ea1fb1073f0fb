// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/connection.hh"

#include "clients/nml/remote/find_machine.hh"
#include "clients/python/linuxcnc/module.hh"

namespace py = pybind11;

namespace mw::python {

client::Viewer &View::viewer() {
    if (!viewer_.has_value()) {
        viewer_.emplace(connect_viewer());
    }
    return *viewer_;
}

void View::check_alive() {
    constexpr std::chrono::milliseconds PATIENCE{100};
    const auto now = std::chrono::steady_clock::now();
    const std::uint64_t cycle = viewer().status().cycle;
    if (cycle != cycle_) {
        cycle_ = cycle;
        seen_ = now;
        return;
    }
    if (now - seen_ < PATIENCE) {
        return;
    }
    seen_ = now;
    if (const auto machine = viewer_->check_machine(); !machine.has_value()) {
        viewer_.reset();  // the next call finds a machine that was started after this
        throw_error(machine.error().str());
    }
}

std::string nml_file() {
    const py::module_ module = py::module_::import("linuxcnc");
    const std::string file = py::str(module.attr("nmlfile"));
    return file == std::string(py::str(module.attr("__file__"))) ? "" : file;
}

client::Viewer connect_viewer() {
    const std::string file = nml_file();
    auto viewer = [&file] {
        const py::gil_scoped_release release;
        return nml::find_machine(machine_instance(), file);
    }();
    if (!viewer.has_value()) {
        throw_error(viewer.error().str());
    }
    return std::move(*viewer);
}

client::Client connect_client() {
    auto client = client::Client::join(connect_viewer());
    if (!client.has_value()) {
        throw_error(client.error().str());
    }
    return std::move(*client);
}

}  // namespace mw::python
