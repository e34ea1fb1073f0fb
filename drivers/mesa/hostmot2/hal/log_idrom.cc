// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/hal/log_idrom.hh"

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/assignment.hh"
#include "rtapi.h"

namespace mw::mesa {

namespace {

void line(const std::string &name, const std::string &text) {
    rtapi_print("hm2/%s: %s\n", name.c_str(), text.c_str());
}

void log_header(const std::string &name, const IdromHeader &header) {
    line(name, "IDRom:");
    line(name, fmt::format("    IDRom Type: 0x{:08X}", header.type));
    line(name, fmt::format("    Offset to Modules: 0x{:08X}", header.modules_offset));
    line(name, fmt::format("    Offset to Pin Description: 0x{:08X}", header.pins_offset));
    line(name, fmt::format("    Board Name: {}", header.board_name));
    line(name, fmt::format("    Port Width: {}", header.port_width));
    line(name, fmt::format("    IO Ports: {}", header.io_ports));
    line(name, fmt::format("    IO Width: {}", header.io_width));
    line(name, fmt::format("    Clock Low: {} Hz", header.clock_low_hz));
    line(name, fmt::format("    Clock High: {} Hz", header.clock_high_hz));
}

void log_modules(const std::string &name, const Idrom &idrom) {
    line(name, fmt::format("{} HM2 Modules:", idrom.modules.size()));
    for (const ModuleDescriptor &module : idrom.modules) {
        line(name, fmt::format("    {} (gtag {}) version {}: {} instances at 0x{:04X}, {}",
                               module_name(module.gtag), static_cast<int>(module.gtag), module.version,
                               module.instances, module.base_address,
                               module.fast_clock ? "ClockHigh" : "ClockLow"));
    }
}

void log_pins(const std::string &name, const Idrom &idrom) {
    line(name, fmt::format("{} HM2 Pin Descriptors:", idrom.pins.size()));
    int number = 0;
    for (const PinDescriptor &pin : idrom.pins) {
        line(name, fmt::format("    pin {}: {} unit {} function 0x{:02X}", number++,
                               module_name(pin.secondary), pin.unit, pin.secondary_pin));
    }
}

}  // namespace

void log_idrom(const std::string &name, const Idrom &idrom, const DriverOptions &options) {
    if (options.has_idrom_log) {
        log_header(name, idrom.header);
    }
    if (options.has_module_log || options.has_use_log) {
        log_modules(name, idrom);
    }
    if (options.has_pin_log) {
        log_pins(name, idrom);
    }
}

}  // namespace mw::mesa
