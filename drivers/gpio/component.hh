// SPDX-License-Identifier: GPL-2.0-or-later
// The common part of hal_gpio and hal_pi_gpio: lines with their HAL pins and functions.
#pragma once

#include <cstdlib>
#include <cstring>

#include "drivers/gpio/character_device.hh"
#include "drivers/gpio/lines.hh"
#include "hal/sdk/canonical.hh"
#include "millwright_ext.h"

namespace mw::gpio {

using namespace sdk;

/// Lines in memory, for configurations that are tested without the hardware.
class SimulatedLines final : public LineAccess {
  public:
    int open(const char *, const Lines &) noexcept override { return 0; }
    bool read(Levels &levels) noexcept override {
        levels = inputs;
        return true;
    }
    bool write(Levels levels) noexcept override {
        outputs = levels;
        return true;
    }
    void close() noexcept override {}

    Levels inputs = 0, outputs = 0;
};

/// Lines are simulated under the virtual clock, because another process may control a machine through them,
/// and when the environment variable requires it.
inline bool isSimulated() noexcept {
    const char *const value = std::getenv("MILLWRIGHT_GPIO");
    return mw_ext_is_virtual() != 0 || (value != nullptr && std::strcmp(value, "simulated") == 0);
}

/// Lines with pins NAME-in, NAME-in-not and NAME-out. In HAL memory.
struct LinePins {
    Lines lines;
    Levels resetting = 0;  ///< outputs that reset() makes inactive
    CharacterDevice device{linux_system()};
    SimulatedLines simulated;
    LineAccess *access = nullptr;
    DigitalIn in[MAX_LINES];
    In<bool> out[MAX_LINES];
    In<bool> in_fake[MAX_LINES];
    Out<bool> out_fake[MAX_LINES];
    Out<bool> fault;
    ParamRw<std::uint32_t> reset_ns;
    FailureState reading, writing;
    Levels inputs = 0, written = 0;
    bool known = false;  ///< `written` contains the current outputs
    long long written_ns = 0;

    /// Claims the lines: 0, or a negated errno with a message.
    int open(const char *module) noexcept {
        access = isSimulated() ? static_cast<LineAccess *>(&simulated) : &device;
        return access->open(module, lines);
    }

    /// `name_of(i)` is the prefix of the names of line i's pins.
    template <class NameOf>
    void declare(Declare &d, NameOf name_of) noexcept {
        for (std::size_t i = 0; i < lines.count; ++i) {
            const Name name = name_of(i);
            const auto pin_name = [&](const char *end) { return joined(d, name.text, end); };
            if (lines.line[i].direction == Direction::INPUT) {
                in[i].declare(d, pin_name("-").text);
            } else {
                d.pin(out[i], pin_name("-out").text);
            }
            if (access == &simulated && lines.line[i].direction == Direction::INPUT) {
                d.pin(in_fake[i], pin_name("-in-fake").text);
            }
            if (access == &simulated && lines.line[i].direction == Direction::OUTPUT) {
                d.pin(out_fake[i], pin_name("-out-fake").text);
            }
        }
        d.pin(fault, "fault");
        d.function<&LinePins::read>(this, "read");
        d.function<&LinePins::write>(this, "write");
    }

    void read() noexcept {
        if (access == &simulated) {
            simulated.inputs = 0;
            for (std::size_t i = 0; i < lines.count; ++i) {
                const bool high = lines.line[i].direction == Direction::INPUT && in_fake[i];
                simulated.inputs |= high != lines.line[i].inverted ? bit_of(i) : 0;
            }
        }
        keep(access->read(inputs), reading, "read");
        for (std::size_t i = 0; i < lines.count; ++i) {
            if (lines.line[i].direction == Direction::INPUT) {
                in[i].read((inputs & bit_of(i)) != 0);
            }
        }
    }

    void write() noexcept {
        Levels levels = 0;
        for (std::size_t i = 0; i < lines.count; ++i) {
            levels |= lines.line[i].direction == Direction::OUTPUT && out[i] ? bit_of(i) : 0;
        }
        send(levels);
        written_ns = rtapi_get_time();
    }

    void reset(long period_ns) noexcept {
        if ((written & resetting) == 0) {
            return;
        }
        delay_after(written_ns, reset_ns, period_ns);
        send(written & ~resetting);
    }

    /// Switches all outputs off.
    void end() noexcept {
        if (access != nullptr) {
            access->write(0);
            access->close();
        }
    }

  private:
    void send(Levels levels) noexcept {
        if (known && levels == written) {
            return;
        }
        known = keep(access->write(levels), writing, "written");
        written = levels;
        for (std::size_t i = 0; i < lines.count && access == &simulated; ++i) {
            if (lines.line[i].direction == Direction::OUTPUT) {
                out_fake[i] = ((levels & bit_of(i)) != 0) != lines.line[i].inverted;
            }
        }
    }
    /// Shows the result of a call; reports the first cycle of a failure once.
    bool keep(bool good, FailureState &state, const char *what) noexcept {
        if (state.begins(good)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "GPIO lines from '%s' on cannot be %s: errno %d\n",
                            lines.line[0].name, what, errno);
        }
        fault = reading.isFailing() || writing.isFailing();
        return good;
    }
};

}  // namespace mw::gpio
