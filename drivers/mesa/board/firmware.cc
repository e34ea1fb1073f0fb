// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/firmware.hh"

#include <algorithm>

namespace mw::mesa::board {

namespace {

constexpr std::size_t WORDS = 0x10000 / 4;
constexpr std::uint8_t OUTPUT = 0x80;
constexpr std::uint8_t STEP_PIN = 0x81, PWM_PIN = 0x81;
constexpr std::uint8_t ENCODER_A = 1, ENCODER_B = 2, ENCODER_Z = 3;
constexpr unsigned DPLL_TIMERS = 4;
/// Limits the work for a long time without requests.
constexpr std::int64_t MAX_SPANS = 100'000;
constexpr std::uint32_t FIRST_SERIAL_NUMBER = 0x1000'0001;

/// An event of the watchdog or of a DPLL timer.
struct TimedEvent {
    std::int64_t time_ns = 0;
    unsigned timer = 0;  ///< 0: the watchdog bites
};

std::uint8_t encoder_bit(std::uint8_t function) {
    switch (function) {
    case ENCODER_A: return EncoderControl::A_LEVEL;
    case ENCODER_B: return EncoderControl::B_LEVEL;
    case ENCODER_Z: return EncoderControl::INDEX_LEVEL;
    default: return 0;
    }
}

}  // namespace

template <class T, class... Arguments>
T *Firmware::own(Arguments &&...arguments) {
    auto module = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    T *plain = module.get();
    modules_.push_back(std::move(module));
    return plain;
}

Firmware::Firmware(const Idrom &idrom, Physics &physics, std::int64_t power_up_ns)
    : idrom_(idrom), physics_(physics), identity_(WORDS, 0), slots_(WORDS), pin_modules_(idrom.pins.size()),
      inputs_(idrom.pins.size()), ports_(idrom.header.io_ports, idrom.header.port_width),
      now_ns_(power_up_ns) {
    if (const auto encoded = encode_idrom(idrom); encoded.has_value()) {
        for (const RegisterValue &one : *encoded) {
            identity_[one.address / 4U] = one.value;
        }
    }
    ports_.connect({.outside = [this](unsigned pin) { return outside_level(pin); },
                    .module = [this](unsigned pin) { return module_level(pin); }});
    for (const ModuleDescriptor &descriptor : idrom_.modules) {
        Module *module = add_module(descriptor);
        module->advance(power_up_ns);
        map(*module, descriptor);
        for (std::size_t pin = 0; pin < idrom_.pins.size(); ++pin) {
            if (idrom_.pins[pin].secondary == descriptor.gtag && pin_modules_[pin] == nullptr) {
                pin_modules_[pin] = module;
            }
        }
    }
    if (encoder_ != nullptr) {
        for (unsigned i = 0; i < encoder_->encoders().size(); ++i) {
            Encoder &encoder = encoder_->encoders()[i];
            encoder.shaft = physics_.shaft(i).value_or(Shaft{});
            encoder.zero = encoder.shaft.count;
            encoder.last_edge_ns = power_up_ns;
        }
    }
    sample();
}

Module *Firmware::add_module(const ModuleDescriptor &descriptor) {
    const std::uint32_t clock_hz =
        descriptor.fast_clock ? idrom_.header.clock_high_hz : idrom_.header.clock_low_hz;
    const unsigned instances = descriptor.instances;
    switch (descriptor.gtag) {
    case Gtag::WATCHDOG: return watchdog_ = own<WatchdogModule>(clock_hz);
    case Gtag::IO_PORT: return &ports_;
    case Gtag::STEPGEN: return stepgen_ = own<StepgenModule>(instances, clock_hz, descriptor.version);
    case Gtag::ENCODER:
    case Gtag::MUXED_ENCODER: return encoder_ = own<EncoderModule>(instances, clock_hz);
    case Gtag::PWM: return pwm_ = own<PwmModule>(instances);
    case Gtag::DPLL: return dpll_ = own<DpllModule>(clock_hz);
    case Gtag::LED: return led_ = own<LedModule>();
    case Gtag::SSR: return ssr_ = own<SsrModule>();
    case Gtag::SMART_SERIAL: return serial_ = add_serial(descriptor);
    case Gtag::IN_M:
    case Gtag::IN_MUX: return add_inputs(descriptor, clock_hz);
    case Gtag::THREE_PHASE_PWM: return three_phase_pwm_ = own<ThreePhasePwmModule>(instances, clock_hz);
    case Gtag::RC_PWM: return rc_pwm_ = own<RcPwmModule>(instances, clock_hz);
    case Gtag::RESOLVER: {
        auto *module = own<ResolverModule>(clock_hz);
        module->connect([this](unsigned channel) { return physics_.resolver_rev(channel); });
        return module;
    }
    case Gtag::BSPI: return bspi_ = own<BspiModule>(instances);
    case Gtag::UART_TX:
    case Gtag::UART_RX:
    case Gtag::PKT_UART_TX:
    case Gtag::PKT_UART_RX: return add_uart(descriptor, clock_hz);
    default: return own<UnknownModule>(descriptor.registers);
    }
}

Module *Firmware::add_inputs(const ModuleDescriptor &descriptor, std::uint32_t clock_hz) {
    const auto count = [&](bool is_output) {
        return std::ranges::count_if(idrom_.pins, [&](const PinDescriptor &pin) {
            return pin.secondary == descriptor.gtag && ((pin.secondary_pin & OUTPUT) != 0) == is_output;
        });
    };
    // InMux reads its inputs one after the other through one pin; its outputs are the address.
    const std::ptrdiff_t inputs = descriptor.gtag == Gtag::IN_MUX
                                      ? std::ptrdiff_t{1} << std::min<std::ptrdiff_t>(count(true), 5)
                                      : count(false);
    auto *module =
        own<InputModule>(static_cast<unsigned>(std::clamp<std::ptrdiff_t>(inputs, 1, 32)), clock_hz);
    module->connect([this, &descriptor] { return input_levels(descriptor); });
    return module;
}

Module *Firmware::add_uart(const ModuleDescriptor &descriptor, std::uint32_t clock_hz) {
    const bool is_packet = descriptor.gtag == Gtag::PKT_UART_TX || descriptor.gtag == Gtag::PKT_UART_RX;
    const bool transmits = descriptor.gtag == Gtag::UART_TX || descriptor.gtag == Gtag::PKT_UART_TX;
    auto &lines = lines_[is_packet ? Gtag::PKT_UART_TX : Gtag::UART_TX];
    if (lines == nullptr) {
        lines = std::make_shared<SerialLines>();
    }
    lines->resize(std::max<std::size_t>(lines->size(), descriptor.instances));
    const UartRole role = transmits ? UartRole::TRANSMIT : UartRole::RECEIVE;
    if (is_packet) {
        return own<PacketUartModule>(role, lines, clock_hz);
    }
    return own<UartModule>(role, lines, clock_hz);
}

SmartSerialModule *Firmware::add_serial(const ModuleDescriptor &descriptor) {
    // Receive pins 1 to 8 of the port are its channels.
    const auto channels = std::ranges::count_if(idrom_.pins, [&](const PinDescriptor &pin) {
        return pin.secondary == descriptor.gtag && pin.unit == 0 && pin.secondary_pin >= 1 &&
               pin.secondary_pin <= SERIAL_CHANNELS;
    });
    std::vector<ConnectedRemote> remotes;
    for (const RemotePlan &plan : physics_.plan().remotes) {
        if (const RemoteCard *card = find_remote_card(plan.card); card != nullptr) {
            remotes.push_back({plan.port, plan.channel, Remote(*card, FIRST_SERIAL_NUMBER + plan.channel)});
        }
    }
    auto *module =
        own<SmartSerialModule>(descriptor.instances, static_cast<unsigned>(channels), std::move(remotes));
    module->connect([this](unsigned port, unsigned channel, Remote &remote) {
        set_field_inputs({port, channel}, remote);
    });
    return module;
}

void Firmware::set_field_inputs(const RemoteChannel &channel, Remote &remote) const {
    for (const SwitchPlan &one : physics_.plan().switches) {
        if (one.remote == channel) {
            const std::uint32_t bit = 1U << one.pin, others = remote.value("Input") & ~bit;
            remote.set_value("Input", others | (physics_.level_of(one) ? bit : 0U));
        }
    }
    for (const FieldPlan &field : physics_.plan().fields) {
        if (field.remote == channel) {
            remote.set_value(field.name, physics_.field_value(field));
        }
    }
}

void Firmware::map(Module &module, const ModuleDescriptor &descriptor) {
    const std::uint32_t register_stride = idrom_.header.register_strides[descriptor.register_stride];
    const std::uint32_t instance_stride = idrom_.header.instance_strides[descriptor.instance_stride];
    for (unsigned reg = 0; reg < module.registers(); ++reg) {
        const bool is_each =
            module.isInEachInstance(reg) || (reg < 32 && ((descriptor.per_instance >> reg) & 1U) != 0);
        const unsigned instances = is_each ? descriptor.instances : 1U;
        for (unsigned i = 0; i < instances; ++i) {
            const std::uint64_t address = descriptor.base_address + std::uint64_t{reg} * register_stride +
                                          std::uint64_t{i} * instance_stride;
            for (unsigned word = 0; word < module.words(reg); ++word) {
                const std::uint64_t slot = address / 4 + word;
                if (slot < WORDS && slots_[slot].module == nullptr) {
                    slots_[slot] = {&module, {reg, i, word}};
                }
            }
        }
    }
}

std::uint32_t Firmware::read(std::uint16_t address) {
    const std::size_t word = address / 4U;
    const Slot &slot = slots_[word];
    if (slot.module == nullptr) {
        return identity_[word];
    }
    const std::uint32_t value = slot.module->read(slot.place);
    if (dpll_ != nullptr && dpll_->take_sync()) {
        latch_all(0);
    }
    return value;
}

void Firmware::write(std::uint16_t address, std::uint32_t value) {
    const Slot &slot = slots_[address / 4U];
    if (slot.module != nullptr) {
        slot.module->write(slot.place, value);
    }
}

void Firmware::bite() {
    if (watchdog_ != nullptr) {
        watchdog_->bite();
        ports_.release_all();
    }
}

void Firmware::latch_all(unsigned timer) {
    for (const auto &module : modules_) {
        module->latch(timer);
    }
}

void Firmware::advance(std::int64_t to_ns) {
    std::vector<TimedEvent> events;
    if (watchdog_ != nullptr) {
        if (const auto bites_ns = watchdog_->bites_at_ns(); bites_ns.has_value() && *bites_ns <= to_ns) {
            events.push_back({std::max(*bites_ns, now_ns_), 0});
        }
    }
    for (unsigned timer = 1; dpll_ != nullptr && timer <= DPLL_TIMERS; ++timer) {
        // If a timer fires several times only the last time matters, because earlier latched values are not
        // read.
        if (const auto fires_ns = dpll_->last_fire_ns(timer, to_ns); fires_ns.has_value()) {
            events.push_back({*fires_ns, timer});
        }
    }
    std::ranges::sort(events, {}, &TimedEvent::time_ns);
    for (const TimedEvent &event : events) {
        run(event.time_ns);
        if (event.timer == 0) {
            bite();
        } else {
            latch_all(event.timer);
        }
    }
    run(to_ns);
}

void Firmware::run(std::int64_t to_ns) {
    while (now_ns_ < to_ns) {
        std::int64_t span_ns = 0;
        for (const auto &module : modules_) {
            const std::int64_t wanted_ns = module->input_span_ns();
            span_ns = wanted_ns > 0 && (span_ns == 0 || wanted_ns < span_ns) ? wanted_ns : span_ns;
        }
        move(span_ns > 0 ? std::min(to_ns, now_ns_ + std::max(span_ns, (to_ns - now_ns_) / MAX_SPANS))
                         : to_ns);
        sample();
    }
}

void Firmware::sample() {
    for (const auto &module : modules_) {
        module->sample();
    }
    for (unsigned pin = 0; pin < idrom_.pins.size(); ++pin) {
        const PinDescriptor &descriptor = idrom_.pins[pin];
        if (pin_modules_[pin] != nullptr && (descriptor.secondary_pin & OUTPUT) == 0) {
            pin_modules_[pin]->input(descriptor.unit, descriptor.secondary_pin, ports_.level(pin));
        }
    }
}

void Firmware::move(std::int64_t to_ns) {
    const std::vector<std::int64_t> before = steps_now();
    for (const auto &module : modules_) {
        module->advance(to_ns);
    }
    physics_.advance(now_ns_, to_ns, drive_inputs(before), [this](unsigned unit, const ShaftMove &move) {
        if (encoder_ != nullptr && unit < encoder_->encoders().size()) {
            move_shaft(encoder_->encoders()[unit], move);
        }
    });
    now_ns_ = to_ns;
}

std::vector<std::int64_t> Firmware::steps_now() const {
    std::vector<std::int64_t> steps;
    if (stepgen_ != nullptr) {
        for (const Stepgen &one : stepgen_->stepgens()) {
            steps.push_back(one.steps);
        }
    }
    return steps;
}

DriveInputs Firmware::drive_inputs(const std::vector<std::int64_t> &steps_before) const {
    DriveInputs inputs;
    for (unsigned unit = 0; unit < steps_before.size(); ++unit) {
        const std::int64_t steps = stepgen_->stepgens()[unit].steps - steps_before[unit];
        inputs.steps.push_back(isDriven(Gtag::STEPGEN, unit) ? steps : 0);
    }
    for (unsigned unit = 0; pwm_ != nullptr && unit < pwm_->instances(); ++unit) {
        inputs.duties.push_back(isDriven(Gtag::PWM, unit) ? pwm_->duty(unit) : 0.0);
    }
    return inputs;
}

bool Firmware::isDriven(Gtag gtag, unsigned unit) const {
    // The first two outputs: step and direction, or PWM and direction.
    static_assert(STEP_PIN == PWM_PIN);
    bool has = false;
    for (unsigned pin = 0; pin < idrom_.pins.size(); ++pin) {
        const PinDescriptor &descriptor = idrom_.pins[pin];
        const bool is_output =
            descriptor.secondary_pin == STEP_PIN || descriptor.secondary_pin == STEP_PIN + 1;
        if (descriptor.secondary == gtag && descriptor.unit == unit && is_output) {
            has = true;
            if (!ports_.isDrivenByModule(pin)) {
                return false;
            }
        }
    }
    return has;
}

void Firmware::set_input(unsigned pin, std::optional<bool> level) {
    inputs_[pin] = level;
    sample();
}

void Firmware::set_multiplexed_input(unsigned input, bool level) {
    multiplexed_inputs_ = (multiplexed_inputs_ & ~(1U << input)) | (level ? 1U << input : 0U);
    sample();
}

bool Firmware::outside_level(unsigned pin) const {
    if (inputs_[pin].has_value()) {
        return *inputs_[pin];
    }
    if (const auto level = physics_.switch_level(pin); level.has_value()) {
        return *level;
    }
    const PinDescriptor &descriptor = idrom_.pins[pin];
    const bool is_encoder =
        descriptor.secondary == Gtag::ENCODER || descriptor.secondary == Gtag::MUXED_ENCODER;
    if (is_encoder && encoder_ != nullptr && descriptor.unit < encoder_->encoders().size() &&
        physics_.shaft(descriptor.unit).has_value()) {
        return (board::input_levels(encoder_->encoders()[descriptor.unit]) &
                encoder_bit(descriptor.secondary_pin)) != 0;
    }
    return true;  // The cards have pull-up resistors.
}

bool Firmware::module_level(unsigned pin) const {
    const PinDescriptor &descriptor = idrom_.pins[pin];
    return pin_modules_[pin] != nullptr && (descriptor.secondary_pin & OUTPUT) != 0 &&
           pin_modules_[pin]->output(descriptor.unit, descriptor.secondary_pin);
}

std::uint32_t Firmware::input_levels(const ModuleDescriptor &module) const {
    if (module.gtag == Gtag::IN_MUX) {
        return physics_.multiplexed_levels(multiplexed_inputs_);
    }
    std::uint32_t levels = 0;
    for (unsigned pin = 0; pin < idrom_.pins.size(); ++pin) {
        const PinDescriptor &descriptor = idrom_.pins[pin];
        const unsigned number = descriptor.secondary_pin;
        if (descriptor.secondary == module.gtag && number >= 1 && number <= 32) {
            levels |= static_cast<std::uint32_t>(ports_.level(pin)) << (number - 1);
        }
    }
    return levels;
}

}  // namespace mw::mesa::board
