// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/sserial_port.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr std::uint32_t DO_IT = 0x1000, STOP = 0x800, START_NORMAL = 0x900, START_SETUP = 0xF00,
                        CHANNELS = 0xFF;
/// Bit 31 of the command register has another use.
constexpr std::uint32_t COMMAND_MASK = 0x7FFFFFFF;
/// A card switches its outputs off when it receives nothing for about 10 ms.
constexpr double OUTPUTS_OFF_S = 0.1;
/// Maximum time of a start, and between two attempts.
constexpr double START_LIMIT_S = 0.25, RETRY_S = 0.25;
/// After this time without a write the cards have turned their outputs off, so they are started again.
constexpr double LONGEST_GAP_S = 0.01;
/// A start whose packet was lost causes failures of the first exchanges, after which the cards are started
/// again.
constexpr int FIRST_EXCHANGES = 10, MOST_SILENT_STARTS = 5;
/// The pins of the port become outputs with the first write; the start must come later.
constexpr double SETTLE_S = 0.01;
/// Number of consecutive late exchanges, or of reads during one exchange, that are a fault.
constexpr int LATE_STREAK = 3, LATE_READS = 2;
/// A late exchange is reported again after this time without late exchanges.
constexpr double QUIET_S = 10.0;

}  // namespace

void SserialPortControl::enter(SserialPortPins &pins, SserialState state) noexcept {
    state_ = state;
    in_state_s_ = 0.0;
    stop_sent_ = false;
    pins.port_state = static_cast<std::uint32_t>(state);
}

SserialCommand SserialPortControl::send(std::uint32_t command) noexcept {
    last_command_ = command;
    clear_ = false;
    answered_ = false;
    return {.isDue = true, .command = command};
}

SserialCommand SserialPortControl::start(SserialPortPins &pins) noexcept {
    enter(pins, SserialState::STARTING);
    exchanges_ = 0;
    late_shortest_ns_ = 0;
    late_streak_ = late_reads_ = 0;
    pins.fault_count = 0;
    SserialCommand command = send(START_NORMAL | channels_);
    command.has_modes = true;
    command.has_data = true;
    return command;
}

void SserialPortControl::stop_by_faults(SserialPortPins &pins, SserialEvents::Type type,
                                        std::uint32_t channels) noexcept {
    // One message for each burst; failed attempts belong to the same burst.
    if (!recovering_) {
        event_ = {.type = type, .channels = channels, .shortest_ns = late_shortest_ns_};
        stopped_s_ = 0.0;
    }
    recovering_ = true;
    pins.fault = true;
    outputs_ = SserialOutputs::HELD;
    const bool is_start = type == SserialEvents::Type::NO_START;
    enter(pins, is_start ? SserialState::FAULTED : SserialState::STOPPING);
}

void SserialPortControl::note_fault(SserialPortPins &pins, std::uint32_t channels) noexcept {
    const std::uint64_t sum = std::uint64_t{pins.fault_count} + pins.fault_inc;
    pins.fault_count = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum, UINT32_MAX));
    if (pins.fault_inc > 0 && pins.fault_count >= pins.fault_lim) {
        stop_by_faults(pins, SserialEvents::Type::FAULT, channels);
    }
}

void SserialPortControl::note_late(SserialPortPins &pins, const SserialReading &reading) noexcept {
    const std::int64_t elapsed_ns = reading.now_ns - sent_ns_;
    const auto period_ns = static_cast<std::int64_t>(reading.period_s * 1e9);
    // The thread wrote late and read soon afterwards, so the exchange is not too long.
    if (elapsed_ns < period_ns / 2) {
        return;
    }
    late_streak_ += late_reads_ == 0 ? 1 : 0;
    ++late_reads_;
    // A late packet has the same effect. An exchange that is too long is late each time.
    if (late_streak_ < LATE_STREAK && late_reads_ < LATE_READS) {
        return;
    }
    late_shortest_ns_ = std::max(late_shortest_ns_, elapsed_ns);
    note_fault(pins, 0);
}

void SserialPortControl::note_in_time(const SserialReading &reading) noexcept {
    late_streak_ = late_reads_ == 0 ? 0 : late_streak_;
    late_reads_ = 0;
    if (late_shortest_ns_ == 0) {
        return;
    }
    if (!late_reported_ && event_.type == SserialEvents::Type::NONE) {
        event_ = {.type = SserialEvents::Type::LATE,
                  .shortest_ns = late_shortest_ns_,
                  .longest_ns = reading.now_ns - sent_ns_,
                  .period_ns = static_cast<std::int64_t>(reading.period_s * 1e9)};
    }
    late_reported_ = true;
    quiet_s_ = 0.0;
    late_shortest_ns_ = 0;
}

void SserialPortControl::evaluate_start(SserialPortPins &pins, const SserialReading &reading) noexcept {
    if ((reading.failed & channels_) != 0) {
        stop_by_faults(pins, SserialEvents::Type::NO_START, reading.failed & channels_);
        return;
    }
    enter(pins, SserialState::RUNNING);
}

