// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/epp/hal/epp_boards.hh"

#include <cerrno>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "drivers/mesa/direct/hal/direct_boards.hh"
#include "drivers/mesa/epp/epp_registers.hh"
#include "drivers/mesa/virtual/virtual_board.hh"
#include "millwright_ext.h"
#include "rtapi.h"
#include "rtapi_parport.h"

namespace mw::mesa {

namespace {

/// Access to the I/O ports of the computer; the process needs CAP_SYS_RAWIO.
class DirectPort final : public epp::Port {
  public:
    explicit DirectPort(const rtapi_parport_t &port) : port_(port) {}
    ~DirectPort() override { rtapi_parport_release(&port_); }
    DirectPort(const DirectPort &) = delete;
    DirectPort &operator=(const DirectPort &) = delete;

    std::uint8_t read(epp::Register reg) noexcept override { return rtapi_inb(address_of(reg)); }
    void write(epp::Register reg, std::uint8_t value) noexcept override {
        rtapi_outb(value, address_of(reg));
    }
    std::uint32_t read_wide() noexcept override { return rtapi_inl(address_of(epp::Register::EPP_DATA)); }
    void write_wide(std::uint32_t value) noexcept override {
        rtapi_outl(value, address_of(epp::Register::EPP_DATA));
    }

  private:
    unsigned short address_of(epp::Register reg) const noexcept {
        return static_cast<unsigned short>(port_.base + static_cast<unsigned>(reg));
    }
    rtapi_parport_t port_;
};

struct EppFacts {
    const char *module;
    DirectCard card;
};

/// Names of connectors and lamps as in LinuxCNC's drivers. The first time-out stops the traffic, as in
/// LinuxCNC.
EppFacts facts_of(EppCard card) {
    if (card == EppCard::CARD_7I43) {
        return {"hm2_7i43",
                {.hal_name = "7i43",
                 .connectors = {"P4", "P3"},
                 .port_width = 24,
                 .leds = 8,
                 .most_failures = 1}};
    }
    return {"hm2_7i90",
            {.hal_name = "7i90",
             .connectors = {"P1", "P2", "P3"},
             .port_width = 24,
             .leds = 2,
             .most_failures = 1}};
}

/// Under the virtual clock: MILLWRIGHT_MESA=hm2_7i90=7i90, and hm2_7i90.1= for a second board.
int load_virtual_board(const EppLoad &load, std::size_t i, EppFacts facts) {
    const std::string key = i == 0 ? std::string(facts.module) : fmt::format("{}.{}", facts.module, i);
    const VirtualBoardPlan plan = virtual_board_of(key);
    Result<VirtualRegisters> board =
        plan.model.empty()
            ? fail(missing_virtual_board(key))
            : open_virtual_registers(plan, [] { return static_cast<std::int64_t>(rtapi_get_time()); });
    if (!board) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", facts.module, board.error().str().c_str());
        return -ENODEV;
    }
    return add_direct_board({.comp_id = load.comp_id,
                             .module = facts.module,
                             .access = std::move(board->access),
                             .card = std::move(facts.card),
                             .place = key,
                             .config = text_at(load.configs, i)});
}

int load_board(const EppLoad &load, std::size_t i) {
    EppFacts facts = facts_of(load.card);
    constexpr int MAX_PORT = 0xFFFF;
    const int address = load.addresses[i], high = i < load.high_addresses.size() ? load.high_addresses[i] : 0;
    if (address > MAX_PORT || high < 0 || high > MAX_PORT) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: ioaddr=%#x ioaddr_hi=%#x are not both from 0 to 0xffff\n",
                        facts.module, static_cast<unsigned>(address), static_cast<unsigned>(high));
        return -EINVAL;
    }
    if (mw_ext_is_virtual() != 0) {
        return load_virtual_board(load, i, std::move(facts));
    }
    rtapi_parport_t port{};
    const int status = rtapi_parport_get(facts.module, &port, static_cast<unsigned short>(address),
                                         static_cast<unsigned short>(high), 0);
    if (status < 0) {
        return status;
    }
    rtapi_parport_ecr_write(&port, epp::ECR_EPP);
    const bool is_wide = i >= load.wide.size() || load.wide[i] != 0;
    auto access = std::make_unique<epp::EppRegisters>(std::make_unique<DirectPort>(port),
                                                      is_wide ? epp::Width::WIDE : epp::Width::BYTES);
    return add_direct_board({.comp_id = load.comp_id,
                             .module = facts.module,
                             .access = std::move(access),
                             .card = std::move(facts.card),
                             .place = fmt::format("parallel port {:#x}", port.base),
                             .config = text_at(load.configs, i)});
}

}  // namespace

int load_epp_boards(const EppLoad &load) {
    for (std::size_t i = 0; i < load.addresses.size() && load.addresses[i] >= 0; ++i) {
        if (const int status = load_board(load, i); status != 0) {
            return status;
        }
    }
    return 0;
}

}  // namespace mw::mesa
