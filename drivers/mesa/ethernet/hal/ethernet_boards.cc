// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/ethernet/hal/ethernet_boards.hh"

#include <cerrno>
#include <charconv>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/ethernet/ethernet_pins.hh"
#include "drivers/mesa/ethernet/network_setup.hh"
#include "drivers/mesa/lbp16/udp_transport.hh"

namespace mw::mesa {

namespace {

/// A bus whose settings and results are pins.
class PinnedBus final : public RegisterBus {
  public:
    PinnedBus(std::unique_ptr<EthernetBus> bus, EthernetPins &pins) : bus_(std::move(bus)), pins_(pins) {}

    std::string card_name() const override { return bus_->card_name(); }
    std::vector<std::string> connectors() const override { return bus_->connectors(); }
    Result<std::vector<std::uint32_t>> read_now(RegisterRange range) override {
        return bus_->read_now(range);
    }
    Result<> write_now(std::uint16_t address, std::span<const std::uint32_t> values) override {
        return bus_->write_now(address, values);
    }
    Result<> set_lists(std::span<const RegisterRange> reads, int max_writes) override {
        return bus_->set_lists(reads, max_writes);
    }
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
    bool write(std::span<const RegisterWrite> writes) noexcept override { return bus_->write(writes); }
    bool take_rewrite() noexcept override { return bus_->take_rewrite(); }

  private:
    std::unique_ptr<EthernetBus> bus_;
    EthernetPins &pins_;
};

struct EthernetBoard {
    std::unique_ptr<PinnedBus> bus;
    std::optional<FixedArpEntry> arp;
    std::optional<BoardFirewall> firewall;
};

std::vector<EthernetBoard> &boards() {
    static std::vector<EthernetBoard> all;
    return all;
}

int refuse(const Error &error) {
    rtapi_print_msg(RTAPI_MSG_ERR, "hm2_eth: %s\n", error.str().c_str());
    return -EIO;
}

/// An address with its port, which is the boards' own unless it is given.
struct Address {
    std::string ip;
    std::uint16_t port = lbp16::BOARD_PORT;
};

Result<Address> address_of(std::string_view text) {
    const std::size_t colon = text.find(':');
    Address address{.ip = std::string(text.substr(0, colon))};
    if (colon != std::string_view::npos) {
        const std::string_view port = text.substr(colon + 1);
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
        if (error != std::errc() || end != port.data() + port.size() || address.port == 0) {
            return fail(fmt::format("board_ip={}: '{}' is no port, 1 to 65535", text, port));
        }
    }
    return address;
}

/// What a board can do without is a warning.
template <class T>
std::optional<T> optional_of(Result<T> result, const std::string &name) {
    if (!result) {
        rtapi_print_msg(RTAPI_MSG_WARN, "%s: %s\n", name.c_str(), result.error().str().c_str());
        return std::nullopt;
    }
    return std::move(*result);
}

void prepare_network(EthernetBoard &board, const EthernetLoad &load, const std::string &name,
                     const std::string &ip, const MacAddress &mac) {
    const auto route = optional_of(find_route(ip), name);
    if (!route || route->loopback) {
        return;
    }
    if (auto arp = optional_of(FixedArpEntry::create(*route, ip, mac), name)) {
        board.arp.emplace(std::move(*arp));
    }
    if (load.firewall == "none") {
        return;
    }
    if (auto firewall = optional_of(BoardFirewall::create(*route, ip), name)) {
        board.firewall.emplace(std::move(*firewall));
    }
}

int load_board(const EthernetLoad &load, std::size_t i, std::map<std::string, int> &numbers) {
    const auto address = address_of(load.addresses[i]);
    if (!address) {
        return refuse(address.error());
    }
    auto transport = lbp16::UdpTransport::open(address->ip, address->port);
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
    EthernetBoard board;
    prepare_network(board, load, name, address->ip, (*bus)->mac());
    board.bus = std::make_unique<PinnedBus>(std::move(*bus), *pins);
    boards().push_back(std::move(board));
    const char *const config = i < load.configs.size() && load.configs[i] != nullptr ? load.configs[i] : "";
    const int status = register_board({load.comp_id, name, boards().back().bus.get(), config});
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
            unload_ethernet_boards(load.comp_id);
            return status;
        }
    }
    return count > 0 ? 0 : refuse({.message = "no board is given, such as board_ip=192.168.1.121"});
}

void unload_ethernet_boards(int comp_id) {
    unregister_boards(comp_id);
    boards().clear();
}

}  // namespace mw::mesa
