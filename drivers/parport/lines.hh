// SPDX-License-Identifier: GPL-2.0-or-later
// The lines of a PC parallel port: register and bit of each pin of the 25-pin connector. Source: IEEE 1284,
// compatibility mode; shared/hardware.md, part D.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace mw::parport {

/// Offsets from the address of the port.
enum class Register : std::uint8_t { DATA = 0, STATUS = 1, CONTROL = 2 };

/// How the bits of a port are used.
enum class Mode : std::uint8_t {
    OUT,         ///< data pins are outputs
    IN,          ///< data pins are inputs
    CONTROL_IN,  ///< type x: data pins are outputs, control pins are inputs
    EPP,         ///< as OUT, with the electrical characteristics of EPP mode
};

/// A pin of the connector.
struct Line {
    std::uint8_t pin = 0;  ///< 1 to 17
    Register reg = Register::DATA;
    std::uint8_t mask = 0;
    bool inverted = false;  ///< inverted by the hardware: the bit is 1 while the pin is low
};

constexpr std::uint8_t bit(unsigned number) noexcept {
    return static_cast<std::uint8_t>(1U << number);
}

inline constexpr std::array<Line, 8> DATA_LINES{{{2, Register::DATA, bit(0), false},
                                                 {3, Register::DATA, bit(1), false},
                                                 {4, Register::DATA, bit(2), false},
                                                 {5, Register::DATA, bit(3), false},
                                                 {6, Register::DATA, bit(4), false},
                                                 {7, Register::DATA, bit(5), false},
                                                 {8, Register::DATA, bit(6), false},
                                                 {9, Register::DATA, bit(7), false}}};
inline constexpr std::array<Line, 5> STATUS_LINES{{{10, Register::STATUS, bit(6), false},
                                                   {11, Register::STATUS, bit(7), true},
                                                   {12, Register::STATUS, bit(5), false},
                                                   {13, Register::STATUS, bit(4), false},
                                                   {15, Register::STATUS, bit(3), false}}};
inline constexpr std::array<Line, 4> CONTROL_LINES{{{1, Register::CONTROL, bit(0), true},
                                                    {14, Register::CONTROL, bit(1), true},
                                                    {16, Register::CONTROL, bit(2), false},
                                                    {17, Register::CONTROL, bit(3), true}}};
/// The maximum number of pins of one direction: data and status lines, or data and control lines.
constexpr std::size_t MAX_LINES = 13;

/// Bit of the control register that makes the data pins inputs.
constexpr std::uint8_t DATA_IS_INPUT = bit(5);
/// Control register with all its pins high, so that an external open collector can pull them low.
constexpr std::uint8_t CONTROL_HIGH = bit(2);

/// The lines of one direction, in the order of the connector's groups.
struct Lines {
    std::array<Line, MAX_LINES> line{};
    std::size_t count = 0;

    constexpr void add(std::span<const Line> more) noexcept {
        for (const Line &one : more) {
            line[count] = one;
            ++count;
        }
    }
    std::span<const Line> all() const noexcept { return std::span(line).first(count); }
};

constexpr Lines outputs_of(Mode mode) noexcept {
    Lines lines;
    if (mode != Mode::IN) {
        lines.add(DATA_LINES);
    }
    if (mode != Mode::CONTROL_IN) {
        lines.add(CONTROL_LINES);
    }
    return lines;
}

constexpr Lines inputs_of(Mode mode) noexcept {
    Lines lines;
    if (mode == Mode::IN) {
        lines.add(DATA_LINES);
    }
    lines.add(STATUS_LINES);
    if (mode == Mode::CONTROL_IN) {
        lines.add(CONTROL_LINES);
    }
    return lines;
}

/// The bits of the control register that are not pins, and the bits of pins that are not outputs.
constexpr std::uint8_t control_base(Mode mode) noexcept {
    if (mode == Mode::IN) {
        return DATA_IS_INPUT;
    }
    return mode == Mode::CONTROL_IN ? CONTROL_HIGH : 0;
}

}  // namespace mw::parport
