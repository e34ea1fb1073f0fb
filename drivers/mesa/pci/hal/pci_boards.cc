// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/pci/hal/pci_boards.hh"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/pci/pci_cards.hh"
#include "drivers/mesa/pci/pci_registers.hh"
#include "drivers/mesa/virtual/virtual_board.hh"
#include "millwright_ext.h"
#include "rtapi.h"
#include "rtapi_pci.h"

namespace mw::mesa {

namespace {

/// State of the load, because rtapi calls functions without a context.
struct Load {
    int comp_id = 0;
    std::span<char *const> configs;
    std::size_t found = 0;
    int status = 0;
};

Load &current() {
    static Load load;
    return load;
}

std::array<rtapi_pci_device_id, std::size(PCI_CARDS) + 1> id_table() {
    std::array<rtapi_pci_device_id, std::size(PCI_CARDS) + 1> table{};
    for (std::size_t i = 0; i < std::size(PCI_CARDS); ++i) {
        const PciIds &ids = PCI_CARDS[i].ids;
        const bool is_mesa = ids.vendor == MESA_VENDOR;
        table[i].vendor = ids.vendor;
        table[i].device = ids.device;
        table[i].subvendor = is_mesa ? RTAPI_PCI_ANY_ID : ids.subsystem_vendor;
        table[i].subdevice = is_mesa ? RTAPI_PCI_ANY_ID : ids.subsystem_device;
    }
    return table;
}

/// Sets the bridge of a 5I20 or 4I65 to acknowledge accesses.
void prepare_bridge(rtapi_pci_dev &device) {
    volatile void *const mapped = rtapi_pci_ioremap_bar(&device, 0);
    if (mapped == nullptr) {
        return;  // reported; if the bridge is not ready, the card has no valid cookie
    }
    auto *const registers = static_cast<volatile std::uint32_t *>(mapped);
    for (const std::uint16_t offset : Plx9030::DESCRIPTORS) {
        const std::uint32_t value = registers[offset / 4U];
        if ((value & Plx9030::READY_INPUT) == 0) {
            registers[offset / 4U] = value | Plx9030::READY_INPUT;
        }
    }
    rtapi_iounmap(mapped);
}

DirectCard direct_card(const PciCard &card) {
    DirectCard direct{.hal_name = std::string(card.hal_name),
                      .connectors = {},
                      .port_width = card.port_width,
                      .leds = card.leds,
                      .most_failures = 5};
    for (std::size_t port = 0; port < card.ports; ++port) {
        direct.connectors.emplace_back(card.connectors.at(port));
    }
    return direct;
}

int load_card(rtapi_pci_dev &device, const PciCard &card) {
    const std::string place = fmt::format("PCI {}", rtapi_pci_name(&device));
    if (rtapi_pci_resource_len(&device, card.region) != PCI_REGISTER_BYTES) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2_pci: the card %.*s at %s has no memory region %d of 64 KiB\n",
                        static_cast<int>(card.hal_name.size()), card.hal_name.data(), place.c_str(),
                        card.region);
        return -ENODEV;
    }
    if (const int status = rtapi_pci_enable_device(&device); status != 0) {
        return status;
    }
    if (card.ids.device == PLX_9030) {
        prepare_bridge(device);
    }
    volatile void *const mapped = rtapi_pci_ioremap_bar(&device, card.region);
    if (mapped == nullptr) {
        return -ENODEV;
    }
    auto access = std::make_unique<PciRegisters>(static_cast<volatile std::uint32_t *>(mapped),
                                                 [mapped] { rtapi_iounmap(mapped); });
    return add_direct_board({.comp_id = current().comp_id,
                             .module = "hm2_pci",
                             .access = std::move(access),
                             .card = direct_card(card),
                             .place = place,
                             .config = text_at(current().configs, current().found)});
}

int probe(rtapi_pci_dev *device, const rtapi_pci_device_id * /*entry*/) {
    Load &load = current();
    const PciCard *card = find_pci_card({.vendor = device->vendor,
                                         .device = device->device,
                                         .subsystem_vendor = device->subsystem_vendor,
                                         .subsystem_device = device->subsystem_device});
    if (card == nullptr || load.status != 0) {
        return -ENODEV;
    }
    if (load.found == MAX_PCI_BOARDS) {
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2_pci: more than %d cards; the others are not used\n",
                        MAX_PCI_BOARDS);
        return -ENODEV;
    }
    load.status = load_card(*device, *card);
    ++load.found;
    return 0;  // also after an error, because the memory remains mapped until all boards are removed
}

void remove(rtapi_pci_dev *device) {
    rtapi_pci_disable_device(device);
}

rtapi_pci_driver &driver() {
    static const auto table = id_table();
    static rtapi_pci_driver instance{
        .name = "hm2_pci", .id_table = table.data(), .probe = probe, .remove = remove, .devices = nullptr};
    return instance;
}

}  // namespace

namespace {

/// The card with this name in its firmware: 5I20.
const PciCard *find_named_card(const std::string &name) {
    std::string hal_name = name.substr(0, name.find('-'));
    std::ranges::transform(hal_name, hal_name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto *card = std::ranges::find(PCI_CARDS, hal_name, &PciCard::hal_name);
    return card == std::end(PCI_CARDS) ? nullptr : card;
}

int refuse(const std::string &text) {
    rtapi_print_msg(RTAPI_MSG_ERR, "hm2_pci: %s\n", text.c_str());
    return -ENODEV;
}

/// Under the virtual clock: MILLWRIGHT_MESA=hm2_pci=5i20,hm2_pci.1=5i23.
int load_virtual_cards(int comp_id, std::span<char *const> configs) {
    for (std::size_t i = 0; i < MAX_PCI_BOARDS; ++i) {
        const std::string key = i == 0 ? "hm2_pci" : fmt::format("hm2_pci.{}", i);
        const VirtualBoardPlan plan = virtual_board_of(key);
        if (plan.model.empty()) {
            return i > 0 ? 0 : refuse(missing_virtual_board(key));
        }
        auto board = open_virtual_registers(plan, [] { return static_cast<std::int64_t>(rtapi_get_time()); });
        if (!board) {
            return refuse(board.error().str());
        }
        const PciCard *card = find_named_card(board->card_name);
        if (card == nullptr) {
            return refuse(fmt::format("the model {} is no card on PCI", board->card_name));
        }
        if (const int status = add_direct_board({.comp_id = comp_id,
                                                 .module = "hm2_pci",
                                                 .access = std::move(board->access),
                                                 .card = direct_card(*card),
                                                 .place = key,
                                                 .config = text_at(configs, i)});
            status != 0) {
            return status;
        }
    }
    return 0;
}

bool isVirtual() {
    return mw_ext_is_virtual() != 0 && std::getenv("MILLWRIGHT_SYSFS") == nullptr;
}

}  // namespace

int load_pci_boards(int comp_id, std::span<char *const> configs) {
    if (isVirtual()) {
        return load_virtual_cards(comp_id, configs);
    }
    current() = {.comp_id = comp_id, .configs = configs, .found = 0, .status = 0};
    int status = rtapi_pci_register_driver(&driver());
    if (status == 0) {
        status = current().status;
    }
    if (status == 0 && current().found == 0) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "hm2_pci: there is no Mesa card on PCI; lspci -nn lists the cards of the computer\n");
        status = -ENODEV;
    }
    return status;
}

void unload_pci_boards(int comp_id) {
    remove_direct_boards(comp_id);
    rtapi_pci_unregister_driver(&driver());
}

}  // namespace mw::mesa
