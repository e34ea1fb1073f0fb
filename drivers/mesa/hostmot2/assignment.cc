// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/assignment.hh"

#include <algorithm>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/resolver.hh"

namespace mw::mesa {

namespace {

constexpr std::uint8_t ANY = 0xFF;  // ends the list of versions

/// A module type known to the driver, with the versions that it can use (none: ignored without a warning).
struct Known {
    Gtag gtag;
    std::string_view name;
    std::uint8_t versions[6];
};

constexpr Known KNOWN[] = {
    {Gtag::WATCHDOG, "Watchdog", {0, ANY}},
    {Gtag::IO_PORT, "IOPort", {0, ANY}},
    {Gtag::ENCODER, "Encoder", {1, 2, 3, 0x83, ANY}},
    {Gtag::MUXED_ENCODER, "MuxedEncoder", {2, 3, 4, 0x84, ANY}},
    {Gtag::STEPGEN, "StepGen", {0, 1, 2, 0x42, 0xC2, ANY}},
    {Gtag::PWM, "PWMGen", {0, 1, ANY}},
    {Gtag::DPLL, "DPLL", {0, ANY}},
    {Gtag::LED, "LED", {0, ANY}},
    {Gtag::SMART_SERIAL, "SmartSerial", {0, ANY}},
    {Gtag::SMART_SERIAL_B, "SmartSerialB", {0, ANY}},
    {Gtag::SSR, "SSR", {0, ANY}},
    {Gtag::OUT_M, "OutM", {0, ANY}},
    {Gtag::IN_MUX, "InMux", {0, ANY}},
    {Gtag::IN_M, "InM", {0, ANY}},
    {Gtag::THREE_PHASE_PWM, "ThreePhasePWM", {0, ANY}},
    {Gtag::RC_PWM, "RCPWMGen", {0, ANY}},
    {Gtag::RESOLVER, "Resolver", {0, ANY}},
    {Gtag::UART_TX, "UARTTX", {0, ANY}},
    {Gtag::UART_RX, "UARTRX", {0, ANY}},
    {Gtag::PKT_UART_TX, "PktUARTTX", {0, 1, 2, 3, ANY}},
    {Gtag::PKT_UART_RX, "PktUARTRX", {0, 1, 2, 3, ANY}},
    {Gtag::BSPI, "BSPI", {0, ANY}},
    {Gtag::SSI, "SSI", {0, ANY}},
    {Gtag::BISS, "BISS", {0, ANY}},
    {Gtag::FANUC_ABSOLUTE, "FanucAbs", {0, ANY}},
    {Gtag::XY2_100, "XY2Mod", {0, ANY}},
    {Gtag::ONE_SHOT, "OneShot", {0, ANY}},
    {Gtag::PERIOD_METER, "PeriodM", {0, ANY}},
    {Gtag::IRQ, "IRQLogic", {ANY}},
    {Gtag::TRANSLATION_RAM, "TranslationRAM", {ANY}},
    {Gtag::MUX_SELECT, "MuxedEncoderSelect", {ANY}},
    {Gtag::DBSPI, "DBSPI", {ANY}},
    {Gtag::DATA_PAINTER, "DataPainter", {ANY}},
    {Gtag::LIO_PORT, "LIOPort", {ANY}},
};

const Known *known_of(Gtag gtag) noexcept {
    const auto *known = std::ranges::find(KNOWN, gtag, &Known::gtag);
    return known == std::end(KNOWN) ? nullptr : known;
}

bool isIgnored(const ModuleDescriptor &module) noexcept {
    const Known *known = known_of(module.gtag);
    return known != nullptr && known->versions[0] == ANY;
}

/// True for a pin of a multiplexer of used encoders.
bool isSelectOfUsedEncoder(const PinDescriptor &pin, const Assignment &assignment) noexcept {
    return pin.secondary == Gtag::MUX_SELECT &&
           std::ranges::any_of(assignment.modules, [](const UsedModule &m) {
               return m.descriptor.gtag == Gtag::MUXED_ENCODER && m.instances > 0;
           });
}

constexpr std::uint8_t ALL_UNITS = 0x80;

/// True if the pin belongs to the outputs of a stepgen: step, direction, and as many table pins as
/// stepgen_width= allows.
bool isWithinWidth(const PinDescriptor &pin, const Config &config) noexcept {
    const bool is_table_pin = pin.secondary == Gtag::STEPGEN && (pin.secondary_pin & 0x80U) != 0;
    return !is_table_pin || static_cast<int>(pin.secondary_pin & 0x7FU) <= config.stepgen_width;
}

/// Number of instances. Watchdog and phase-locked loop exist once; lamps are counted by the card.
int instances_of(const ModuleDescriptor &module, int leds) noexcept {
    if (module.gtag == Gtag::LED) {
        return leds;
    }
    if (module.gtag == Gtag::RESOLVER) {
        return module.instances * RESOLVER_CHANNELS;
    }
    const bool single = module.gtag == Gtag::WATCHDOG || module.gtag == Gtag::DPLL;
    return single ? 1 : module.instances;
}

bool isUsed(const PinDescriptor &pin, const Assignment &assignment, const Config &config) noexcept {
    if (pin.secondary == Gtag::NONE || !isWithinWidth(pin, config)) {
        return false;
    }
    if (isSelectOfUsedEncoder(pin, assignment)) {
        return true;
    }
    if (const auto *formats = config.formats_of(pin.secondary)) {
        return formats->contains(pin.unit);
    }
    return std::ranges::any_of(assignment.modules, [&](const UsedModule &module) {
        const bool of_it = (pin.unit & ALL_UNITS) != 0 ? module.instances > 0 : pin.unit < module.instances;
        return module.descriptor.gtag == pin.secondary && of_it;
    });
}

Result<int> used_instances(const ModuleDescriptor &module, const Config &config, int leds) {
    const int available = instances_of(module, leds);
    if (const auto *formats = config.formats_of(module.gtag)) {
        const int highest = formats->empty() ? -1 : formats->rbegin()->first;
        if (highest >= available) {
            return fail(
                fmt::format("config: a format of channel {} of {}, but this firmware has {} channels.",
                            highest, module_name(module.gtag), available));
        }
        return highest + 1;
    }
    const int wanted = config.wanted_of(module.gtag);
    if (wanted > available) {
        return fail(
            fmt::format("config: {}={}, but this firmware has {}. Use a number from 0 to {}, or -1 for all.",
                        token_of(module.gtag), wanted, available, available));
    }
    return wanted == ALL_INSTANCES ? available : wanted;
}

/// Reports a limit for a module that the firmware does not have.
Result<> check_missing(const Idrom &idrom, const Config &config) {
    for (const auto &[gtag, wanted] : config.wanted) {
        const std::string_view token = token_of(gtag);
        const bool present = std::ranges::any_of(
            idrom.modules, [&](const ModuleDescriptor &module) { return token_of(module.gtag) == token; });
        if (wanted > 0 && !present) {
            return fail(fmt::format("config: {}={}, but this firmware has 0.", token, wanted));
        }
    }
    for (const Gtag gtag : {Gtag::SSI, Gtag::BISS, Gtag::FANUC_ABSOLUTE}) {
        const bool present = std::ranges::count(idrom.modules, gtag, &ModuleDescriptor::gtag) > 0;
        if (!config.formats_of(gtag)->empty() && !present) {
            return fail(
                fmt::format("config: a format of {}, but this firmware has 0 channels.", module_name(gtag)));
        }
    }
    return {};
}

UsedModule used_module(const ModuleDescriptor &module, const IdromHeader &header, int instances) {
    UsedModule used;
    used.descriptor = module;
    used.instances = instances;
    used.clock_hz = module.fast_clock ? header.clock_high_hz : header.clock_low_hz;
    used.register_stride = static_cast<std::uint16_t>(header.register_strides[module.register_stride & 1U]);
    used.instance_stride = static_cast<std::uint16_t>(header.instance_strides[module.instance_stride & 1U]);
    return used;
}

}  // namespace

bool isSupported(const ModuleDescriptor &module) noexcept {
    const Known *known = known_of(module.gtag);
    if (known == nullptr) {
        return false;
    }
    for (const std::uint8_t version : known->versions) {
        if (version == ANY) {
            return false;
        }
        if (version == module.version) {
            return true;
        }
    }
    return false;
}

std::string_view module_name(Gtag gtag) noexcept {
    const Known *known = known_of(gtag);
    return known == nullptr ? "unknown" : known->name;
}

Result<Assignment> assign(const Idrom &idrom, const Config &config, int leds) {
    Assignment assignment;
    if (auto present = check_missing(idrom, config); !present) {
        return std::unexpected(present.error());
    }
    for (const ModuleDescriptor &module : idrom.modules) {
        const auto instances = used_instances(module, config, leds);
        if (!instances) {
            return std::unexpected(instances.error());
        }
        const bool is_second = std::ranges::any_of(
            assignment.modules, [&](const UsedModule &used) { return used.descriptor.gtag == module.gtag; });
        if (is_second) {
            assignment.warnings.push_back(fmt::format(
                "Module {} (gtag {}) at 0x{:04X} is the second of its type and not used. Its pins are GPIO.",
                module_name(module.gtag), static_cast<int>(module.gtag), module.base_address));
        } else if (isSupported(module)) {
            assignment.modules.push_back(used_module(module, idrom.header, *instances));
        } else if (!isIgnored(module)) {
            assignment.warnings.push_back(fmt::format("Module {} (gtag {}) version {} at 0x{:04X} is not "
                                                      "supported and not used. Its pins are GPIO.",
                                                      module_name(module.gtag), static_cast<int>(module.gtag),
                                                      module.version, module.base_address));
        }
    }
    int number = 0;
    for (const PinDescriptor &pin : idrom.pins) {
        UsedPin used;
        used.number = number++;
        if (isUsed(pin, assignment, config)) {
            used.module = pin.secondary;
            used.instance = pin.unit;
            used.function = pin.secondary_pin;
        }
        assignment.pins.push_back(used);
    }
    return assignment;
}

}  // namespace mw::mesa
