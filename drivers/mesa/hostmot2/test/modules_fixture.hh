// SPDX-License-Identifier: GPL-2.0-or-later
// Firmware with one more module than that of the 7I76E, for tests of single modules.
#pragma once

#include <initializer_list>

#include "drivers/mesa/hostmot2/test/board_fixture.hh"

namespace mw::mesa::test {

/// The firmware with a module, and pins of its first instance from pin 20 on.
inline Idrom with_module(const ModuleDescriptor &module, std::initializer_list<int> functions = {}) {
    Idrom idrom = firmware();
    std::erase_if(idrom.modules, [&](const ModuleDescriptor &m) { return m.gtag == module.gtag; });
    idrom.modules.push_back(module);
    std::size_t pin = 20;
    for (const int function : functions) {
        idrom.pins[pin++] = {static_cast<std::uint8_t>(function), module.gtag, 0, Gtag::IO_PORT};
    }
    return idrom;
}

inline ModuleDescriptor module_of(Gtag gtag, int instances, std::uint16_t base) {
    ModuleDescriptor module;
    module.gtag = gtag;
    module.instances = static_cast<std::uint8_t>(instances);
    module.base_address = base;
    return module;
}

}  // namespace mw::mesa::test
