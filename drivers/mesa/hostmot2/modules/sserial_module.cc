// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/sserial_discovery.hh"
#include "drivers/mesa/hostmot2/modules/sserial_parameters.hh"
#include "drivers/mesa/hostmot2/modules/sserial_port.hh"
#include "drivers/mesa/hostmot2/modules/sserial_values.hh"

namespace mw::mesa {

namespace {

enum SerialRegister { COMMAND, DATA, STATUS, USER };
constexpr int WORD_BITS = 32, MAX_WORDS = 7;
constexpr unsigned MODE_SHIFT = 24;

/// Faults in the status of a channel.
enum StatusBit : std::uint32_t { REMOTE_FAULT = 1U << 8U, NO_CONTACT = 1U << 13U, WATCHDOG = 1U << 24U };
struct StatusName {
    std::uint32_t mask;
    const char *text;
};
constexpr StatusName STATUS_NAMES[] = {
    {NO_CONTACT | 1U << 0U, "CRC error"},
    {NO_CONTACT | 1U << 1U, "wrong cookie"},
    {NO_CONTACT | 1U << 2U, "overrun"},
    {NO_CONTACT | 1U << 3U, "no answer"},
    {NO_CONTACT | 1U << 4U, "extra character"},
    {NO_CONTACT | 1U << 5U, "break"},
    {REMOTE_FAULT | WATCHDOG, "watchdog"},
    {REMOTE_FAULT | 1U << 25U, "not enabled"},
    {REMOTE_FAULT | 1U << 26U, "over-temperature"},
    {REMOTE_FAULT | 1U << 27U, "over-current"},
    {REMOTE_FAULT | 1U << 28U, "over-voltage"},
    {REMOTE_FAULT | 1U << 29U, "under-voltage"},
    {REMOTE_FAULT | 1U << 30U, "illegal mode"},
    {REMOTE_FAULT | 1U << 31U, "communication fault"},
};

/// A communication error, or a card whose watchdog has turned its outputs off.
bool isFaulty(std::uint32_t status) noexcept {
    constexpr std::uint32_t BITTEN = REMOTE_FAULT | WATCHDOG;
    return (status & NO_CONTACT) != 0 || (status & BITTEN) == BITTEN;
}

const char *status_text(std::uint32_t status) noexcept {
    for (const StatusName &one : STATUS_NAMES) {
        if ((status & one.mask) == one.mask) {
            return one.text;
        }
    }
    return "no reason";
}

int words_of(int bits) noexcept {
    return (bits + WORD_BITS - 1) / WORD_BITS;
}

struct SerialCard {
    int channel = 0;
    std::uint8_t mode = 0;
    std::string name;  ///< prefix of its pins: 7i76.0.0
    int input_words = 0, output_words = 0;
    SserialCardValues values;
    std::vector<SserialParameter> parameters;
    std::uint32_t status = 0;      ///< of the last fault
    std::uint32_t status_now = 0;  ///< of the last read
    WriteHandle mode_write;
    std::array<WriteHandle, MAX_WORDS> user_writes;
};

struct SerialPort {
    explicit SerialPort(const FoundPort &found, std::uint32_t channels)
        : number(found.port), control(channels) {}

    int number = 0;
    std::string card_names;  ///< for messages
    SserialPortPins pins;
    SserialPortControl control;
    SserialWriteStep step;  ///< step of the parameter that is being written
    bool doubtful = false;  ///< the last command may have been lost
    std::vector<SerialCard> cards;
    ReadHandle command_read, data_read, status_read;
    std::array<ReadHandle, MAX_WORDS> user_reads;
    WriteHandle command_write;
};

class SmartSerial final : public Module {
  public:
    explicit SmartSerial(const ModuleRequest &request) : module_(request.module) {
        ports_.reserve(request.assignment.serial_ports.size());
        for (const FoundPort &found : request.assignment.serial_ports) {
            add_port(found, request.config.is_named_by_serial_number);
        }
    }

