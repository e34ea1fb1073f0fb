// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/ioport.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

enum PortRegister { DATA, DIRECTION, SOURCE, OPEN_DRAIN, INVERT };
constexpr std::size_t MOST_WORDS = MAX_PINS;  // of one pin each

constexpr PinRow<GpioPins> INPUT_PINS[] = {
    {"in", Access::OUT, &GpioPins::in},
    {"in_not", Access::OUT, &GpioPins::in_not},
};
constexpr PinRow<GpioPins> GENERAL_PINS[] = {
    {"out", Access::IN, &GpioPins::out},
    {"is_output", Access::RW, &GpioPins::is_output},
};
/// For general pins, and for outputs of modules.
constexpr PinRow<GpioPins> DRIVE_PINS[] = {
    {"invert_output", Access::RW, &GpioPins::invert_output},
    {"is_opendrain", Access::RW, &GpioPins::is_opendrain},
};

struct OutputName {
    Gtag module;
    std::uint8_t function;
    const char *module_name, *name;
};
constexpr OutputName OUTPUT_NAMES[] = {
    {Gtag::STEPGEN, 0x81, "stepgen", "step"},
    {Gtag::STEPGEN, 0x82, "stepgen", "direction"},
    {Gtag::STEPGEN, 0x83, "stepgen", "table2"},
    {Gtag::STEPGEN, 0x84, "stepgen", "table3"},
    {Gtag::STEPGEN, 0x85, "stepgen", "table4"},
    {Gtag::STEPGEN, 0x86, "stepgen", "table5"},
    {Gtag::STEPGEN, 0x87, "stepgen", "table6"},
    {Gtag::STEPGEN, 0x88, "stepgen", "table7"},
    {Gtag::PWM, 0x81, "pwmgen", "out0"},
    {Gtag::PWM, 0x82, "pwmgen", "out1"},
    {Gtag::PWM, 0x83, "pwmgen", "enable"},
    {Gtag::THREE_PHASE_PWM, 0x81, "3pwmgen", "phase-A"},
    {Gtag::THREE_PHASE_PWM, 0x82, "3pwmgen", "phase-B"},
    {Gtag::THREE_PHASE_PWM, 0x83, "3pwmgen", "phase-C"},
    {Gtag::THREE_PHASE_PWM, 0x84, "3pwmgen", "phase-A-inverted"},
    {Gtag::THREE_PHASE_PWM, 0x85, "3pwmgen", "phase-B-inverted"},
    {Gtag::THREE_PHASE_PWM, 0x86, "3pwmgen", "phase-C-inverted"},
    {Gtag::THREE_PHASE_PWM, 0x87, "3pwmgen", "enable"},
    {Gtag::UART_TX, 0x81, "uart", "tx"},
    {Gtag::UART_TX, 0x82, "uart", "tx-drive-enable"},
    {Gtag::PKT_UART_TX, 0x81, "uart", "tx"},
    {Gtag::PKT_UART_TX, 0x82, "uart", "tx-drive-enable"},
    {Gtag::ONE_SHOT, 0x81, "oneshot", "trigger1"},
    {Gtag::ONE_SHOT, 0x82, "oneshot", "trigger2"},
    {Gtag::XY2_100, 0x81, "xy2mod", "datax"},
    {Gtag::XY2_100, 0x82, "xy2mod", "datay"},
    {Gtag::XY2_100, 0x83, "xy2mod", "clk"},
    {Gtag::XY2_100, 0x84, "xy2mod", "sync"},
    {Gtag::SSI, 0x81, "ssi", "clock"},
    {Gtag::SSI, 0x82, "ssi", "clock-enable"},
    {Gtag::BISS, 0x81, "biss", "clock"},
    {Gtag::BISS, 0x82, "biss", "clock-enable"},
    {Gtag::BSPI, 0x81, "bspi", "nframe"},
    {Gtag::BSPI, 0x82, "bspi", "out"},
    {Gtag::BSPI, 0x83, "bspi", "clk"},
    {Gtag::RESOLVER, 0x81, "resolver", "nc"},
    {Gtag::RESOLVER, 0x82, "resolver", "refpdm-plus"},
    {Gtag::RESOLVER, 0x83, "resolver", "refpdm-minus"},
    {Gtag::RESOLVER, 0x84, "resolver", "amux0"},
    {Gtag::RESOLVER, 0x85, "resolver", "amux1"},
    {Gtag::RESOLVER, 0x86, "resolver", "amux2"},
    {Gtag::RESOLVER, 0x87, "resolver", "spics"},
    {Gtag::RESOLVER, 0x88, "resolver", "spiclk"},
};

}  // namespace

