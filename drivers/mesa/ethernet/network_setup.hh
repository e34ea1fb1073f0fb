// SPDX-License-Identifier: GPL-2.0-or-later
// The network settings of the computer for a board: a fixed entry in the ARP table, so that no request waits
// for one, and a rule that keeps other packets off the interface. Both need CAP_NET_ADMIN. Without it the
// board works, and a warning names the missing setting. The driver removes both when it ends.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa {

/// Address of a board.
struct BoardAddress {
    std::string ip;
    std::uint16_t port = lbp16::BOARD_PORT;
};

/// The interface to a board.
struct BoardRoute {
    std::string interface;           ///< such as eth1
    std::string own_address;         ///< address of this computer on the interface
    bool has_default_route = false;  ///< the interface is also used for other traffic
    bool loopback = false;
};

/// Finds the interface by asking the kernel for the route. [while loading]
Result<BoardRoute> find_route(const std::string &board_address);

using MacAddress = std::array<std::uint8_t, 6>;

/// An ARP entry that does not expire; the destructor removes it.
class FixedArpEntry {
  public:
    /// [while loading]
    static Result<FixedArpEntry> create(const BoardRoute &route, const std::string &board_address,
                                        const MacAddress &mac);
    FixedArpEntry(FixedArpEntry &&other) noexcept;
    FixedArpEntry &operator=(FixedArpEntry &&) = delete;
    ~FixedArpEntry();

  private:
    FixedArpEntry(std::string interface, std::string board_address)
        : interface_(std::move(interface)), board_address_(std::move(board_address)) {}

    std::string interface_, board_address_;  ///< no interface: nothing is removed
};

/// The nft rules that pass packets to the boards and block all others on the interface.
std::string firewall_rules(const BoardRoute &route, const std::vector<BoardAddress> &boards);

/// The nft table for one interface, with all its boards. The destructor removes it; after SIGKILL it remains
/// until the next start.
class BoardFirewall {
  public:
    /// An error if nft is missing, if this process has no permission, or if the interface has the default
    /// route, because other traffic of the computer needs it then. [while loading]
    static Result<BoardFirewall> create(const BoardRoute &route, const std::vector<BoardAddress> &boards);
    BoardFirewall(BoardFirewall &&other) noexcept;
    BoardFirewall &operator=(BoardFirewall &&) = delete;
    ~BoardFirewall();

  private:
    explicit BoardFirewall(std::string table) : table_(std::move(table)) {}

    std::string table_;
};

}  // namespace mw::mesa
