// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.stat: the status of the machine at the last poll(). Its attributes are the rows of
// messages/legacy/status_table.hh.
#include <cstring>

#include "clients/python/linuxcnc/connection.hh"
#include "clients/python/linuxcnc/module.hh"
#include "clients/python/linuxcnc/stat_parts.hh"
#include "clients/python/linuxcnc/stat_words.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

using Status = messages::MachineStatus;

/// The status before the first poll.
const Status &nothing() {
    static const Status zero = [] {
        Status status;
        std::memset(static_cast<void *>(&status), 0, sizeof status);
        return status;
    }();
    return zero;
}

/// Guarded by the GIL.
class Stat {
  public:
    /// Reads the last published status; never waits for the machine, and has no cost for it.
    void poll() {
        client::Viewer &viewer = view_.viewer();
        if (viewer.segment().cycles.load(std::memory_order_acquire) == 0) {
            return;  // programs of HAL files may poll before task has begun; the status is then unchanged
        }
        const auto read = viewer.read_status();
        if (!read.has_value()) {
            throw_error(read.error().str());
        }
        const auto tools = viewer.read_tools();
        if (!tools.has_value()) {
            throw_error(tools.error().str());
        }
        if (tools->has_value()) {
            table_ = **tools;
            shown_table_ = py::none();
        }
        view_.check_alive();
        polled_ = true;
        if (ini_.empty()) {
            ini_ = viewer.identity().ini.str();
        }
    }
    const Status &status() { return polled_ && view_.isJoined() ? view_.viewer().status() : nothing(); }
    const std::string &ini() {
        if (polled_ && view_.isJoined() && view_.viewer().link() != nullptr) {
            throw_error("ini_filename: the machine is on another computer, and so is its INI file");
        }
        return ini_;
    }
    const messages::ToolTable &table() {
        if (polled_ && view_.isJoined() && view_.viewer().link() != nullptr) {
            if (const auto tools = view_.viewer().link()->check_tools(); !tools.has_value()) {
                throw_error(tools.error().str());
            }
        }
        return table_;
    }
    py::object tool_table() {
        static_cast<void>(table());
        if (shown_table_.is_none()) {
            shown_table_ = tool_tuples(table_);
        }
        return shown_table_;
    }

  private:
    View view_;
    bool polled_ = false;
    std::string ini_;
    messages::ToolTable table_;
    py::object shown_table_ = py::none();
};

}  // namespace

void define_stat(py::module_ &module) {
    py::class_<Stat> stat(module, "stat", "stat(): the status of the machine as of the last poll().");
    stat.def(py::init<>())
        .def("poll", &Stat::poll, "Takes the status as it is now. linuxcnc.error when there is no machine.")
        .def_property_readonly("ini_filename", [](Stat &self) { return self.ini(); })
        .def_property_readonly("tool_table", &Stat::tool_table)
        .def(
            "toolinfo", [](Stat &self, int toolno) { return tool_dict(self.table(), toolno); },
            py::arg("tool"), "A dict of the tool of that number. ValueError when there is none.");
    stat.def_property_readonly(
        "state", [](Stat &self) { return static_cast<int>(rcs_state(self.status())); },
        "RCS_*: of the last command and of the work under way");
    legacy::for_each_row(legacy::STATUS, [&stat](const auto &row) {
        if (legacy::isNamed(row.names.python) || legacy::isNamed(row.names.python_int)) {
            stat.def_property_readonly(
                python_name(row.names), [&row](Stat &self) { return python_value(row, self.status()); },
                row.doc);
        }
    });
    stat.def_property_readonly(
        "joint", [](Stat &self) { return joint_dicts(self.status()); }, "a dict for each joint");
    stat.def_property_readonly(
        "axis", [](Stat &self) { return axis_dicts(self.status()); }, "a dict for each axis");
    stat.def_property_readonly(
        "spindle", [](Stat &self) { return spindle_dicts(self.status()); }, "a dict for each spindle");
}

}  // namespace mw::python
