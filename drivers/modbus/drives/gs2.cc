// SPDX-License-Identifier: GPL-2.0-or-later
// Registers: the GS2's manual, parameters P1.00 to P9.30 at 0x0100 + 0x100 * group + number, its state from
// 0x2100 on.
#include <array>
#include <cmath>

#include "drivers/modbus/drives/kinds.hh"

namespace mw::modbus::drives {
namespace {

constexpr int STOP_METHOD = 0x0100, ACCEL_TIME = 0x0101, DECEL_TIME = 0x0102, STALL_PREVENTION = 0x0605;
constexpr int SPEED = 0x091a, RUN = 0x091b, DIRECTION = 0x091c, FAULT_RESET = 0x091e;
constexpr int STATE = 0x2100;
constexpr std::size_t STATE_WORDS = 13;
constexpr double HZ = 0.1, TENTH = 0.1, FALLBACK_DECEL_S = 20.0;
/// After this number of transactions without an answer the drive counts as switched off, and its settings are
/// written again.
constexpr int LOST_AFTER = 10;

struct Pins {
    hal_s32_t *status_1, *status_2, *firmware_revision;
    hal_float_t *freq_cmd, *freq_out, *current, *dc_bus, *voltage, *rpm, *scale, *power_factor, *load;
    hal_bit_t *at_speed, *is_stopped, *initialized;
    hal_float_t *speed_command;
    hal_bit_t *enable, *spindle_on, *fwd, *rev, *err_reset;
    hal_s32_t error_count, retval, ack_delay;
    hal_float_t loop_time, nameplate_hz, nameplate_rpm, tolerance;
};

class Gs2 final : public Drive {
  public:
    explicit Gs2(const Gs2Settings &settings) : settings_(settings) {}

    bool make_pins(int id, const std::string &name) override;
    void step(Registers &registers) override;
    void release(Registers &registers) override {
        if (started_) {
            static_cast<void>(registers.write(RUN, 0));
        }
    }
    double pause_s() const override { return pins_->loop_time; }

  private:
    bool begin(Registers &registers);
    bool read(Registers &registers);
    bool command(Registers &registers);
    bool write_direction(Registers &registers);
    void show_lost();

