// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/spi/hal/spi_boards.hh"

#include <array>
#include <cerrno>
#include <memory>

#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/identity/idrom.hh"
#include "drivers/mesa/spi/spi_cards.hh"
#include "drivers/mesa/spi/spi_registers.hh"
#include "drivers/mesa/spi/spidev.hh"
#include "drivers/mesa/virtual/virtual_board.hh"
#include "millwright_ext.h"
#include "rtapi.h"

namespace mw::mesa {

namespace {

constexpr std::uint32_t HZ_IN_KHZ = 1000;
/// The maximum clock of a 7I90.
constexpr int MAX_RATE_KHZ = 62'500;
constexpr unsigned PROBE_BITS = 5;

/// The 8 characters of the board's name in the firmware; spaces if it does not answer.
std::string board_name_of(RegisterAccess &access) {
    constexpr std::uint16_t NAME_OFFSET = 12;
    std::uint32_t offset = 0;
    std::array<std::uint32_t, 2> words{};
    std::string name(8, ' ');
    if (!access.read(IDROM_OFFSET_ADDRESS, {&offset, 1}) ||
        !access.read(static_cast<std::uint16_t>((offset & 0xFFFCU) + NAME_OFFSET), words)) {
        return name;
    }
    for (std::size_t i = 0; i < name.size(); ++i) {
        name[i] = static_cast<char>((words[i / 4] >> (8 * (i % 4))) & 0xFFU);
    }
    return name;
}

int rate_of(std::span<const int> rates, std::size_t board, int fallback) {
    const int rate = board < rates.size() ? rates[board] : 0;
    return rate > 0 ? rate : fallback;
}

/// Under the virtual clock: MILLWRIGHT_MESA=/dev/spidev0.0=7i90.
int load_virtual_board(const SpiLoad &load) {
    const VirtualBoardPlan plan = virtual_board_of(load.path);
    Result<VirtualRegisters> board =
        plan.model.empty()
            ? fail(missing_virtual_board(load.path))
            : open_virtual_registers(plan, [] { return static_cast<std::int64_t>(rtapi_get_time()); });
    if (!board) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", load.module.c_str(), board.error().str().c_str());
        return -ENODEV;
    }
    DirectCard card = spi::card_of(board_name_of(*board->access));
    return add_direct_board({.comp_id = load.comp_id,
                             .module = load.module,
                             .access = std::move(board->access),
                             .card = std::move(card),
                             .place = load.path,
                             .config = load.config});
}

}  // namespace

int load_spi_board(const SpiLoad &load) {
    const int read_khz = load.read_rate_khz > 0 ? load.read_rate_khz : load.rate_khz;
    if (load.rate_khz < 1 || load.rate_khz > MAX_RATE_KHZ || read_khz > MAX_RATE_KHZ) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: clock rates of %d and %d kHz are not both from 1 to %d kHz\n",
                        load.module.c_str(), load.rate_khz, read_khz, MAX_RATE_KHZ);
        return -EINVAL;
    }
    if (mw_ext_is_virtual() != 0) {
        return load_virtual_board(load);
    }
    auto device =
        spi::open_spidev(load.path, {.read_hz = static_cast<std::uint32_t>(read_khz) * HZ_IN_KHZ,
                                     .write_hz = static_cast<std::uint32_t>(load.rate_khz) * HZ_IN_KHZ});
    if (!device) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", load.module.c_str(), device.error().str().c_str());
        return -ENODEV;
    }
    auto access = std::make_unique<spi::SpiRegisters>(std::move(*device));
    DirectCard card = spi::card_of(board_name_of(*access));
    return add_direct_board({.comp_id = load.comp_id,
                             .module = load.module,
                             .access = std::move(access),
                             .card = std::move(card),
                             .place = load.path,
                             .config = load.config});
}

int load_probed_boards(const ProbeLoad &load) {
    if (load.probe == 0 || load.probe >= 1U << PROBE_BITS) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: spi_probe=%u is not from 1 to %u\n", load.module.c_str(),
                        load.probe, (1U << PROBE_BITS) - 1);
        return -EINVAL;
    }
    std::size_t board = 0;
    for (unsigned i = 0; i < PROBE_BITS; ++i) {
        if ((load.probe & (1U << i)) == 0) {
            continue;
        }
        const int rate = rate_of(load.rates_khz, board, rate_of(load.rates_khz, 0, 0));
        const int status = load_spi_board({.comp_id = load.comp_id,
                                           .module = load.module,
                                           .path = spi::path_of_probe(1U << i),
                                           .rate_khz = rate,
                                           .read_rate_khz = rate_of(load.read_rates_khz, board, 0),
                                           .config = text_at(load.configs, board)});
        if (status != 0) {
            return status;
        }
        ++board;
    }
    return 0;
}

}  // namespace mw::mesa
