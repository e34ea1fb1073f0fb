// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/modbus/drives/drive.hh"

#include <modbus.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <thread>
#include <utility>

#include "base/language/language.hh"

namespace mw::modbus::drives {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto RECONNECT_AFTER = std::chrono::seconds(1);
constexpr auto LOOK_AFTER = std::chrono::milliseconds(20);
constexpr std::uint32_t ANSWER_US = 300000;
constexpr double MIN_PAUSE_S = 0.001, MAX_PAUSE_S = 10.0;
constexpr double MAX_WORD = 65535.0;

}  // namespace

Registers::Registers(std::string component, Line line)
    : component_(std::move(component)), line_(std::move(line)) {}
Registers::~Registers() = default;

void Registers::Free::operator()(_modbus *context) const {
    modbus_close(context);
    modbus_free(context);
}

bool Registers::connect() {
    if (context_ != nullptr) {
        return true;
    }
    if (Clock::now() < retry_) {
        errno = EAGAIN;
        return false;
    }
    retry_ = Clock::now() + RECONNECT_AFTER;
    context_.reset(modbus_new_rtu(line_.device.c_str(), line_.baud, line_.parity, line_.bits, line_.stop));
    if (context_ == nullptr) {
        return false;
    }
    modbus_set_debug(context_.get(), line_.shown ? 1 : 0);
    modbus_set_response_timeout(context_.get(), 0, ANSWER_US);
    const bool open =
        modbus_set_slave(context_.get(), line_.slave) == 0 && modbus_connect(context_.get()) == 0;
    if (!open) {
        const int reason = errno;
        context_.reset();
        errno = reason;
    }
    return open;
}

bool Registers::note(bool done) {
    const int reason = errno;
    if (done) {
        if (bad_ > 0) {
            language::tell(component_ + ": the drive at " + line_.device + " answers again");
        }
        bad_ = 0;
        ++good_;
        return true;
    }
    if (bad_ == 0) {
        language::tell(component_ + ": the drive at " + line_.device + ", slave " +
                       std::to_string(line_.slave) + ": " + modbus_strerror(reason));
    }
    ++errors_;
    ++bad_;
    good_ = 0;
    if (context_ != nullptr && reason >= MODBUS_ENOBASE) {
        modbus_flush(context_.get());
    } else if (context_ != nullptr && reason != ETIMEDOUT) {
        context_.reset();
    }
    return false;
}

bool Registers::read(int address, std::span<std::uint16_t> into) {
    const auto count = static_cast<int>(into.size());
    return note(connect() && modbus_read_registers(context_.get(), address, count, into.data()) == count);
}

bool Registers::write(int address, std::uint16_t value) {
    return note(connect() && modbus_write_register(context_.get(), address, value) == 1);
}

void PinMaker::make(hal_float_t *&pin, hal_pin_dir_t way, const char *what) {
    note(hal_pin_float_newf(way, &pin, id_, "%s.%s", component_.c_str(), what));
}

void PinMaker::make(hal_bit_t *&pin, hal_pin_dir_t way, const char *what) {
    note(hal_pin_bit_newf(way, &pin, id_, "%s.%s", component_.c_str(), what));
}

void PinMaker::out(hal_s32_t *&pin, const char *what) {
    note(hal_pin_s32_newf(HAL_OUT, &pin, id_, "%s.%s", component_.c_str(), what));
}

void PinMaker::setting(hal_float_t &param, const char *what) {
    note(hal_param_float_newf(HAL_RW, &param, id_, "%s.%s", component_.c_str(), what));
}

void PinMaker::setting(hal_s32_t &param, const char *what) {
    note(hal_param_s32_newf(HAL_RW, &param, id_, "%s.%s", component_.c_str(), what));
}

Result<> run(Drive &drive, const std::string &name, const Line &line,
             const volatile std::sig_atomic_t &stop) {
    const int id = hal_init(name.c_str());
    if (id < 0) {
        return fail("HAL does not accept component " + name, {},
                    "a component with this name may already exist");
    }
    if (!drive.make_pins(id, name)) {
        hal_exit(id);
        return fail("HAL does not accept the pins " + name + ".*");
    }
    hal_ready(id);
    Registers registers(name, line);
    while (stop == 0) {
        drive.step(registers);
        const double asked_s = drive.pause_s();
        const double pause_s =
            std::isnan(asked_s) ? MAX_PAUSE_S : std::clamp(asked_s, MIN_PAUSE_S, MAX_PAUSE_S);
        const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double>(pause_s));
        while (stop == 0 && Clock::now() < until) {
            std::this_thread::sleep_for(std::min<Clock::duration>(until - Clock::now(), LOOK_AFTER));
        }
    }
    drive.release(registers);
    hal_exit(id);
    return {};
}

std::uint16_t frequency_word(double hz, double unit_hz) {
    const double word = std::round(hz / unit_hz);
    return std::isfinite(word) ? static_cast<std::uint16_t>(std::clamp(word, 0.0, MAX_WORD))
                               : std::uint16_t{0};
}

bool isAtSpeed(double wanted_hz, double hz, double tolerance) {
    return wanted_hz > 0.0 && std::abs(hz - wanted_hz) <= tolerance * wanted_hz;
}

}  // namespace mw::modbus::drives