    Gs2Settings settings_;
    Pins *pins_ = nullptr;
    bool started_ = false;  ///< the drive has its settings and a stop command
    bool running_ = false;  ///< it has a run command
    bool was_on_ = false, was_reset_ = false, reverse_ = false;
    std::uint16_t speed_ = 0;
    int since_change_ = 0;
};

bool Gs2::make_pins(int id, const std::string &name) {
    pins_ = static_cast<Pins *>(hal_malloc(sizeof(Pins)));
    if (pins_ == nullptr) {
        return false;
    }
    Pins &p = *pins_;
    PinMaker make(id, name);
    make.out(p.status_1, "status-1");
    make.out(p.status_2, "status-2");
    make.out(p.firmware_revision, "firmware-revision");
    make.out(p.freq_cmd, "frequency-command");
    make.out(p.freq_out, "frequency-out");
    make.out(p.current, "output-current");
    make.out(p.dc_bus, "DC-bus-volts");
    make.out(p.voltage, "output-voltage");
    make.out(p.rpm, "motor-RPM");
    make.out(p.scale, "scale-frequency");
    make.out(p.power_factor, "power-factor");
    make.out(p.load, "load-percentage");
    make.out(p.at_speed, "at-speed");
    make.out(p.is_stopped, "is-stopped");
    make.out(p.initialized, "initialized");
    make.in(p.speed_command, "speed-command");
    make.in(p.enable, "enable");
    make.in(p.spindle_on, "spindle-on");
    make.in(p.fwd, "spindle-fwd");
    make.in(p.rev, "spindle-rev");
    make.in(p.err_reset, "err-reset");
    make.setting(p.error_count, "error-count");
    make.setting(p.retval, "retval");
    make.setting(p.ack_delay, "ack-delay");
    make.setting(p.loop_time, "loop-time");
    make.setting(p.nameplate_hz, "nameplate-HZ");
    make.setting(p.nameplate_rpm, "nameplate-RPM");
    make.setting(p.tolerance, "tolerance");
    if (make.isDone()) {
        *p.enable = true;
        *p.fwd = true;
        p.error_count = 0;
        p.retval = 0;
        p.ack_delay = 2;
        p.loop_time = 0.1;
        p.nameplate_hz = 60.0;
        p.nameplate_rpm = 1730.0;
        p.tolerance = 0.01;
    }
    return make.isDone();
}

/// Writes its times, its stop mode, and a stop command. A spindle that was on before, or while the drive did
/// not answer, does not start by itself, but at the next rising edge of spindle-on.
bool Gs2::begin(Registers &registers) {
    const bool coasts = settings_.decel_s <= 0.0;
    const double decel_s = coasts ? FALLBACK_DECEL_S : settings_.decel_s;
    started_ = registers.write(ACCEL_TIME, frequency_word(settings_.accel_s, TENTH)) &&
               registers.write(STOP_METHOD, coasts ? 1 : 0) &&
               registers.write(DECEL_TIME, frequency_word(decel_s, TENTH)) &&
               registers.write(STALL_PREVENTION, settings_.has_braking_resistor ? 1 : 0) &&
               registers.write(SPEED, 0) && registers.write(RUN, 0) && registers.write(FAULT_RESET, 0);
    running_ = false;
    was_reset_ = false;
    return started_;
}

bool Gs2::read(Registers &registers) {
    std::array<std::uint16_t, STATE_WORDS> word{};
    if (!registers.read(STATE, word)) {
        return false;
    }
    Pins &p = *pins_;
    *p.status_1 = word[0];
    *p.status_2 = word[1];
    *p.freq_cmd = word[2] * HZ;
    *p.freq_out = word[3] * HZ;
    *p.current = word[4] * TENTH;
    *p.dc_bus = word[5] * TENTH;
    *p.voltage = word[6] * TENTH;
    *p.rpm = word[7];
    *p.scale = (static_cast<double>(word[9]) * 65536.0 + word[8]) * HZ;
    *p.power_factor = word[10];
    *p.load = word[11] * TENTH;
    *p.firmware_revision = word[12];
    *p.is_stopped = word[3] == 0;
    return true;
}

bool Gs2::write_direction(Registers &registers) {
    const bool reverse = !*pins_->fwd;
    if (running_ && reverse == reverse_) {
        return true;
    }
    reverse_ = reverse;
    return registers.write(DIRECTION, reverse ? 1 : 0);
}

bool Gs2::command(Registers &registers) {
    Pins &p = *pins_;
    const bool on = *p.spindle_on;
    const double hz =
        p.nameplate_rpm > 0.0 ? std::abs(*p.speed_command) * p.nameplate_hz / p.nameplate_rpm : 0.0;
    const std::uint16_t speed = frequency_word(hz, HZ);
    since_change_ = speed == speed_ && on == was_on_ ? since_change_ + 1 : 0;
    speed_ = speed;
    bool done = registers.write(SPEED, speed);
    if (done && on && (running_ || !was_on_)) {
        done = write_direction(registers) && (running_ || registers.write(RUN, 1));
        running_ = done;
    } else if (done && !on && running_) {
        done = registers.write(RUN, 0);
        running_ = !done;
    }
    if (done) {
        was_on_ = on;
    }
    if (done && *p.err_reset != was_reset_) {
        done = registers.write(FAULT_RESET, *p.err_reset ? 1 : 0);
        was_reset_ = done ? static_cast<bool>(*p.err_reset) : was_reset_;
    }
    return done;
}

void Gs2::show_lost() {
    *pins_->at_speed = false;
    *pins_->initialized = false;
}

void Gs2::step(Registers &registers) {
    Pins &p = *pins_;
    bool done = true;
    if (!*p.enable) {
        done = !started_ || registers.write(RUN, 0);
        started_ = !done;
        running_ = false;
        was_on_ = *p.spindle_on;
        show_lost();
    } else if (!started_) {
        show_lost();
        done = begin(registers);
        was_on_ = done ? was_on_ : static_cast<bool>(*p.spindle_on);
    } else {
        done = read(registers) && command(registers);
        *p.initialized = done;
        *p.at_speed = done && running_ && since_change_ > p.ack_delay &&
                      isAtSpeed(speed_ * HZ, *p.freq_out, p.tolerance);
        started_ = registers.bad_in_a_row() < LOST_AFTER;
    }
    p.error_count = registers.errors();
    p.retval = done ? 1 : -1;
}

}  // namespace

std::unique_ptr<Drive> make_gs2(const Gs2Settings &settings) {
    return std::make_unique<Gs2>(settings);
}

}  // namespace mw::modbus::drives
