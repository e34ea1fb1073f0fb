// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/hal/serial.hh"

#include "rtapi.h"

namespace mw::mesa {

namespace {

template <class Port>
void add(std::vector<NamedPort<Port>> &all, const std::string &board,
         const std::vector<NamedPort<Port>> &ports, const char *type) {
    for (const NamedPort<Port> &port : ports) {
        all.push_back({board + "." + port.name, port.port});
        rtapi_print("hm2/%s: %s %s\n", board.c_str(), type, all.back().name.c_str());
    }
}

template <class Port>
void remove(std::vector<NamedPort<Port>> &all, const std::string &board) {
    const std::string prefix = board + ".";
    std::erase_if(all, [&](const NamedPort<Port> &port) { return port.name.starts_with(prefix); });
}

}  // namespace

Ports &known_ports() noexcept {
    static Ports instance;
    return instance;
}

void register_ports(const std::string &board, const Ports &ports) {
    add(known_ports().uarts, board, ports.uarts, "UART");
    add(known_ports().packet_uarts, board, ports.packet_uarts, "packet UART");
    add(known_ports().spis, board, ports.spis, "buffered SPI");
}

void unregister_ports(const std::string &board) {
    remove(known_ports().uarts, board);
    remove(known_ports().packet_uarts, board);
    remove(known_ports().spis, board);
}

}  // namespace mw::mesa
