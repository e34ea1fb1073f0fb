// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated board on a UDP port.
#pragma once

#include <csignal>
#include <string>

#include "base/result.hh"
#include "drivers/mesa/board/link.hh"

namespace mw::mesa::board {

/// Address of the board, and its time.
struct ServerSettings {
    std::string address = "127.0.0.1";
    std::uint16_t port = lbp16::BOARD_PORT;
    bool virtual_time = false;  ///< each request with a read advances the time by `period_ns`
    std::int64_t period_ns = 1'000'000;
    std::function<void()> listening;  ///< called once, when packets are answered
};

/// "ADDRESS:PORT" or "ADDRESS".
Result<> read_listen_address(const std::string &text, ServerSettings &settings);

/// Answers packets until `stop` is not 0. Errors: the port cannot be opened, or reading from it fails.
Result<> serve(Link &link, const ServerSettings &settings, const volatile std::sig_atomic_t &stop);

}  // namespace mw::mesa::board