    bool isCounting() const noexcept override {
        return std::ranges::any_of(ports_, [](const SerialPort &port) {
            return std::ranges::any_of(port.cards,
                                       [](const SerialCard &card) { return !card.values.counters.empty(); });
        });
    }
    void plan(Registers &registers) override {
        for (SerialPort &port : ports_) {
            plan_reads(registers, port);
            for (SerialCard &card : port.cards) {
                const auto write = [&](int reg) {
                    return registers.write(address(port, reg, card.channel), WriteOrder::SMART_SERIAL,
                                           Send::REQUESTED);
                };
                card.mode_write = write(STATUS);
                for (int i = 0; i < std::max(card.output_words, SserialWriteStep::WORDS); ++i) {
                    card.user_writes[static_cast<std::size_t>(i)] = write(USER + i);
                }
            }
            // Written after the registers that the command uses.
            port.command_write =
                registers.write(address(port, COMMAND, 0), WriteOrder::SMART_SERIAL, Send::REQUESTED);
        }
    }
    void declare(PinSpace &space) override {
        for (SerialPort &port : ports_) {
            port_pins_.bind(space, fmt::format("sserial.port-{}", port.number), SSERIAL_PORT_PINS, port.pins);
            for (SerialCard &card : port.cards) {
                for (const SserialField &field : card.values.fields) {
                    declare_field(space, card, field);
                }
                for (SserialParameter &parameter : card.parameters) {
                    card_pins_.add(space, card.name + "." + parameter.name, parameter.type, parameter.access,
                                   parameter.field());
                }
            }
        }
    }
    void read(const Registers &registers, const Cycle &cycle) noexcept override {
        port_pins_.load();
        card_pins_.load();
        for (SerialPort &port : ports_) {
            read_port(registers, port, cycle);
        }
        card_pins_.store();
        port_pins_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        port_pins_.load();
        card_pins_.load();
        for (SerialPort &port : ports_) {
            write_port(registers, port, cycle);
        }
        port_pins_.store();
    }
    std::size_t take_message(std::span<char> text) noexcept override {
        for (SerialPort &port : ports_) {
            const SserialEvents event = port.control.take_event();
            if (event.type != SserialEvents::Type::NONE) {
                return message(port, event, text);
            }
        }
        return 0;
    }

