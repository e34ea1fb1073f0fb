// SPDX-License-Identifier: GPL-2.0-or-later
// Registers: the VFD-B's manual. The command word has stop, run or jog in its bits 0 and 1, the direction in
// 4 and 5.
#include <array>
#include <cmath>

#include "drivers/modbus/drives/kinds.hh"

namespace mw::modbus::drives {
namespace {

constexpr int MAX_FREQUENCY = 0x0100, COMMAND = 0x2000, SPEED = 0x2001;
constexpr int STATE = 0x2100, FREQUENCY_OUT = 0x2103, CURRENT = 0x2104, VOLTAGE = 0x2106, LOAD = 0x210b,
              RPM = 0x210c;
constexpr std::uint16_t STOP = 1, RUN = 2, JOG = 3, FORWARD = 0x10, REVERSE = 0x20, RELEASED = 0;
constexpr double HZ = 0.01, TENTH = 0.1, FAST_S = 0.001;
constexpr int GOOD_IN_A_ROW = 10, LOST_AFTER = 10;

struct Pins {
    hal_s32_t *status, *error_count, *error_code;
    hal_float_t *freq_cmd, *freq_out, *load, *max_rpm, *rpm, *rps, *voltage, *current, *freq_limit;
    hal_bit_t *at_speed, *is_stopped, *is_e_stopped, *modbus_ok;
    hal_float_t *speed_command;
    hal_bit_t *enable, *spindle_on, *jog, *max_speed;
    hal_float_t loop_time, nameplate_hz, nameplate_rpm, rpm_limit, tolerance;
};

class Vfdb final : public Drive {
  public:
    explicit Vfdb(const VfdbSettings &settings) : settings_(settings) {}

    bool make_pins(int id, const std::string &name) override;
    void step(Registers &registers) override;
    void release(Registers &registers) override {
        if (was_reached_) {
            static_cast<void>(registers.write(COMMAND, STOP) && registers.write(COMMAND, RELEASED));
        }
    }
    double pause_s() const override {
        return *pins_->max_speed ? FAST_S : static_cast<double>(pins_->loop_time);
    }

  private:
    bool read(Registers &registers);
    bool read_seldom(Registers &registers);
    bool command(Registers &registers);

