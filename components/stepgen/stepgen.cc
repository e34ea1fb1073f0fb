// SPDX-License-Identifier: GPL-2.0-or-later
// stepgen: step pulses in software, up to 16 channels.
//
// `step_type=` has a number for each channel: 0 step and direction, 1 up and down, 2 quadrature, 3 to 14
// phase patterns, 15 the pattern of `user_step_type=` (one number for each state, bit 0 is phase A).
// `ctrl_type=` has p (position, the default) or v (velocity) for each channel.
//
// Functions: make-pulses (as often as possible), update-freq and capture-position (servo thread).
// Pins of stepgen.N: counts (s32), position-fb [units], enable (bit), position-cmd [units] or velocity-cmd
// [units/s], and step, dir / up, down / phase-A to phase-E (bit). Parameters: position-scale [steps/unit],
// maxvel [units/s], maxaccel [units/s^2] (0: no limit), frequency [steps/s], rawcounts, and the minimum times
// steplen, stepspace, dirsetup, dirhold, dirdelay [ns], rounded up to periods.
#include "components/stepgen/stepgen_core.hh"
#include "hal/sdk/component.hh"

static int step_type[mw::stepgen::MAX_CHANNELS] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                   -1, -1, -1, -1, -1, -1, -1, -1};
RTAPI_MP_ARRAY_INT(step_type, mw::stepgen::MAX_CHANNELS, "stepping type of each channel, 0 to 15");
static char *ctrl_type[mw::stepgen::MAX_CHANNELS];
RTAPI_MP_ARRAY_STRING(ctrl_type, mw::stepgen::MAX_CHANNELS,
                      "p position or v velocity control, for each channel");
static int user_step_type[mw::stepgen::MAX_STATES] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
RTAPI_MP_ARRAY_INT(user_step_type, mw::stepgen::MAX_STATES, "states of type 15, bit 0 is phase A");

namespace mw::components {
using namespace sdk;

using namespace mw::stepgen;

struct StepChannel {
    Out<std::int32_t> counts;
    Out<double> position_fb;
    In<bool> enable;
    In<double> position_cmd, velocity_cmd;
    Out<bool> step, dir, up, down;
    Out<bool> phase[MAX_PHASES];
    ParamRo<double> frequency;
    ParamRw<double> maxvel, maxaccel, position_scale;
    ParamRo<std::int32_t> rawcounts;
    ParamRw<std::uint32_t> steplen, stepspace, dirsetup, dirhold, dirdelay;

    PulseChannel pulses;
    RateControl control;
    bool is_velocity = false;

    void declare(Declare &d) noexcept;
    void make_pulses(long period_ns) noexcept;
    void capture() noexcept;
    void update(std::int64_t pulse_period_ns, std::int64_t period_ns, bool period_known) noexcept;

  private:
    void declare_outputs(Declare &d) noexcept;
    double scale() noexcept;
};

void StepChannel::declare_outputs(Declare &d) noexcept {
    if (pulses.type == STEP_AND_DIR) {
        d.pin(step, "step");
        d.pin(dir, "dir");
        d.param(stepspace, "stepspace", 1U);
        d.param(dirsetup, "dirsetup", 1U);
        d.param(dirhold, "dirhold", 1U);
        return;
    }
    d.param(dirdelay, "dirdelay", 1U);
    if (pulses.type == UP_AND_DOWN) {
        d.pin(up, "up");
        d.pin(down, "down");
        d.param(stepspace, "stepspace", 1U);
        return;
    }
    for (int i = 0; i < pulses.pattern.phases; ++i) {
        const char name[] = {'p', 'h', 'a', 's', 'e', '-', static_cast<char>('a' + i), '\0'};
        const char legacy[] = {'p', 'h', 'a', 's', 'e', '-', static_cast<char>('A' + i), '\0'};
        d.legacy_pin(phase[i], name, legacy);
    }
}

void StepChannel::declare(Declare &d) noexcept {
    d.pin(counts, "counts");
    d.pin(position_fb, "position-fb");
    d.pin(enable, "enable");
    if (is_velocity) {
        d.pin(velocity_cmd, "velocity-cmd");
    } else {
        d.pin(position_cmd, "position-cmd");
    }
    d.param(frequency, "frequency");
    d.param(maxvel, "maxvel");
    d.param(maxaccel, "maxaccel");
    d.param(position_scale, "position-scale", 1.0);
    d.param(rawcounts, "rawcounts");
    d.param(steplen, "steplen", 1U);
    declare_outputs(d);
}

double StepChannel::scale() noexcept {
    // With a scale of zero every position would be the same.
    constexpr double SMALLEST = 1e-20;
    const double value = position_scale;
    if (value < SMALLEST && value > -SMALLEST) {
        position_scale = 1.0;
        return 1.0;
    }
    return value;
}

void StepChannel::make_pulses(long period_ns) noexcept {
    pulses.isEnabled = enable;
    pulses.run(period_ns);
    rawcounts = pulses.counts;
    if (pulses.type == STEP_AND_DIR) {
        step = pulses.step;
        dir = pulses.isReverse;
    } else if (pulses.type == UP_AND_DOWN) {
        up = pulses.step && !pulses.isReverse;
        down = pulses.step && pulses.isReverse;
    } else {
        for (int i = 0; i < pulses.pattern.phases; ++i) {
            phase[i] = (pulses.phases >> i & 1) != 0;
        }
    }
}

void StepChannel::capture() noexcept {
    counts = pulses.counts;
    position_fb = pulses.position() / scale();
}

void StepChannel::update(std::int64_t pulse_period_ns, std::int64_t period_ns, bool period_known) noexcept {
    Timing timing{steplen, stepspace, dirsetup, dirhold, dirdelay};
    timing.round_up_to(pulse_period_ns);
    if (period_known) {
        steplen = timing.steplen;
        stepspace = timing.stepspace;
        dirsetup = timing.dirsetup;
        dirhold = timing.dirhold;
        dirdelay = timing.dirdelay;
    }
    pulses.timing = timing;
    Command command;
    command.isEnabled = enable;
    command.is_velocity = is_velocity;
    command.scale = scale();
    command.max_vel = maxvel;
    command.max_accel = maxaccel;
    if (is_velocity) {
        command.velocity = velocity_cmd;
    } else {
        command.position = position_cmd;
    }
    const double highest = highest_frequency(pulses) / (command.scale < 0.0 ? -command.scale : command.scale);
    if (command.max_vel > highest) {
        maxvel = highest;
    }
    control.run(command, pulses, pulse_period_ns, period_ns);
    frequency = control.frequency;
}

struct Stepgen : Channels<StepChannel, MAX_CHANNELS> {
    /// The period of make-pulses is unknown until it has run once.
    static constexpr std::int64_t ASSUMED_PERIOD_NS = 50000;
    std::int64_t pulse_period_ns = 0;

