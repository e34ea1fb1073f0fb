// SPDX-License-Identifier: GPL-2.0-or-later
// A frequency drive on a serial line with Modbus RTU: its registers, and the loop of all types. [one thread,
// not realtime]
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/result.hh"
#include "hal/include/hal.h"

struct _modbus;

namespace mw::modbus::drives {

struct Line {
    std::string device = "/dev/ttyS0";
    int baud = 19200, bits = 8, stop = 1;
    char parity = 'E';  ///< N, E, O
    int slave = 1;
    bool shown = false;  ///< all messages on standard error
};

/// The registers of one drive. A failure is reported once, until the drive answers again.
class Registers {
  public:
    Registers(std::string component, Line line);
    ~Registers();
    Registers(const Registers &) = delete;
    Registers &operator=(const Registers &) = delete;

    /// False: no answer, or an exception. The line is opened again after an error that is not from the drive.
    bool read(int address, std::span<std::uint16_t> into);
    bool write(int address, std::uint16_t value);

    int errors() const { return errors_; }
    /// Number of transactions since the last failed one.
    int good_in_a_row() const { return good_; }
    int bad_in_a_row() const { return bad_; }

  private:
    bool connect();
    bool note(bool done);

    std::string component_;
    Line line_;
    struct Free {
        void operator()(_modbus *context) const;
    };
    std::unique_ptr<_modbus, Free> context_;
    int errors_ = 0, good_ = 0, bad_ = 0;
    std::chrono::steady_clock::time_point retry_{};
};

/// Creates pins and parameters COMPONENT.NAME; reports HAL errors at the end.
class PinMaker {
  public:
    PinMaker(int comp_id, const std::string &component) : id_(comp_id), component_(component) {}

    void out(hal_float_t *&pin, const char *what) { make(pin, HAL_OUT, what); }
    void out(hal_bit_t *&pin, const char *what) { make(pin, HAL_OUT, what); }
    void out(hal_s32_t *&pin, const char *what);
    void in(hal_float_t *&pin, const char *what) { make(pin, HAL_IN, what); }
    void in(hal_bit_t *&pin, const char *what) { make(pin, HAL_IN, what); }
    /// Parameters that may be written.
    void setting(hal_float_t &param, const char *what);
    void setting(hal_s32_t &param, const char *what);

    bool isDone() const { return valid_; }

  private:
    void make(hal_float_t *&pin, hal_pin_dir_t way, const char *what);
    void make(hal_bit_t *&pin, hal_pin_dir_t way, const char *what);
    void note(int result) { valid_ = valid_ && result == 0; }

    int id_;
    const std::string &component_;
    bool valid_ = true;
};

/// Interface of the types of drives.
class Drive {
  public:
    virtual ~Drive() = default;
    /// Creates pins and parameters; false: HAL has rejected them.
    virtual bool make_pins(int comp_id, const std::string &name) = 0;
    /// One round of reading and writing.
    virtual void step(Registers &registers) = 0;
    /// The last writes to the drive, when the component ends.
    virtual void release(Registers &registers) = 0;
    /// Time until the next step [s].
    virtual double pause_s() const = 0;
};

/// Calls step() until `stop` is not 0, then releases the drive, so that it never runs without its component.
Result<> run(Drive &drive, const std::string &name, const Line &line, const volatile std::sig_atomic_t &stop);

/// A speed as a register in steps of `unit_hz`: 0 for NaN, limited to the range of the register.
std::uint16_t frequency_word(double hz, double unit_hz);

/// True if `hz` is within `tolerance` (a fraction) of the requested value; a drive that should be stopped is
/// never at speed.
bool isAtSpeed(double wanted_hz, double hz, double tolerance);

}  // namespace mw::modbus::drives
