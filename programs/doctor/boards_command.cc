// SPDX-License-Identifier: GPL-2.0-or-later
// millwright boards: the Mesa boards that answer on the network, the functions of their pins, and their
// firmware as a file.
#include <charconv>
#include <cstdio>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/identity/pin_names.hh"
#include "drivers/mesa/lbp16/udp_transport.hh"
#include "programs/commands.hh"

namespace mw::programs {
namespace {

/// Factory addresses of boards, by their jumpers.
constexpr const char *USUAL_ADDRESSES[] = {"192.168.1.121", "10.10.10.10"};

struct BoardsWords {
    options::Words addresses;
    std::string file;
    bool withPins = false;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright boards [ADDRESS[:PORT] ...] [options]",
            "Reads name and firmware of Mesa boards on Ethernet and changes nothing. Without an address it "
            "tries 192.168.1.121 and 10.10.10.10, the factory settings.\n");
        line.flag("--pins", "list all pins: connector, GPIO name in HAL, other functions", withPins);
        line.text("--save", "FILE", "write the firmware of the board to a file, for checks without the board",
                  file);
        line.rest(addresses);
        line.footer("exit status: 0 all boards answered, 1 one did not, 2 wrong usage\n");
        return line;
    }
};

struct FoundBoard {
    std::unique_ptr<mesa::EthernetBus> bus;
    mesa::board::Model model;
};

Result<FoundBoard> ask(const std::string &address) {
    const std::size_t colon = address.find(':');
    std::uint16_t port = mesa::lbp16::BOARD_PORT;
    if (colon != std::string::npos) {
        const char *const end = address.data() + address.size();
        const auto [rest, error] = std::from_chars(address.data() + colon + 1, end, port);
        if (error != std::errc() || rest != end || port == 0) {
            return fail(fmt::format("'{}' has no port from 1 to 65535", address));
        }
    }
    auto transport = mesa::lbp16::UdpTransport::open(address.substr(0, colon), port);
    if (!transport) {
        return std::unexpected(transport.error());
    }
    auto bus = mesa::EthernetBus::open(std::move(*transport), address);
    if (!bus) {
        return std::unexpected(bus.error());
    }
    auto idrom = mesa::decode_idrom([&](std::uint16_t at, int count) {
        return (*bus)->read_now({.address = at, .count = static_cast<std::uint16_t>(count)});
    });
    if (!idrom) {
        return std::unexpected(idrom.error());
    }
    FoundBoard found{.bus = std::move(*bus), .model = {}};
    found.model.card_name = found.bus->reported_name();
    found.model.idrom = std::move(*idrom);
    return found;
}

/// Position of a pin in the board's manual: a connector and its pin, or a group of terminals.
std::string place_of(const FoundBoard &board, int number) {
    const auto width = static_cast<int>(board.model.idrom.header.port_width);
    const auto names = board.bus->connectors();
    const auto port = static_cast<std::size_t>(number / width);
    const std::string name = port < names.size() ? names[port] : std::string();
    if (name.empty()) {
        return fmt::format("port {}", port);
    }
    const bool is_connector = name.front() == 'P' || name.front() == 'J';
    const int pin = is_connector ? mesa::connector_pin(width, number % width) : 0;
    return pin != 0 ? fmt::format("{} pin {}", name, pin) : name;
}

void print_board(const std::string &address, const FoundBoard &board) {
    const auto &header = board.model.idrom.header;
    const auto mac = board.bus->mac();
    fmt::print("{}: {}, hm2_{} in HAL, MAC {:02x}:{:02x}:{:02x}:{:02x}:{:02x}:{:02x}, {} x {} pins\n",
               address, board.bus->reported_name(), board.bus->card_name(), mac[0], mac[1], mac[2], mac[3],
               mac[4], mac[5], header.io_ports, header.port_width);
}

void print_pins(const FoundBoard &board) {
    int number = 0;
    for (const mesa::PinDescriptor &pin : board.model.idrom.pins) {
        const std::string function = mesa::pin_function(pin);
        fmt::print("  {:11} gpio.{:03}{}{}\n", language::shown(place_of(board, number)), number,
                   function.empty() ? "" : "  ", language::shown(function));
        ++number;
    }
}

Result<> save(const FoundBoard &board, const std::string &file) {
    const auto text = mesa::board::write_model(board.model);
    return text ? write_file_atomically(file, *text) : std::unexpected(text.error());
}

}  // namespace

int command_boards(const std::vector<std::string> &arguments) {
    BoardsWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || (!words.file.empty() && words.addresses.size() != 1)) {
        fmt::print(
            stderr, "millwright boards: {}\n",
            language::shown(parsed.has_value() ? "--save needs exactly one address" : parsed.error().str()));
        return 2;
    }
    const bool usual = words.addresses.empty();
    if (usual) {
        words.addresses.assign(std::begin(USUAL_ADDRESSES), std::end(USUAL_ADDRESSES));
    }
    std::size_t found = 0;
    for (const std::string &address : words.addresses) {
        const auto board = ask(address);
        if (!board) {
            fmt::print(stderr, "{}\n", language::shown(board.error().str()));
            continue;
        }
        ++found;
        print_board(address, *board);
        if (words.withPins) {
            print_pins(*board);
        }
        if (!words.file.empty()) {
            if (const auto saved = save(*board, words.file); !saved) {
                fmt::print(stderr, "{}\n", language::shown(saved.error().str()));
                return 1;
            }
        }
    }
    return found == words.addresses.size() || (usual && found > 0) ? 0 : 1;
}

}  // namespace mw::programs
