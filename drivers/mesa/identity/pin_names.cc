// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/identity/pin_names.hh"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

constexpr std::uint8_t ALL_INSTANCES = 0x80;

struct ModuleText {
    Gtag gtag;
    std::string_view text;
};
constexpr ModuleText MODULES[] = {
    {Gtag::WATCHDOG, "watchdog"},
    {Gtag::ENCODER, "encoder"},
    {Gtag::MUXED_ENCODER, "encoder"},
    {Gtag::MUX_SELECT, "encoder multiplexer"},
    {Gtag::STEPGEN, "step generator"},
    {Gtag::PWM, "PWM generator"},
    {Gtag::THREE_PHASE_PWM, "three-phase PWM generator"},
    {Gtag::RC_PWM, "RC PWM generator"},
    {Gtag::DPLL, "DPLL"},
    {Gtag::LED, "lamp"},
    {Gtag::SMART_SERIAL, "smart serial"},
    {Gtag::SMART_SERIAL_B, "smart serial"},
    {Gtag::SSR, "solid-state relay"},
    {Gtag::IN_MUX, "multiplexed inputs"},
    {Gtag::IN_M, "inputs"},
    {Gtag::OUT_M, "outputs"},
    {Gtag::RESOLVER, "resolver"},
    {Gtag::UART_TX, "UART"},
    {Gtag::UART_RX, "UART"},
    {Gtag::PKT_UART_TX, "packet UART"},
    {Gtag::PKT_UART_RX, "packet UART"},
    {Gtag::BSPI, "buffered SPI"},
    {Gtag::SSI, "SSI encoder"},
    {Gtag::BISS, "BiSS encoder"},
    {Gtag::FANUC_ABSOLUTE, "Fanuc encoder"},
    {Gtag::XY2_100, "XY2-100"},
    {Gtag::ONE_SHOT, "one-shot"},
    {Gtag::PERIOD_METER, "period meter"},
};

/// Consecutive functions with one text; {} is the number, beginning with `first_number`.
struct FunctionText {
    Gtag gtag;
    std::uint8_t first, last;
    const char *text;
    int first_number = 0;
};
constexpr FunctionText FUNCTIONS[] = {
    {Gtag::ENCODER, 1, 1, "A"},
    {Gtag::ENCODER, 2, 2, "B"},
    {Gtag::ENCODER, 3, 3, "index"},
    {Gtag::ENCODER, 4, 4, "index mask"},
    {Gtag::ENCODER, 5, 5, "probe"},
    {Gtag::MUXED_ENCODER, 1, 1, "A"},
    {Gtag::MUXED_ENCODER, 2, 2, "B"},
    {Gtag::MUXED_ENCODER, 3, 3, "index"},
    {Gtag::MUXED_ENCODER, 4, 4, "index mask"},
    {Gtag::MUXED_ENCODER, 5, 5, "probe"},
    {Gtag::MUX_SELECT, 0x81, 0x82, "select {}"},
    {Gtag::STEPGEN, 0x81, 0x81, "step"},
    {Gtag::STEPGEN, 0x82, 0x82, "direction"},
    {Gtag::STEPGEN, 0x83, 0x88, "table {}", 3},
    {Gtag::STEPGEN, 1, 1, "index"},
    {Gtag::STEPGEN, 9, 9, "index"},
    {Gtag::STEPGEN, 2, 2, "probe"},
    {Gtag::STEPGEN, 10, 10, "probe"},
    {Gtag::PWM, 0x81, 0x81, "output 0"},
    {Gtag::PWM, 0x82, 0x82, "output 1"},
    {Gtag::PWM, 0x83, 0x83, "enable"},
    {Gtag::SMART_SERIAL, 0x01, 0x08, "receive {}"},
    {Gtag::SMART_SERIAL, 0x81, 0x88, "transmit {}"},
    {Gtag::SMART_SERIAL, 0x91, 0x98, "transmit enable {}"},
    {Gtag::SMART_SERIAL, 0xA1, 0xA8, "inverted transmit enable {}"},
    {Gtag::DPLL, 1, 1, "synchronisation"},
    {Gtag::DPLL, 0x82, 0x82, "reference"},
    {Gtag::DPLL, 0x83, 0x86, "timer {}", 1},
    {Gtag::SSR, 0xA0, 0xA0, "AC reference"},
    {Gtag::SSR, 0x81, 0x9F, "output {}"},
    {Gtag::IN_MUX, 0x81, 0x85, "address {}"},
    {Gtag::IN_MUX, 1, 1, "data"},
    {Gtag::IN_M, 1, 0x20, "input {}"},
    {Gtag::OUT_M, 0x81, 0xA0, "output {}"},
};

std::string function_text(Gtag gtag, std::uint8_t function) {
    const Gtag type = gtag == Gtag::SMART_SERIAL_B ? Gtag::SMART_SERIAL : gtag;
    const auto *found = std::ranges::find_if(FUNCTIONS, [&](const FunctionText &one) {
        return one.gtag == type && function >= one.first && function <= one.last;
    });
    return found == std::end(FUNCTIONS)
               ? fmt::format("function 0x{:02X}", function)
               : fmt::format(fmt::runtime(found->text), function - found->first + found->first_number);
}

}  // namespace

int connector_pin(int port_width, int i) noexcept {
    constexpr int DB25_WIDTH = 17, HEADER_WIDTH = 24;
    constexpr std::array DB25{1, 14, 2, 15, 3, 16, 4, 17, 5, 6, 7, 8, 9, 10, 11, 12, 13};
    if (i < 0 || i >= port_width) {
        return 0;
    }
    if (port_width == DB25_WIDTH) {
        return DB25[static_cast<std::size_t>(i)];
    }
    return port_width == HEADER_WIDTH ? 2 * i + 1 : 0;
}

std::string pin_function(const PinDescriptor &pin) {
    if (pin.secondary == Gtag::NONE) {
        return {};
    }
    const auto *module = std::ranges::find(MODULES, pin.secondary, &ModuleText::gtag);
    const std::string name = module == std::end(MODULES)
                                 ? fmt::format("module {}", static_cast<int>(pin.secondary))
                                 : std::string(module->text);
    const std::string unit = pin.unit == ALL_INSTANCES ? "" : fmt::format(" {}", pin.unit);
    return fmt::format("{}{}: {}", name, unit, function_text(pin.secondary, pin.secondary_pin));
}

}  // namespace mw::mesa
