// SPDX-License-Identifier: GPL-2.0-or-later
// The modules and instances of a firmware that are used, and the module of each pin.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/hostmot2/config.hh"
#include "drivers/mesa/hostmot2/modules/sserial_found.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// A module of the firmware and the number of its used instances (the first ones).
struct UsedModule {
    ModuleDescriptor descriptor;
    int instances = 0;
    std::uint32_t clock_hz = 0;  ///< frequency of the clock that it counts
    std::uint16_t register_stride = 0, instance_stride = 0;

    /// The address of a register of an instance.
    std::uint16_t address(int reg, int instance = 0) const noexcept {
        return static_cast<std::uint16_t>(descriptor.base_address + reg * register_stride +
                                          instance * instance_stride);
    }
};

/// A pin of the board. Without a module it is a general input or output.
struct UsedPin {
    int number = 0;
    Gtag module = Gtag::NONE;
    int instance = 0;
    std::uint8_t function = 0;  ///< function of the module, bit 7: output

    bool isOutputOfModule() const noexcept { return module != Gtag::NONE && (function & 0x80U) != 0; }
    bool isGeneral() const noexcept { return module == Gtag::NONE; }
};

struct Assignment {
    std::vector<UsedModule> modules;
    std::vector<UsedPin> pins;
    std::vector<FoundPort> serial_ports;  ///< filled by discover_sserial()
    std::vector<std::string> warnings;    ///< omitted modules, with gtag, version and base address
};

/// True if the driver can use a module of this type and version.
bool isSupported(const ModuleDescriptor &module) noexcept;
/// The usual name of a module type, such as "StepGen"; "unknown" for others.
std::string_view module_name(Gtag gtag) noexcept;

/// Applies a configuration to a firmware. If the configuration requests more instances than there are, the
/// error contains their number. `leds`: lamps of the card, which the firmware does not count.
Result<Assignment> assign(const Idrom &idrom, const Config &config, int leds);

}  // namespace mw::mesa