  private:
    void add_port(const FoundPort &found, bool by_serial_number) {
        std::uint32_t channels = 0;
        for (const FoundCard &card : found.cards) {
            channels |= 1U << static_cast<unsigned>(card.channel);
        }
        SerialPort &port = ports_.emplace_back(found, channels);
        for (const FoundCard &card : found.cards) {
            SerialCard &added = port.cards.emplace_back();
            added.channel = card.channel;
            added.mode = card.mode;
            added.name = fmt::format("{}.{}.{}", card.name, found.port, card.channel);
            port.card_names += (port.card_names.empty() ? "" : ", ") + added.name;
            if (by_serial_number) {
                constexpr std::uint32_t LAST_DIGITS = 0xFFFF;
                added.name =
                    fmt::format("{}hm2_{}.{:04x}", WHOLE_NAME, card.name, card.serial_number & LAST_DIGITS);
            }
            added.input_words = words_of(card.layout.input_bits);
            added.output_words = words_of(card.layout.output_bits);
            added.values = make_sserial_card(card.process, card.layout);
            for (const FoundParameter &parameter : card.parameters) {
                if (auto one = make_parameter(parameter)) {
                    added.parameters.push_back(std::move(*one));
                }
            }
        }
    }
    std::uint16_t address(const SerialPort &port, int reg, int channel) const noexcept {
        return static_cast<std::uint16_t>(module_.address(reg, port.number) + 4 * channel);
    }
    void plan_reads(Registers &registers, SerialPort &port) const {
        const auto read = [&](int reg, int count) {
            return registers.read({address(port, reg, 0), static_cast<std::uint16_t>(count)},
                                  ReadOrder::SMART_SERIAL);
        };
        port.command_read = read(COMMAND, 1);
        port.data_read = read(DATA, 1);
        port.status_read = read(STATUS, port.cards.back().channel + 1);
        for (int word = 0; word < MAX_WORDS; ++word) {
            int count = 0;
            for (const SerialCard &card : port.cards) {
                count = card.input_words > word ? card.channel + 1 : count;
            }
            if (count > 0) {
                port.user_reads[static_cast<std::size_t>(word)] = read(USER + word, count);
            }
        }
    }
    void declare_field(PinSpace &space, SerialCard &card, const SserialField &field) {
        const std::string name = card.name + "." + field.name;
        const Access access = !field.hasOutput() ? Access::OUT : !field.hasInput() ? Access::IN : Access::IO;
        switch (field.pins) {
        case FieldPins::BITS:
            for (int i = 0; i < field.bits; ++i) {
                declare_bit(space, fmt::format("{}-{:02}", name, i), access,
                            card.values.bits[field.index + static_cast<std::size_t>(i)]);
            }
            return;
        case FieldPins::BOOLEAN: declare_bit(space, name, access, card.values.bits[field.index]); return;
        case FieldPins::UNSIGNED:
        case FieldPins::SIGNED:
        case FieldPins::REAL: {
            SserialNumber &number = card.values.numbers[field.index];
            card_pins_.add(space, name, PinType::FLOAT, access, &number.value);
            if (field.pins == FieldPins::REAL) {
                return;
            }
            card_pins_.add(space, name + "-scalemax", PinType::FLOAT, Access::RW, &number.scale_max);
            if (field.hasOutput()) {
                card_pins_.add(space, name + "-maxlim", PinType::FLOAT, Access::RW, &number.max_limit);
                card_pins_.add(space, name + "-minlim", PinType::FLOAT, Access::RW, &number.min_limit);
            }
            return;
        }
        case FieldPins::STREAM:
            card_pins_.add(space, name, PinType::U32, access, &card.values.streams[field.index].value);
            return;
        case FieldPins::COUNTER:
            card_pins_.bind(space, name, SSERIAL_COUNTER_PINS, card.values.counters[field.index]);
            return;
        case FieldPins::NONE: return;
        }
    }
    void declare_bit(PinSpace &space, const std::string &name, Access access, SserialBit &bit) {
        card_pins_.add(space, name, PinType::BIT, access, &bit.value);
        if (access == Access::OUT) {
            card_pins_.add(space, name + "-not", PinType::BIT, Access::OUT, &bit.inverse);
        } else if (access == Access::IN) {
            card_pins_.add(space, name + "-invert", PinType::BIT, Access::RW, &bit.invert);
        }
    }
    static void read_port(const Registers &registers, SerialPort &port, const Cycle &cycle) noexcept {
        port.doubtful = port.doubtful || cycle.has_lost_write;
        SserialReading reading;
        reading.command = registers.value(port.command_read);
        reading.failed = registers.value(port.data_read);
        reading.now_ns = cycle.now_ns;
        reading.period_s = cycle.period_s;
        for (SerialCard &card : port.cards) {
            const std::uint32_t status = registers.value(port.status_read, card.channel);
            const auto channel = static_cast<unsigned>(card.channel);
            card.status_now = status;
            if (isFaulty(status)) {
                reading.faulty |= 1U << channel;
            }
            const bool failed = ((reading.failed >> channel) & 1U) != 0;
            card.status = failed || isFaulty(status) ? status : card.status;
        }
        const std::uint32_t fresh = port.control.read(port.pins, reading);
        for (SerialCard &card : port.cards) {
            if (((fresh >> static_cast<unsigned>(card.channel)) & 1U) == 0) {
                continue;
            }
            std::array<std::uint32_t, MAX_WORDS> words{};
            for (std::size_t i = 0; i < static_cast<std::size_t>(card.input_words); ++i) {
                words[i] = registers.value(port.user_reads[i], card.channel);
            }
            sserial_read(card.values, words);
        }
    }
    static void write_port(Registers &registers, SerialPort &port, const Cycle &cycle) noexcept {
        const SserialCommand command =
            port.control.write(port.pins, {cycle.now_ns, cycle.period_s, cycle.writing, hasParameters(port)});
        if (command.is_setup_step) {
            write_parameters(registers, port);
            return;
        }
        const SserialOutputs outputs = port.control.take_outputs();
        for (SerialCard &card : port.cards) {
            if (outputs == SserialOutputs::HELD) {
                hold_outputs(card.values);
            } else if (outputs == SserialOutputs::RELEASED) {
                release_outputs(card.values);
            }
            std::array<std::uint32_t, MAX_WORDS> words{};
            sserial_write(card.values, words);
            for (std::size_t i = 0; command.has_data && i < static_cast<std::size_t>(card.output_words);
                 ++i) {
                registers.request(card.user_writes[i], words[i]);
            }
            if (command.has_modes) {
                registers.request(card.mode_write, std::uint32_t{card.mode} << MODE_SHIFT);
            }
        }
        if (command.isDue) {
            registers.request(port.command_write, command.command);
            port.step = {};
            port.doubtful = false;
        }
    }