PortWords port_words(std::span<const UsedPin> used, std::span<const GpioPins> pins) noexcept {
    PortWords words;
    for (std::size_t i = 0; i < used.size() && i < pins.size(); ++i) {
        const std::uint32_t bit = 1U << i;
        const GpioPins &pin = pins[i];
        const bool is_output_flag = used[i].isGeneral() ? pin.is_output : used[i].isOutputOfModule();
        words.source |= used[i].isGeneral() ? 0U : bit;
        words.direction |= is_output_flag && !pin.is_opendrain ? bit : 0U;
        words.open_drain |= is_output_flag && pin.is_opendrain ? bit : 0U;
        words.invert |= is_output_flag && pin.invert_output ? bit : 0U;
        words.data |= used[i].isGeneral() && pin.out ? bit : 0U;
    }
    return words;
}

/// Function of a smart serial pin: 0x81 to 0x88 transmit, 0x91 to 0x98 transmit enable, 0xA1 to 0xA8 the same
/// with inverted level.
std::string serial_output_name(const UsedPin &pin) {
    constexpr unsigned GROUP = 0xF0, TRANSMIT = 0x80, ENABLE = 0x90, NUMBER = 0x0F;
    const unsigned group = pin.function & GROUP;
    const char *name = group == TRANSMIT ? "tx" : group == ENABLE ? "txen" : "txenb";
    return fmt::format("sserial.{:02}.{}{}", pin.instance, name, (pin.function & NUMBER) - 1U);
}

std::string output_name(const UsedPin &pin) {
    const bool serial = pin.module == Gtag::SMART_SERIAL || pin.module == Gtag::SMART_SERIAL_B;
    if (serial && pin.isOutputOfModule()) {
        return serial_output_name(pin);
    }
    for (const OutputName &one : OUTPUT_NAMES) {
        if (one.module == pin.module && one.function == pin.function) {
            return fmt::format("{}.{:02}.{}", one.module_name, pin.instance, one.name);
        }
    }
    return {};
}

IoPorts::IoPorts(const UsedModule &module, const Assignment &assignment, int port_width)
    : module_(module), used_(assignment.pins) {
    cycle_.pins.resize(used_.size());
    const int count = static_cast<int>(used_.size());
    for (int first = 0; first < count; first += port_width) {
        Port port;
        port.first = first;
        port.count = std::min(port_width, count - first);
        ports_.push_back(port);
    }
}

void IoPorts::plan(Registers &registers) {
    data_ =
        registers.read({module_.address(DATA), static_cast<std::uint16_t>(ports_.size())}, ReadOrder::PORT);
    int number = 0;
    for (Port &port : ports_) {
        const auto add = [&](int reg, WriteOrder order, Send send) {
            return registers.write(module_.address(reg, number), order, send);
        };
        port.data = add(DATA, WriteOrder::PORT_DATA, Send::ALWAYS);
        port.invert = add(INVERT, WriteOrder::PORT_INVERT, Send::CHANGED);
        port.open_drain = add(OPEN_DRAIN, WriteOrder::PORT_OPEN_DRAIN, Send::CHANGED);
        port.source = add(SOURCE, WriteOrder::PORT_SOURCE, Send::CHANGED);
        port.direction = add(DIRECTION, WriteOrder::PORT_DIRECTION, Send::CHANGED);
        ++number;
    }
}

