// SPDX-License-Identifier: GPL-2.0-or-later
// pwmgen: pulse width or pulse density modulation on bits, up to 8 channels: `output_type=0,1,...`, one
// number each. 0: `pwm`, for positive values. 1: `pwm` and `dir` (true for negative values). 2: `up` and
// `down`.
//
// Function pwmgen.update: the duty cycle `curr-dc` is `value` / `scale` + `offset` (-1 to 1), its magnitude
// limited to `min-dc` and `max-dc`; no pulse width when value is not a number. pwmgen.make-pulses, in a fast
// thread, makes the pulses. `pwm-freq` [Hz]: at most half the rate of make-pulses, and an integer fraction of
// it (the pin is set to the actual frequency); 0 selects pulse density modulation. `dither-pwm` (bit):
// pwm-freq is not changed, and the average over many periods is exact. While `enable` (bit) is false all bits
// are low. Others float; scale, offset, min-dc, max-dc, pwm-freq and dither-pwm are I/O pins.
#include <cmath>

#include "components/generators/pwm_core.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_PWM = 8;
constexpr int NO_TYPE = -1;
static int output_type[MAX_PWM] = {NO_TYPE, NO_TYPE, NO_TYPE, NO_TYPE, NO_TYPE, NO_TYPE, NO_TYPE, NO_TYPE};
RTAPI_MP_ARRAY_INT(output_type, MAX_PWM, "0 pwm, 1 pwm and dir, 2 up and down");

namespace mw::components {
using namespace sdk;

struct PwmChannel {
    int type = 0;
    In<bool> enable;
    In<double> value;
    Out<bool> pulse, dir, up, down;
    Out<double> curr_dc;
    InOut<double> max_dc, min_dc, scale, offset, pwm_freq;
    InOut<bool> dither;
    pwm::Generator generator;
    bool isEnabled = false;  // value at the last update
    bool negative = false;

    void declare(Declare &d) noexcept;
    void update(double tick_ns) noexcept;
    void make_pulses() noexcept;

  private:
    double duty() noexcept;
    long period_ticks(double tick_ns) noexcept;
};

void PwmChannel::declare(Declare &d) noexcept {
    if (type == 2) {
        d.pin(up, "up");
        d.pin(down, "down");
    } else {
        d.pin(pulse, "pwm");
    }
    if (type == 1) {
        d.pin(dir, "dir");
    }
    d.pin(enable, "enable");
    d.pin(value, "value");
    d.pin(scale, "scale", 1.0);
    d.pin(offset, "offset");
    d.pin(dither, "dither-pwm");
    d.pin(pwm_freq, "pwm-freq");
    d.pin(min_dc, "min-dc");
    d.pin(max_dc, "max-dc", 1.0);
    d.pin(curr_dc, "curr-dc");
}

/// The requested duty cycle, with its sign. Also corrects invalid limits.
double PwmChannel::duty() noexcept {
    const double high = max_dc >= 0.0 ? std::fmin(max_dc, 1.0) : 1.0;
    const double low = min_dc > 0.0 ? std::fmin(min_dc, high) : 0.0;
    max_dc = high;
    min_dc = low;
    const double divisor = scale;
    if (!(std::fabs(divisor) > 1e-20)) {
        scale = 1.0;
    }
    const double wanted = value / scale + offset;
    if (!std::isfinite(wanted)) {
        return 0.0;
    }
    const double possible = type == 0 && wanted < 0.0 ? 0.0 : wanted;
    return std::copysign(std::fmax(low, std::fmin(high, std::fabs(possible))), possible);
}

/// The period of the pulses, 0 for pulse density. Sets pwm-freq to the frequency that is really used.
long PwmChannel::period_ticks(double tick_ns) noexcept {
    const double tick_hz = 1e9 / tick_ns;
    double wanted_hz = pwm_freq;
    if (!(wanted_hz > 0.0)) {
        pwm_freq = 0.0;
        return 0;
    }
    wanted_hz = std::fmin(wanted_hz, tick_hz / 2.0);
    const double ticks = std::fmin(std::round(tick_hz / wanted_hz), 1e9);
    pwm_freq = dither ? wanted_hz : tick_hz / ticks;
    return static_cast<long>(ticks);
}

void PwmChannel::update(double tick_ns) noexcept {
    const double wanted = duty();
    const long ticks = period_ticks(tick_ns);
    double made = std::fabs(wanted);
    if (ticks > 0 && !dither) {
        made = std::round(made * static_cast<double>(ticks)) / static_cast<double>(ticks);
    }
    negative = wanted < 0.0;
    isEnabled = enable;
    if (type == 1) {
        dir = negative;  // set before the first pulse, also while disabled
    }
    generator.plan(made, ticks, dither);
    curr_dc = std::copysign(made, wanted);
}

void PwmChannel::make_pulses() noexcept {
    const bool on = isEnabled && enable;
    if (!on) {
        generator.stop();
    }
    const bool is_high = on && generator.tick();
    if (type == 2) {
        up = is_high && !negative;
        down = is_high && negative;
        return;
    }
    pulse = is_high;
}

struct Pwmgen {
    int count = 0;
    PwmChannel *channel[MAX_PWM] = {};
    long tick_ns = 0;  // period of make-pulses; 0 until it has run

    int load(int comp_id) noexcept {
        for (; count < MAX_PWM && output_type[count] != NO_TYPE; ++count) {
            const int status = load_channel(comp_id);
            if (status < 0) {
                return status;
            }
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "pwmgen: output_type= is missing, for example output_type=0");
            return -EINVAL;
        }
        Declare d(comp_id, "pwmgen", 0);
        d.function<&Pwmgen::make_pulses>(this, "make-pulses");
        d.function<&Pwmgen::update>(this, "update");
        return d.status();
    }

    void make_pulses(long period_ns) noexcept {
        tick_ns = period_ns;
        for (int i = 0; i < count; ++i) {
            channel[i]->make_pulses();
        }
    }

    void update(long period_ns) noexcept {
        const long base_ns = tick_ns > 0 ? tick_ns : period_ns;
        for (int i = 0; i < count; ++i) {
            channel[i]->update(static_cast<double>(base_ns));
        }
    }

  private:
    int load_channel(int comp_id) noexcept {
        if (output_type[count] < 0 || output_type[count] > 2) {
            rtapi_print_msg(RTAPI_MSG_ERR, "pwmgen: output_type has %d, possible are 0, 1 and 2",
                            output_type[count]);
            return -EINVAL;
        }
        PwmChannel *made = make<PwmChannel>();
        if (made == nullptr) {
            return -ENOMEM;
        }
        made->type = output_type[count];
        Name prefix;
        rtapi_snprintf(prefix.text, sizeof prefix.text, "pwmgen.%d", count);
        Declare d(comp_id, prefix.text, count);
        made->declare(d);
        channel[count] = made;
        return d.status();
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Pwmgen, "pwmgen");
