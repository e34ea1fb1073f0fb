// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hm2_eth/ethernet_boards.hh"

#include <cerrno>
#include <charconv>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "drivers/mesa/ethernet/cycle_record_file.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/ethernet/ethernet_pins.hh"
#include "drivers/mesa/ethernet/network_setup.hh"
#include "drivers/mesa/hostmot2/forwarding_bus.hh"
#include "drivers/mesa/lbp16/udp_transport.hh"
#include "drivers/mesa/virtual/virtual_board.hh"
#include "millwright_ext.h"

namespace mw::mesa {

namespace {

/// A bus with pins for its settings and results.
class PinnedBus final : public ForwardingBus {
  public:
    PinnedBus(std::unique_ptr<EthernetBus> bus, EthernetPins &pins)
        : ForwardingBus(*bus), bus_(std::move(bus)), pins_(pins) {}

    void request() noexcept override {
        pins_.before(*bus_);
        bus_->request();
    }
    CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept override {
        pins_.before(*bus_);
        const CycleRead result = bus_->read(values, period_ns);
        pins_.after(*bus_, period_ns);
        return result;
    }

  private:
    std::unique_ptr<EthernetBus> bus_;
    EthernetPins &pins_;
};

struct EthernetBoard {
    std::string name;
    BoardAddress address;
    std::optional<BoardRoute> route;  ///< empty: not found, reported by a warning
    std::optional<CycleRecordFile> cycles;
    std::unique_ptr<PinnedBus> bus;
    std::optional<FixedArpEntry> arp;
};

std::vector<EthernetBoard> &boards() {
    static std::vector<EthernetBoard> all;
    return all;
}

std::vector<BoardFirewall> &firewalls() {
    static std::vector<BoardFirewall> all;
    return all;
}

int refuse(const Error &error) {
    rtapi_print_msg(RTAPI_MSG_ERR, "hm2_eth: %s\n", error.str().c_str());
    return -EIO;
}

/// ADDRESS or ADDRESS:PORT.
Result<BoardAddress> address_of(std::string_view text) {
    const std::size_t colon = text.find(':');
    BoardAddress address{.ip = std::string(text.substr(0, colon))};
    if (colon != std::string_view::npos) {
        const std::string_view port = text.substr(colon + 1);
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
        if (error != std::errc() || end != port.data() + port.size() || address.port == 0) {
            return fail(fmt::format("board_ip={}: '{}' is no port, 1 to 65535", text, port));
        }
    }
    return address;
}

/// Reports a failure as a warning if the board works without it.
template <class T>
std::optional<T> optional_of(Result<T> result, const std::string &name) {
    if (!result) {
        rtapi_print_msg(RTAPI_MSG_WARN, "%s: %s\n", name.c_str(), result.error().str().c_str());
        return std::nullopt;
    }
    return std::move(*result);
}

void find_board(EthernetBoard &board, const MacAddress &mac) {
    board.route = optional_of(find_route(board.address.ip), board.name);
    if (board.route && !board.route->loopback) {
        auto arp = optional_of(FixedArpEntry::create(*board.route, board.address.ip, mac), board.name);
        if (arp) {
            board.arp.emplace(std::move(*arp));
        }
    }
}

/// Creates one firewall for each interface, because it passes only packets of known boards.
void close_interfaces() {
    std::map<std::string, std::vector<const EthernetBoard *>> interfaces;
    for (const EthernetBoard &board : boards()) {
        if (board.route && !board.route->loopback) {
            interfaces[board.route->interface].push_back(&board);
        }
    }
    for (const auto &[interface, reached] : interfaces) {
        std::vector<BoardAddress> addresses;
        for (const EthernetBoard *board : reached) {
            addresses.push_back(board->address);
        }
        if (auto firewall = optional_of(BoardFirewall::create(*reached.front()->route, addresses),
                                        reached.front()->name)) {
            firewalls().push_back(std::move(*firewall));
        }
    }
}

bool isVirtual() {
    return mw_ext_is_virtual() != 0;
}

const char *value_at(std::span<char *const> values, std::size_t i) {
    return i < values.size() && values[i] != nullptr ? values[i] : "";
}

/// Opens the connection to board number `i`.
Result<std::unique_ptr<lbp16::Transport>> open_transport(const EthernetLoad &load, std::size_t i,
                                                         const BoardAddress &address) {
    if (!isVirtual()) {
        auto udp = lbp16::UdpTransport::open(address.ip, address.port);
        return udp ? Result<std::unique_ptr<lbp16::Transport>>(std::move(*udp))
                   : std::unexpected(udp.error());
    }
    VirtualBoardPlan plan = virtual_board_of(load.addresses[i]);
    if (plan.model.empty()) {
        plan = with_paths(parse_virtual_board(value_at(load.virtual_boards, i)));
    }
    if (plan.model.empty()) {
        return fail(fmt::format("{}, or virtual_board=7i76e", missing_virtual_board(load.addresses[i])));
    }
    return open_virtual_board(plan, [] { return static_cast<std::int64_t>(rtapi_get_time()); });
}

int load_board(const EthernetLoad &load, std::size_t i, std::map<std::string, int> &numbers) {
    const auto address = address_of(load.addresses[i]);
    if (!address) {
        return refuse(address.error());
    }
    auto transport = open_transport(load, i, *address);
    if (!transport) {
        return refuse(transport.error());
    }
    auto bus = EthernetBus::open(std::move(*transport), load.addresses[i]);
    if (!bus) {
        return refuse(bus.error());
    }
    auto *const pins = sdk::make<EthernetPins>();
    if (pins == nullptr) {
        return -ENOMEM;
    }
    const std::string card = (*bus)->card_name();
    const std::string name = fmt::format("hm2_{}.{}", card, numbers[card]++);
    if (!(*bus)->isKnownCard()) {
        rtapi_print_msg(RTAPI_MSG_WARN, "%s: the card '%s' at %s is not known; its firmware describes it\n",
                        name.c_str(), (*bus)->reported_name().c_str(), load.addresses[i]);
    }
    EthernetBoard board{
        .name = name, .address = *address, .route = {}, .cycles = {}, .bus = nullptr, .arp = {}};
    if (!isVirtual()) {
        find_board(board, (*bus)->mac());
        board.cycles = optional_of(CycleRecordFile::create(name, load.addresses[i]), name);
    }
    if (board.cycles) {
        (*bus)->record_cycles_in(board.cycles->record());
    }
    board.bus = std::make_unique<PinnedBus>(std::move(*bus), *pins);
    boards().push_back(std::move(board));
    const int status =
        register_board({load.comp_id, name, boards().back().bus.get(), value_at(load.configs, i)});
    if (status != 0) {
        return status;
    }
    sdk::Declare declare(load.comp_id, name.c_str(), static_cast<int>(i));
    pins->declare(declare);
    return declare.status();
}

}  // namespace

int load_ethernet_boards(const EthernetLoad &load) {
    if (load.firewall != "auto" && load.firewall != "nft" && load.firewall != "none") {
        return refuse(
            {.message = fmt::format("firewall={}: auto, nft and none are possible", load.firewall)});
    }
    std::map<std::string, int> numbers;
    std::size_t count = 0;
    for (;
         count < load.addresses.size() && load.addresses[count] != nullptr && *load.addresses[count] != '\0';
         ++count) {
        const int status = load_board(load, count, numbers);
        if (status != 0) {
            return status;
        }
    }
    if (count == 0) {
        return refuse({.message = "no board is given, such as board_ip=192.168.1.121"});
    }
    if (load.firewall != "none" && !isVirtual()) {
        close_interfaces();
    }
    return 0;
}

void unload_ethernet_boards(int comp_id) {
    unregister_boards(comp_id);
    boards().clear();
    firewalls().clear();
}

}  // namespace mw::mesa