void IoPorts::declare(PinSpace &space) {
    for (std::size_t i = 0; i < used_.size(); ++i) {
        const std::string name = fmt::format("gpio.{:03}", used_[i].number);
        cycle_.inputs.bind(space, name, INPUT_PINS, cycle_.pins[i]);
        if (used_[i].isGeneral()) {
            cycle_.outputs.bind(space, name, GENERAL_PINS, cycle_.pins[i]);
        }
        if (used_[i].isGeneral() || used_[i].isOutputOfModule()) {
            cycle_.outputs.bind(space, name, DRIVE_PINS, cycle_.pins[i]);
        }
        const std::string other = output_name(used_[i]);
        if (other.empty()) {
            continue;
        }
        // If a function has several pins, its names contain the number of the pin among them.
        const auto same = [&](const UsedPin &pin) { return output_name(pin) == other; };
        const auto all = std::ranges::count_if(used_, same);
        const auto before =
            std::count_if(used_.begin(), used_.begin() + static_cast<std::ptrdiff_t>(i), same);
        const std::size_t dot = other.rfind('.');
        const std::string alias =
            all == 1 ? other : fmt::format("{}.{}{}", other.substr(0, dot), before, other.substr(dot));
        for (const PinRow<GpioPins> &row : DRIVE_PINS) {
            space.alias_param(name + "." + row.name, alias + "." + row.name);
        }
    }
    fast_.pins = cycle_.pins;
    fast_.inputs = cycle_.inputs.moved(cycle_.pins.data(), fast_.pins.data());
    fast_.outputs = cycle_.outputs.moved(cycle_.pins.data(), fast_.pins.data());
    sent_.assign(ports_.size(), {});
}

PortWords IoPorts::words_of(const View &view, const Port &port) const noexcept {
    const auto first = static_cast<std::size_t>(port.first), count = static_cast<std::size_t>(port.count);
    return port_words(std::span(used_).subspan(first, count), std::span(view.pins).subspan(first, count));
}

void IoPorts::show(View &view, const Port &port, std::uint32_t word) const noexcept {
    for (int i = 0; i < port.count; ++i) {
        GpioPins &pin = view.pins[static_cast<std::size_t>(port.first + i)];
        pin.in = ((word >> static_cast<unsigned>(i)) & 1U) != 0;
        pin.in_not = !pin.in;
    }
}

void IoPorts::read(const Registers &registers, const Cycle &) noexcept {
    int number = 0;
    for (const Port &port : ports_) {
        show(cycle_, port, registers.value(data_, number++));
    }
    cycle_.inputs.store();
}

void IoPorts::write(Registers &registers, const Cycle &) noexcept {
    cycle_.outputs.load();
    for (const Port &port : ports_) {
        const PortWords words = words_of(cycle_, port);
        registers.set(port.data, words.data);
        registers.set(port.invert, words.invert);
        registers.set(port.open_drain, words.open_drain);
        registers.set(port.source, words.source);
        registers.set(port.direction, words.direction);
    }
}

void IoPorts::read_immediately(RegisterBus &bus) noexcept {
    std::array<std::uint32_t, MOST_WORDS> words{};
    const auto values = std::span(words).first(std::min(ports_.size(), MOST_WORDS));
    if (!bus.read_immediately(module_.address(DATA), values)) {
        return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        show(fast_, ports_[i], values[i]);
    }
    fast_.inputs.store();
}

void IoPorts::write_immediately(RegisterBus &bus) noexcept {
    fast_.outputs.load();
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        const int number = static_cast<int>(i);
        const PortWords words = words_of(fast_, ports_[i]);
        const RegisterWrite all[] = {{module_.address(DATA, number), words.data},
                                     {module_.address(INVERT, number), words.invert},
                                     {module_.address(OPEN_DRAIN, number), words.open_drain},
                                     {module_.address(SOURCE, number), words.source},
                                     {module_.address(DIRECTION, number), words.direction}};
        PortWords only_data = sent_[i];
        only_data.data = words.data;
        const bool data_only = only_data == words;
        if (bus.write_immediately(std::span(all).first(data_only ? 1 : std::size(all)))) {
            sent_[i] = words;
        }
    }
}

}  // namespace mw::mesa