std::uint32_t SserialPortControl::read(SserialPortPins &pins, const SserialReading &reading) noexcept {
    clear_ = (reading.command & COMMAND_MASK) == 0;
    const bool is_exchange = (last_command_ & DO_IT) != 0;
    if (!clear_) {
        if (is_exchange && state_ == SserialState::RUNNING) {
            note_late(pins, reading);
        }
        return 0;
    }
    if (answered_) {
        return 0;
    }
    answered_ = true;
    if (state_ == SserialState::STARTING) {
        evaluate_start(pins, reading);
        return 0;
    }
    if (state_ != SserialState::RUNNING || !is_exchange) {
        return 0;
    }
    note_in_time(reading);
    const std::uint32_t failed = (reading.failed | reading.faulty) & channels_;
    const bool first = exchanges_ < FIRST_EXCHANGES;
    exchanges_ += first ? 1 : 0;
    if (failed != 0 && first && silent_starts_ < MOST_SILENT_STARTS) {
        ++silent_starts_;
        enter(pins, SserialState::IDLE);
    } else if (failed != 0) {
        note_fault(pins, failed);
    } else {
        pins.fault_count -= std::min(pins.fault_count, pins.fault_dec);
        silent_starts_ = first ? silent_starts_ : 0;
        if (recovering_ && !first) {
            recovering_ = false;
            pins.fault = false;
            event_ = {.type = SserialEvents::Type::RECOVERED,
                      .stopped_ns = static_cast<std::int64_t>(stopped_s_ * 1e9)};
        }
    }
    return channels_ & ~failed;
}

/// Stops the cards for a while, then starts them.
SserialCommand SserialPortControl::write_stopping(SserialPortPins &pins, double period_s) noexcept {
    in_state_s_ += period_s;
    if (!stop_sent_) {
        // A processor that is still busy may hang, so it is stopped, too.
        stop_sent_ = true;
        return send(STOP | CHANNELS);
    }
    const double pause_s = state_ == SserialState::FAULTED ? RETRY_S : OUTPUTS_OFF_S;
    return in_state_s_ >= pause_s ? start(pins) : SserialCommand{};
}

SserialCommand SserialPortControl::write_idle(SserialPortPins &pins, const Moment &moment) noexcept {
    in_state_s_ += moment.period_s;
    // Cards may be running since a fault of the bus or from another program.
    if (!stop_sent_) {
        stop_sent_ = true;
        return send(STOP | CHANNELS);
    }
    if (!clear_ || in_state_s_ < SETTLE_S) {
        return {};
    }
    const bool setup_due = moment.has_parameters && !setup_done_;
    setup_done_ = false;
    if (!setup_due) {
        return start(pins);
    }
    enter(pins, SserialState::SETUP);
    SserialCommand command = send(START_SETUP | channels_);
    command.has_modes = true;
    return command;
}

SserialCommand SserialPortControl::write_setup(SserialPortPins &pins, double period_s) noexcept {
    in_state_s_ += period_s;
    if (in_state_s_ > START_LIMIT_S) {
        finish_setup(pins, channels_);
        return {};
    }
    return {.is_setup_step = clear_};
}

SserialCommand SserialPortControl::setup_step(int channel) noexcept {
    in_state_s_ = 0.0;
    return send(DO_IT | (1U << static_cast<unsigned>(channel)));
}

void SserialPortControl::finish_setup(SserialPortPins &pins, std::uint32_t failed) noexcept {
    enter(pins, SserialState::IDLE);
    setup_done_ = true;
    if (failed != 0) {
        event_ = {.type = SserialEvents::Type::NO_SETUP, .channels = failed};
    }
}

SserialCommand SserialPortControl::write(SserialPortPins &pins, const Moment &moment) noexcept {
    stopped_s_ += recovering_ ? moment.period_s : 0.0;
    quiet_s_ += moment.period_s;
    late_reported_ = late_reported_ && quiet_s_ < QUIET_S;
    if (!moment.writing) {
        gap_s_ += moment.period_s;
        return {};
    }
    const bool has_gap = gap_s_ > LONGEST_GAP_S;
    gap_s_ = 0.0;
    if (has_gap && state_ != SserialState::IDLE && !recovering_) {
        enter(pins, SserialState::IDLE);
    }
    if (!pins.run) {
        const bool stop_due = state_ != SserialState::IDLE || !stop_sent_;
        if (!stop_due) {
            return {};
        }
        // The operator stops the port. This ends a fault, and outputs follow their pins after the next start.
        enter(pins, SserialState::IDLE);
        stop_sent_ = true;
        recovering_ = pins.fault = false;
        pins.fault_count = 0;
        silent_starts_ = 0;
        outputs_ = SserialOutputs::RELEASED;
        return send(STOP | CHANNELS);
    }
    switch (state_) {
    case SserialState::IDLE: return write_idle(pins, moment);
    case SserialState::SETUP: return write_setup(pins, moment.period_s);
    case SserialState::STOPPING:
    case SserialState::FAULTED: return write_stopping(pins, moment.period_s);
    case SserialState::STARTING:
        in_state_s_ += moment.period_s;
        if (in_state_s_ > START_LIMIT_S) {
            stop_by_faults(pins, SserialEvents::Type::NO_START, channels_);
        }
        return {};
    case SserialState::RUNNING: break;
    }
    if (!clear_) {
        return {};
    }
    SserialCommand command = send(DO_IT | channels_);
    command.has_data = true;
    sent_ns_ = moment.now_ns;
    return command;
}

SserialEvents SserialPortControl::take_event() noexcept {
    const SserialEvents event = event_;
    event_ = {};
    return event;
}

SserialOutputs SserialPortControl::take_outputs() noexcept {
    const SserialOutputs outputs = outputs_;
    outputs_ = SserialOutputs::KEPT;
    return outputs;
}

}  // namespace mw::mesa
