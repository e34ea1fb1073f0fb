// SPDX-License-Identifier: GPL-2.0-or-later
// The self-description of a HostMot2 firmware: the IDROM with its modules and pins. The driver and the
// simulated board share this description and nothing else. Source: shared/hardware.md, part B1.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::mesa {

constexpr std::uint16_t COOKIE_ADDRESS = 0x0100;
constexpr std::uint32_t COOKIE = 0x55AACAFE;
constexpr std::uint16_t CONFIG_NAME_ADDRESS = 0x0104;  ///< "HOSTMOT2", 8 characters
constexpr std::uint16_t IDROM_OFFSET_ADDRESS = 0x010C;

/// The maximum of a firmware: descriptors of modules (the last has gtag 0), and pins.
constexpr int MAX_MODULES = 48, MAX_PINS = 144;

/// The numbers of module types.
enum class Gtag : std::uint8_t {
    NONE = 0,
    IRQ = 1,
    WATCHDOG = 2,
    IO_PORT = 3,
    ENCODER = 4,
    STEPGEN = 5,
    PWM = 6,
    SSI = 8,
    UART_TX = 9,
    UART_RX = 10,
    TRANSLATION_RAM = 11,
    MUXED_ENCODER = 12,
    MUX_SELECT = 13,
    BSPI = 14,
    DBSPI = 15,
    THREE_PHASE_PWM = 19,
    BISS = 24,
    FANUC_ABSOLUTE = 25,
    DPLL = 26,
    PKT_UART_TX = 27,
    PKT_UART_RX = 28,
    IN_MUX = 30,
    IN_M = 35,
    DATA_PAINTER = 42,
    XY2_100 = 43,
    RC_PWM = 44,
    OUT_M = 45,
    LIO_PORT = 64,
    LED = 128,
    RESOLVER = 192,
    SMART_SERIAL = 193,
    SSR = 195,
    SMART_SERIAL_B = 198,
    ONE_SHOT = 199,
    PERIOD_METER = 200,
};

/// The numbers in the first words of the IDROM.
struct IdromHeader {
    std::uint32_t type = 0;                             ///< 2 or 3
    std::uint32_t modules_offset = 0, pins_offset = 0;  ///< from the IDROM [bytes]
    std::string board_name;                             ///< 8 characters, such as MESA7I76
    std::uint32_t fpga_size = 0, fpga_pins = 0;
    std::uint32_t io_ports = 0, io_width = 0, port_width = 0;
    std::uint32_t clock_low_hz = 0, clock_high_hz = 0;
    std::uint32_t instance_strides[2] = {}, register_strides[2] = {};  ///< [bytes]

    bool operator==(const IdromHeader &) const = default;
};

/// A module: `instances` of the type `gtag`. The address of register r of instance i is
/// base + r * register stride + i * instance stride.
struct ModuleDescriptor {
    Gtag gtag = Gtag::NONE;
    std::uint8_t version = 0;
    bool fast_clock = false;  ///< it counts ClockHigh
    std::uint8_t instances = 0;
    std::uint16_t base_address = 0;
    std::uint8_t registers = 0;
    std::uint8_t register_stride = 0, instance_stride = 0;  ///< selects the strides in the header
    std::uint32_t per_instance = 0;                         ///< bit r: register r exists in each instance

    bool operator==(const ModuleDescriptor &) const = default;
};

/// A pin and the module that can use it instead of the IO port.
struct PinDescriptor {
    std::uint8_t secondary_pin = 0;  ///< pin of the module; bit 7: output
    Gtag secondary = Gtag::NONE;     ///< NONE: the pin is only an input or output
    std::uint8_t unit = 0;           ///< instance of the module; 0x80: of all
    Gtag primary = Gtag::IO_PORT;

    bool operator==(const PinDescriptor &) const = default;
};

/// A whole description; modules without the last empty descriptor, pins in the order of the connectors.
struct Idrom {
    IdromHeader header;
    std::vector<ModuleDescriptor> modules;
    std::vector<PinDescriptor> pins;

    bool operator==(const Idrom &) const = default;
};

/// Reads `count` registers of 32 bits from `address`; an error is passed on unchanged.
using RegisterReader = std::function<Result<std::vector<std::uint32_t>>(std::uint16_t address, int count)>;

/// The connectors of a card, as known to its bus; 0: not known, not compared.
struct CardShape {
    std::uint32_t ports = 0, port_width = 0;
};

/// Reads the description of a firmware and checks it: cookie, name, type, port width, ports, width, clocks
/// (at least 1 MHz), number of modules and pins, addresses. The error contains the wrong and the expected
/// value, in the words of LinuxCNC's driver. A module with an unknown gtag or version is not an error. [not
/// realtime]
Result<Idrom> decode_idrom(const RegisterReader &read, const CardShape &card = {});

/// A register and its value.
struct RegisterValue {
    std::uint16_t address = 0;
    std::uint32_t value = 0;

    bool operator==(const RegisterValue &) const = default;
};

/// The registers from which decode_idrom() reads `idrom`, with the IDROM at `offset`. An error when the parts
/// of the description overlap or do not fit; the values are not checked. [not realtime]
Result<std::vector<RegisterValue>> encode_idrom(const Idrom &idrom, std::uint16_t offset = 0x0400);

}  // namespace mw::mesa
