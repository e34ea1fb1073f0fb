// SPDX-License-Identifier: GPL-2.0-or-later
// The contents of a configuration file of mb2hal: links, and the transactions that are repeated on them. The
// format is that of LinuxCNC's mb2hal (versions 1.0 and 1.1).
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"

namespace mw::modbus {

/// Function codes of the Modbus protocol.
enum class Function {
    READ_COILS = 1,
    READ_DISCRETE_INPUTS = 2,
    READ_HOLDING_REGISTERS = 3,
    READ_INPUT_REGISTERS = 4,
    WRITE_SINGLE_COIL = 5,
    WRITE_SINGLE_REGISTER = 6,
    WRITE_MULTIPLE_COILS = 15,
    WRITE_MULTIPLE_REGISTERS = 16,
};

bool isRead(Function function);
/// True if its elements are bits, not 16-bit registers.
bool isOfBits(Function function);

/// A serial line or TCP connection, shared by transactions.
struct Link {
    bool is_tcp = false;
    std::string address;  ///< TCP_IP
    int port = 502;
    std::string device;  ///< SERIAL_PORT
    int baud = 0, bits = 0, stop = 0;
    char parity = 'N';  ///< N, E, O

    bool operator==(const Link &) const = default;
};

struct Transaction {
    std::string name;      ///< prefix of its pins: HAL_TX_NAME, or its number
    std::size_t link = 0;  ///< index of the link
    Function function = Function::READ_COILS;
    int slave = 0;
    int first_element = 0;
    std::vector<std::string> elements;  ///< names of pins: "00", "01", or PIN_NAMES
    int response_timeout_ms = 500;
    int byte_timeout_ms = 500;
    int delay_ms = 0;        ///< delay after each transaction on a serial line
    double max_rate_hz = 0;  ///< 0: maximum rate of the link
    int debug = 1;           ///< 0 silent, 1 errors, 2 successes too, 3 and 4 all bytes
};

struct Setup {
    std::string component = "mb2hal";
    double slowdown_s = 0;
    std::vector<Link> links;
    std::vector<Transaction> transactions;
};

/// Reads the setup of a file and reports all errors; the setup is valid only if the sink has no errors then.
Setup read_setup(const ini::IniFile &file, diagnostics::Sink &sink);

}  // namespace mw::modbus