    VfdbSettings settings_;
    Pins *pins_ = nullptr;
    int rounds_ = 0;
    double wanted_hz_ = 0.0;
    bool running_ = false, was_reached_ = false;
    bool off_required_ = false;  ///< the drive did not answer, and must not start by itself afterwards
};

bool Vfdb::make_pins(int id, const std::string &name) {
    pins_ = static_cast<Pins *>(hal_malloc(sizeof(Pins)));
    if (pins_ == nullptr) {
        return false;
    }
    Pins &p = *pins_;
    PinMaker make(id, name);
    make.out(p.status, "status");
    make.out(p.error_count, "error-count");
    make.out(p.error_code, "error-code");
    make.out(p.freq_cmd, "frequency-command");
    make.out(p.freq_out, "frequency-out");
    make.out(p.load, "inverter-load-percentage");
    make.out(p.max_rpm, "max-rpm");
    make.out(p.rpm, "motor-RPM");
    make.out(p.rps, "motor-RPS");
    make.out(p.voltage, "output-voltage");
    make.out(p.current, "output-current");
    make.out(p.freq_limit, "frequency-limit");
    make.out(p.at_speed, "at-speed");
    make.out(p.is_stopped, "is-stopped");
    make.out(p.is_e_stopped, "is-e-stopped");
    make.out(p.modbus_ok, "modbus-ok");
    make.in(p.speed_command, "speed-command");
    make.in(p.enable, "enable");
    make.in(p.spindle_on, "spindle-on");
    make.in(p.jog, "jog-mode");
    make.in(p.max_speed, "max-speed");
    make.setting(p.loop_time, "loop-time");
    make.setting(p.nameplate_hz, "nameplate-HZ");
    make.setting(p.nameplate_rpm, "nameplate-RPM");
    make.setting(p.rpm_limit, "rpm-limit");
    make.setting(p.tolerance, "tolerance");
    if (make.isDone()) {
        p.loop_time = 0.1;
        p.nameplate_hz = settings_.motor_hz;
        p.nameplate_rpm = settings_.motor_rpm;
        p.rpm_limit = settings_.motor_rpm;
        p.tolerance = 0.01;
    }
    return make.isDone();
}

bool Vfdb::read(Registers &registers) {
    Pins &p = *pins_;
    std::array<std::uint16_t, 1> limit{}, hz{}, rpm{};
    std::array<std::uint16_t, 2> state{};
    if (*p.freq_limit == 0.0) {
        if (!registers.read(MAX_FREQUENCY, limit)) {
            return false;
        }
        *p.freq_limit = limit[0] * HZ;
    }
    if (!registers.read(STATE, state) || !registers.read(FREQUENCY_OUT, hz) || !registers.read(RPM, rpm)) {
        return false;
    }
    *p.error_code = state[0];
    *p.status = state[1];
    *p.freq_out = hz[0] * HZ;
    *p.is_stopped = hz[0] == 0;
    *p.rpm = rpm[0];
    *p.rps = rpm[0] / 60.0;
    *p.max_rpm = p.nameplate_hz > 0.0 ? *p.freq_limit * p.nameplate_rpm / p.nameplate_hz : 0.0;
    return rounds_++ % settings_.poll_cycles != 0 || read_seldom(registers);
}

bool Vfdb::read_seldom(Registers &registers) {
    std::array<std::uint16_t, 1> load{}, current{}, voltage{};
    if (!registers.read(LOAD, load) || !registers.read(CURRENT, current) ||
        !registers.read(VOLTAGE, voltage)) {
        return false;
    }
    *pins_->load = load[0];
    *pins_->current = current[0] * TENTH;
    *pins_->voltage = voltage[0] * TENTH;
    return true;
}

bool Vfdb::command(Registers &registers) {
    Pins &p = *pins_;
    if (!*p.enable) {
        running_ = false;
        wanted_hz_ = 0.0;
        return registers.write(COMMAND, RELEASED);
    }
    const double asked = std::isfinite(*p.speed_command) ? static_cast<double>(*p.speed_command) : 0.0;
    const double limit = p.rpm_limit > 0.0 ? static_cast<double>(p.rpm_limit) : 0.0;
    const double rpm = std::fmin(std::abs(asked), limit);
    wanted_hz_ = p.nameplate_rpm > 0.0 ? rpm * p.nameplate_hz / p.nameplate_rpm : 0.0;
    const std::uint16_t way = asked < 0.0 ? REVERSE : FORWARD;
    off_required_ = off_required_ && *p.spindle_on;
    running_ = *p.spindle_on && !off_required_;
    const std::uint16_t act = !running_ ? STOP : *p.jog ? JOG : RUN;
    *p.freq_cmd = wanted_hz_;
    // The speed is written first, because a drive with a run command uses its last speed.
    return registers.write(SPEED, frequency_word(wanted_hz_, HZ)) &&
           registers.write(COMMAND, static_cast<std::uint16_t>(act | (running_ ? way : FORWARD)));
}

void Vfdb::step(Registers &registers) {
    Pins &p = *pins_;
    const bool done = read(registers) && command(registers);
    was_reached_ = was_reached_ || done;
    *p.at_speed = done && running_ && !*p.jog && isAtSpeed(wanted_hz_, *p.freq_out, p.tolerance);
    *p.modbus_ok = done && registers.good_in_a_row() >= GOOD_IN_A_ROW;
    *p.error_count = registers.errors();
    if (registers.bad_in_a_row() >= LOST_AFTER) {
        *p.freq_limit = 0.0;  // the drive may have another limit afterwards
        off_required_ = true;
    }
}

}  // namespace

std::unique_ptr<Drive> make_vfdb(const VfdbSettings &settings) {
    return std::make_unique<Vfdb>(settings);
}

}  // namespace mw::modbus::drives