    void declare(Declare &d) noexcept {
        d.function<&Stepgen::make_pulses>(this, "make-pulses");
        d.function<&Stepgen::update_freq>(this, "update-freq");
        d.function<&Stepgen::capture_position>(this, "capture-position");
    }

    void make_pulses(long period_ns) noexcept {
        // If the period were shorter than assumed, the first rate would be too high.
        const bool too_fast = pulse_period_ns == 0 && period_ns < ASSUMED_PERIOD_NS;
        for (int i = 0; i < count && too_fast; ++i) {
            channel[i]->pulses.rate = channel[i]->pulses.rate * period_ns / ASSUMED_PERIOD_NS;
        }
        pulse_period_ns = period_ns;
        for (int i = 0; i < count; ++i) {
            channel[i]->make_pulses(period_ns);
        }
    }

    void update_freq(long period_ns) noexcept {
        const bool known = pulse_period_ns > 0;
        for (int i = 0; i < count; ++i) {
            channel[i]->update(known ? pulse_period_ns : ASSUMED_PERIOD_NS,
                               known ? period_ns : ASSUMED_PERIOD_NS, known);
        }
    }

    void capture_position() noexcept {
        for (int i = 0; i < count; ++i) {
            channel[i]->capture();
        }
    }
};

/// The pattern of user_step_type=; empty when it is not given.
static Pattern user_pattern() noexcept {
    Pattern pattern;
    while (pattern.length < MAX_STATES && user_step_type[pattern.length] >= 0) {
        pattern.states[static_cast<std::size_t>(pattern.length)] =
            static_cast<std::uint8_t>(user_step_type[pattern.length] & 0x1f);
        ++pattern.length;
    }
    pattern.phases = pattern.length > 0 ? MAX_PHASES : 0;
    return pattern;
}

/// Sets step type and control type of channel `i`. Returns 0, or a negated errno with a message in the log.
static int configure(StepChannel &channel, int i) noexcept {
    const int type = step_type[i];
    if (type > USER_TYPE) {
        rtapi_print_msg(RTAPI_MSG_ERR, "stepgen: step_type %d of channel %d is not 0 to 15", type, i);
        return -EINVAL;
    }
    channel.pulses.type = type;
    if (type >= FIRST_STATE_TYPE) {
        channel.pulses.pattern = type == USER_TYPE ? user_pattern() : pattern_of(type);
        if (channel.pulses.pattern.length == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "stepgen: channel %d has step_type 15, but user_step_type= is missing", i);
            return -EINVAL;
        }
    }
    const char control = ctrl_type[i] == nullptr ? 'p' : static_cast<char>(ctrl_type[i][0] | 0x20);
    if (control != 'p' && control != 'v') {
        rtapi_print_msg(RTAPI_MSG_ERR, "stepgen: ctrl_type '%s' of channel %d is neither p nor v",
                        ctrl_type[i], i);
        return -EINVAL;
    }
    channel.is_velocity = control == 'v';
    return 0;
}

static int make_step_channel(Stepgen &all, int comp_id, int i) noexcept {
    StepChannel *channel = make<StepChannel>();
    if (channel == nullptr) {
        return -ENOMEM;
    }
    const int status = configure(*channel, i);
    if (status < 0) {
        return status;
    }
    Name prefix;
    rtapi_snprintf(prefix.text, sizeof prefix.text, "stepgen.%d", i);
    Declare declare(comp_id, prefix.text, i);
    channel->declare(declare);
    all.channel[i] = channel;
    all.count = i + 1;
    return declare.status();
}

static int load_stepgen() noexcept {
    if (step_type[0] < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "stepgen: no channels; give a step_type= for each, for example step_type=0,0");
        return -EINVAL;
    }
    const int comp_id = hal_init("stepgen");
    if (comp_id < 0) {
        return comp_id;
    }
    Stepgen *all = make<Stepgen>();
    int status = all == nullptr ? -ENOMEM : 0;
    for (int i = 0; i < MAX_CHANNELS && step_type[i] >= 0 && status == 0; ++i) {
        status = make_step_channel(*all, comp_id, i);
    }
    if (status == 0) {
        Declare declare(comp_id, "stepgen", 0);
        all->declare(declare);
        status = declare.status();
    }
    return finish(comp_id, status);
}

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id = mw::components::load_stepgen();
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
