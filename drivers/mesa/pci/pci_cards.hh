// SPDX-License-Identifier: GPL-2.0-or-later
// Mesa cards on PCI by their numbers. Sources: shared/hardware.md, part C1; the subsystem numbers, memory
// regions, connectors and lamps are those of LinuxCNC's hm2_pci.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace mw::mesa {

/// The numbers in the configuration space of a card.
struct PciIds {
    std::uint16_t vendor = 0, device = 0, subsystem_vendor = 0, subsystem_device = 0;
};

constexpr std::uint16_t MESA_VENDOR = 0x2718, PLX_VENDOR = 0x10B5;
constexpr std::uint16_t PLX_9030 = 0x9030, PLX_9054 = 0x9054, PLX_9056 = 0x9056;
constexpr std::size_t MOST_PCI_PORTS = 6;

/// A type of card.
struct PciCard {
    PciIds ids;  ///< for Mesa's own chips the subsystem is not compared
    std::string_view hal_name;
    std::uint8_t region = 0;  ///< the memory region (BAR) of the registers
    std::uint8_t ports = 0, port_width = 0, leds = 0;
    std::array<std::string_view, MOST_PCI_PORTS> connectors{};
};

inline constexpr PciCard PCI_CARDS[] = {
    {{PLX_VENDOR, PLX_9030, PLX_VENDOR, 0x3131}, "5i20", 5, 3, 24, 8, {"P2", "P3", "P4"}},
    {{PLX_VENDOR, PLX_9030, PLX_VENDOR, 0x3132}, "4i65", 5, 3, 24, 8, {"P1", "P3", "P4"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3133}, "4i68", 3, 3, 24, 4, {"P1", "P2", "P4"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3311}, "4i68", 3, 3, 24, 4, {"P1", "P2", "P4"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3312}, "5i21", 3, 2, 32, 8, {"P1", "P1"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3313}, "5i22", 3, 4, 24, 8, {"P2", "P3", "P4", "P5"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3314}, "5i22", 3, 4, 24, 8, {"P2", "P3", "P4", "P5"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3315}, "5i23", 3, 3, 24, 2, {"P2", "P3", "P4"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3472}, "4i69", 3, 3, 24, 0, {"P1", "P3", "P4"}},
    {{PLX_VENDOR, PLX_9054, PLX_VENDOR, 0x3473}, "4i69", 3, 3, 24, 0, {"P1", "P3", "P4"}},
    {{PLX_VENDOR, PLX_9056, PLX_VENDOR, 0x3427}, "3x20", 3, 6, 24, 0, {"P4", "P5", "P6", "P9", "P8", "P7"}},
    {{PLX_VENDOR, PLX_9056, PLX_VENDOR, 0x3428}, "3x20", 3, 6, 24, 0, {"P4", "P5", "P6", "P9", "P8", "P7"}},
    {{PLX_VENDOR, PLX_9056, PLX_VENDOR, 0x3429}, "3x20", 3, 6, 24, 0, {"P4", "P5", "P6", "P9", "P8", "P7"}},
    {{MESA_VENDOR, 0x5124, 0, 0}, "5i24", 0, 3, 24, 2, {"P4", "P3", "P2"}},
    {{MESA_VENDOR, 0x5125, 0, 0}, "5i25", 0, 2, 17, 2, {"P3", "P2"}},
    {{MESA_VENDOR, 0x5925, 0, 0}, "5i25", 0, 2, 17, 2, {"P3", "P2"}},
    {{MESA_VENDOR, 0x6125, 0, 0}, "6i25", 0, 2, 17, 2, {"P3", "P2"}},
    {{MESA_VENDOR, 0x6925, 0, 0}, "6i25", 0, 2, 17, 2, {"P3", "P2"}},
};

/// The card with these numbers; nullptr: not known.
constexpr const PciCard *find_pci_card(const PciIds &ids) noexcept {
    for (const PciCard &card : PCI_CARDS) {
        const bool is_subsystem =
            card.ids.vendor == MESA_VENDOR || (card.ids.subsystem_vendor == ids.subsystem_vendor &&
                                               card.ids.subsystem_device == ids.subsystem_device);
        if (card.ids.vendor == ids.vendor && card.ids.device == ids.device && is_subsystem) {
            return &card;
        }
    }
    return nullptr;
}

/// The bridge of a PLX 9030 acknowledges an access only when bit 1 of its four region descriptors is set.
struct Plx9030 {
    static constexpr std::uint16_t DESCRIPTORS[] = {0x28, 0x2C, 0x30, 0x34};
    static constexpr std::uint32_t READY_INPUT = 2;
};

}  // namespace mw::mesa
