// SPDX-License-Identifier: GPL-2.0-or-later
// millwright commission find: the hardware connected to this computer.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "base/options/command_line.hh"
#include "base/text.hh"
#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "drivers/mesa/lbp16/udp_transport.hh"
#include "programs/commission/parts.hh"

namespace mw::programs::commission {
namespace {

namespace fs = std::filesystem;

/// Factory addresses of Mesa boards, and that of a simulated board.
constexpr std::array USUAL_ADDRESSES{"192.168.1.121", "10.10.10.10", "127.0.0.1"};

struct FindWords {
    std::string root = "/";
    options::Words addresses;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright commission find [ADDRESS ...] [options]",
            "Lists the boards and ports at this computer: Mesa boards on the network and on "
            "PCI, parallel ports, serial\nadapters and input devices. It changes nothing.\n");
        line.text("--root", "FOLDER", "folder of /sys and /dev (/)", root);
        line.rest(addresses);
        line.footer("exit status: 0 something was found, 1 nothing, 2 wrong usage\n");
        return line;
    }
};

std::string first_line(const fs::path &path) {
    std::string line;
    std::ifstream file(path);
    std::getline(file, line);
    return std::string(trim(line));
}

std::vector<fs::path> entries(const fs::path &folder) {
    std::vector<fs::path> all;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        all.push_back(entry->path());
    }
    std::ranges::sort(all);
    return all;
}

int found(const std::string &what, const std::string &use) {
    fmt::print("{:<46} {}\n", printable(what), use);
    return 1;
}

int find_network(const options::Words &addresses) {
    int count = 0;
    for (const std::string &address : addresses) {
        auto transport = mesa::lbp16::UdpTransport::open(address, mesa::lbp16::BOARD_PORT);
        if (!transport.has_value()) {
            continue;
        }
        const auto bus = mesa::EthernetBus::open(std::move(*transport), address);
        if (bus.has_value()) {
            count +=
                found(fmt::format("Mesa {} at {}", (*bus)->reported_name(), address),
                      fmt::format("board.address={}; pins: millwright boards {} --pins", address, address));
        }
    }
    return count;
}

int find_pci(const fs::path &root) {
    int count = 0;
    for (const fs::path &device : entries(root / "sys/bus/pci/devices")) {
        if (first_line(device / "vendor") == "0x2718") {
            count +=
                found(fmt::format("Mesa board on PCI, device {}", first_line(device / "device")), "hm2_pci");
        }
    }
    return count;
}

int find_named(const fs::path &folder, const char *prefix, const char *what, const char *use) {
    int count = 0;
    for (const fs::path &entry : entries(folder)) {
        const std::string name = entry.filename().string();
        if (name.starts_with(prefix)) {
            count += found(fmt::format("{} {}", what, name), use);
        }
    }
    return count;
}

int find_inputs(const fs::path &root) {
    int count = 0;
    for (const fs::path &entry : entries(root / "sys/class/hidraw")) {
        std::ifstream file(entry / "device/uevent");
        for (std::string line; std::getline(file, line);) {
            constexpr std::string_view KEY = "HID_NAME=";
            if (line.starts_with(KEY)) {
                count += found("input device " + line.substr(KEY.size()), "hal_input");
            }
        }
    }
    return count;
}

}  // namespace

int command_find(const std::vector<std::string> &arguments) {
    FindWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    if (const auto parsed = words.line().parse(arguments); !parsed.has_value()) {
        fmt::print(stderr, "millwright commission find: {}\n", parsed.error().str());
        return 2;
    }
    if (words.addresses.empty()) {
        words.addresses.assign(USUAL_ADDRESSES.begin(), USUAL_ADDRESSES.end());
    }
    const fs::path root(words.root);
    int count = find_network(words.addresses);
    count += find_pci(root);
    count += find_named(root / "sys/class/parport", "parport", "parallel port", "board=parport");
    count += find_named(root / "dev/serial/by-id", "", "serial adapter", "spindle.drive=modbus");
    count += find_inputs(root);
    if (count == 0) {
        fmt::print("Nothing was found. Check power, cables, and the address of this computer's network "
                   "interface.\n");
    }
    return count > 0 ? 0 : 1;
}

}  // namespace mw::programs::commission
