// SPDX-License-Identifier: GPL-2.0-or-later
// Serial interfaces of a board without pins, for other components through hostmot2-serial.h.
#pragma once

#include <string>
#include <vector>

namespace mw::mesa {

class Uart;
class PacketUart;
class BufferedSpi;

/// An interface and its name without the name of the board, such as "uart.0".
template <class Port>
struct NamedPort {
    std::string name;
    Port *port = nullptr;
};

/// Valid as long as the board.
struct Ports {
    std::vector<NamedPort<Uart>> uarts;
    std::vector<NamedPort<PacketUart>> packet_uarts;
    std::vector<NamedPort<BufferedSpi>> spis;
};

}  // namespace mw::mesa
