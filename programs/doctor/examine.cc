// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/examine.hh"

#include "base/own_place.hh"
#include "base/text.hh"
#include "hal/core/instance.hh"
#include "machine/config/loaded_config.hh"
#include "messages/client/viewer.hh"
#include "programs/doctor/boards.hh"
#include "programs/doctor/contradictions.hh"
#include "programs/doctor/hal_files.hh"
#include "programs/doctor/latency.hh"
#include "programs/doctor/named_files.hh"
#include "programs/doctor/settings.hh"
#include "programs/doctor/system.hh"

namespace mw::doctor {
namespace {

/// Drivers and threads of a second instance would conflict with those of the machine.
bool isMachineUp() {
    const auto viewer = client::Viewer::attach(hal::default_instance());
    return viewer.has_value() && viewer->isMachineAlive();
}

}  // namespace

std::string finding_line(const diagnostics::Diagnostic &finding) {
    diagnostics::Diagnostic plain{finding.severity, finding.what};
    if (plain.what.place.file.empty()) {
        plain.what.place.file = "system";
    }
    std::string line = plain.str();
    for (char &c : line) {
        c = c == '\n' ? ' ' : c;
    }
    return line;
}

void examine(const std::string &ini, const Scope &scope, volatile std::sig_atomic_t &stop,
             diagnostics::Sink &sink) {
    auto file = ini::IniFile::load(ini, sink);
    if (!file.has_value()) {
        sink.error(file.error());
        return;
    }
    machine::LoadedConfig loaded(std::move(*file), sink);
    examine_contradictions(loaded.ini, loaded.machine, sink);
    examine_named_files(loaded.ini, loaded.machine, sink);
    if (scope.display) {
        scope.display(loaded, sink);
    }
    const bool up = isMachineUp();
    if (sink.hasErrors() || !scope.has_hal || up) {
        if (scope.has_hal) {
            sink.warning(up ? "a machine is running: HAL files were not checked"
                            : "HAL files were not checked because of the errors above",
                         {ini, 0, 0});
        }
    } else {
        examine_hal_files(loaded.ini, sink);
    }
    if (scope.has_system) {
        examine_system("", program_folder() + "/millwright-rt", sink);
        examine_boards(sink);
    }
    if (scope.latency_s > 0 && up) {
        sink.warning("a machine is running: latency was not measured");
    } else if (scope.latency_s > 0) {
        const auto base = number(loaded.ini, "EMCMOT", "BASE_PERIOD");
        examine_latency(loaded.machine.servo_period_ns,
                        base.has_value() ? static_cast<std::int64_t>(base->value) : 0, scope.latency_s, stop,
                        sink);
    }
}

}  // namespace mw::doctor