    static bool hasParameters(const SerialPort &port) noexcept {
        return std::ranges::any_of(port.cards, [](const SerialCard &card) {
            return std::ranges::any_of(card.parameters, &SserialParameter::isChanged);
        });
    }
    /// Executes one step of a parameter in each cycle. A step that may have been lost is repeated.
    static void write_parameters(Registers &registers, SerialPort &port) noexcept {
        const bool first = port.step.number == 0;
        if (first && port.doubtful) {
            port.control.repeat_setup(port.pins);
            return;
        }
        for (SerialCard &card : port.cards) {
            const auto one = std::ranges::find_if(card.parameters, &SserialParameter::isChanged);
            if (one != card.parameters.end()) {
                write_parameter(registers, port, card, *one);
                return;
            }
        }
        port.control.finish_setup(port.pins, 0);
    }
    static void write_parameter(Registers &registers, SerialPort &port, SerialCard &card,
                                SserialParameter &parameter) noexcept {
        constexpr std::uint32_t FAULTS = 0xFF00;
        const bool first = port.step.number == 0;
        if (!first && !port.doubtful && (card.status_now & FAULTS) != 0) {
            card.status = card.status_now;
            parameter.known = port.step.value;  // it is not written again until it changes
            port.step = {};
            port.control.finish_setup(port.pins, 1U << static_cast<unsigned>(card.channel));
            return;
        }
        const SserialWriteStep last = port.step;
        port.step = port.doubtful ? last : next_step(parameter, last);
        if (port.step.number == 0) {
            parameter.known = last.value;  // the next cycle writes the next parameter
            return;
        }
        registers.request(card.mode_write, port.step.status);
        for (std::size_t i = 0; i < port.step.words.size(); ++i) {
            registers.request(card.user_writes[i], port.step.words[i]);
        }
        registers.request(port.command_write, port.control.setup_step(card.channel).command);
        port.doubtful = false;
    }

    static std::size_t message(const SerialPort &port, const SserialEvents &event,
                               std::span<char> text) noexcept;

    UsedModule module_;
    std::vector<SerialPort> ports_;
    PinBinding port_pins_, card_pins_;
};

std::size_t SmartSerial::message(const SerialPort &port, const SserialEvents &event,
                                 std::span<char> text) noexcept {
    constexpr std::int64_t NS_PER_US = 1000, NS_PER_MS = 1'000'000, STEP_US = 100;
    const SerialCard *failed = &port.cards.front();
    for (const SerialCard &card : port.cards) {
        if (((event.channels >> static_cast<unsigned>(card.channel)) & 1U) != 0) {
            failed = &card;
            break;
        }
    }
    const char *card = failed->name.c_str(), *cause = status_text(failed->status);
    const auto shortest_us = static_cast<long long>(event.shortest_ns / NS_PER_US);
    const auto longest_us = static_cast<long long>(event.longest_ns / NS_PER_US);
    int length = 0;
    switch (event.type) {
    case SserialEvents::Type::LATE:
        length = std::snprintf(
            text.data(), text.size(),
            "Smart serial port %d: an exchange with %s took %lld to %lld us, longer than the servo period of "
            "%lld us allows. Use a servo period of at least %lld us, or connect fewer cards to this port.",
            port.number, port.card_names.c_str(), shortest_us, longest_us,
            static_cast<long long>(event.period_ns / NS_PER_US), (longest_us / STEP_US + 1) * STEP_US);
        break;
    case SserialEvents::Type::FAULT:
        length =
            event.channels == 0
                ? std::snprintf(
                      text.data(), text.size(),
                      "Smart serial port %d stopped: exchanges with %s were not finished after %lld us. Use "
                      "a "
                      "longer servo period, or connect fewer cards to this port. It starts again by itself.",
                      port.number, port.card_names.c_str(), shortest_us)
                : std::snprintf(
                      text.data(), text.size(),
                      "Smart serial card %s failed: %s (status 0x%08X). Port %d is stopped and starts "
                      "again by itself. Check the cable and the field supply of the card.",
                      card, cause, failed->status, port.number);
        break;
    case SserialEvents::Type::NO_START:
        length =
            std::snprintf(text.data(), text.size(),
                          "Smart serial card %s does not start: %s (status 0x%08X). Port %d tries again. "
                          "Check the cable and the field supply of the card.",
                          card, cause, failed->status, port.number);
        break;
    case SserialEvents::Type::NO_SETUP:
        length =
            std::snprintf(text.data(), text.size(),
                          "Smart serial card %s has not taken a parameter: %s (status 0x%08X). Check the "
                          "value and the cable.",
                          card, cause, failed->status);
        break;
    case SserialEvents::Type::RECOVERED:
        length =
            std::snprintf(text.data(), text.size(),
                          "Smart serial port %d runs again after %lld ms. Each output stays off until its "
                          "pin has been off once, or sserial.port-%d.run has been false.",
                          port.number, static_cast<long long>(event.stopped_ns / NS_PER_MS), port.number);
        break;
    case SserialEvents::Type::NONE: break;
    }
    return std::min(static_cast<std::size_t>(std::max(length, 0)), text.size());
}

}  // namespace

std::unique_ptr<Module> make_sserial(const ModuleRequest &request) {
    return std::make_unique<SmartSerial>(request);
}

}  // namespace mw::mesa
