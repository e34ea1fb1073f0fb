// SPDX-License-Identifier: GPL-2.0-or-later
// steptest: moves an axis back and forth, to find the speed and acceleration that it can reach.
// While `run` (bit) is true `position-cmd` moves between `run-low` and `run-high`, `amplitude` away from
// `run-start`; only to one side with `dir` (s32) 1 (up) or 2 (down). It waits `pause` (s32) [s] at each end
// after `position-fb` is within the parameter `epsilon` (0.001) of `run-target`; at the end it returns to
// run-start. `jog-plus`, `jog-minus` (bit) jog it. All moves use at most `maxvel` and `maxaccel`.
// `running` (bit); the parameter `elapsed` [s] is the time waited. It starts at position-fb. Other pins are
// float.
#include <cmath>

#include "components/machine/follower.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Steptest {
    In<bool> jog_minus, jog_plus, run;
    In<double> maxvel, maxaccel, amplitude;
    In<std::int32_t> dir, pause;
    Out<double> position_cmd;
    In<double> position_fb;
    Out<bool> running;
    Out<double> run_target, run_start, run_low, run_high;
    ParamRw<double> epsilon;
    ParamRo<double> elapsed;
    Follower follower;
    double goal = 0.0;
    bool first = true;
    bool was_jogging = false;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    void start() noexcept;
    void turn_at_ends(double dt) noexcept;
};

void Steptest::declare(Declare &d) noexcept {
    d.pin(jog_minus, "jog-minus");
    d.pin(jog_plus, "jog-plus");
    d.pin(run, "run");
    d.pin(maxvel, "maxvel");
    d.pin(maxaccel, "maxaccel");
    d.pin(amplitude, "amplitude");
    d.pin(dir, "dir");
    d.pin(position_cmd, "position-cmd");
    d.pin(position_fb, "position-fb");
    d.pin(running, "running");
    d.pin(run_target, "run-target");
    d.pin(run_start, "run-start");
    d.pin(run_low, "run-low");
    d.pin(run_high, "run-high");
    d.pin(pause, "pause");
    d.param(epsilon, "epsilon", 0.001);
    d.param(elapsed, "elapsed");
    d.function<&Steptest::update>(this);
}

void Steptest::start() noexcept {
    const double at = follower.position();
    const double size = std::isfinite(amplitude) ? std::fabs(amplitude) : 0.0;
    run_start = at;
    run_low = dir == 1 ? at : at - size;
    run_high = dir == 2 ? at : at + size;
    run_target = dir == 1 ? run_high.get() : run_low.get();
    elapsed = 0.0;
    running = true;
}

void Steptest::turn_at_ends(double dt) noexcept {
    const bool present = !follower.isMoving() && std::fabs(position_fb - run_target) <= std::fabs(epsilon);
    if (!present) {
        elapsed = 0.0;
        return;
    }
    elapsed = elapsed + dt;
    if (elapsed > pause) {
        run_target = run_target == run_low ? run_high.get() : run_low.get();
        elapsed = 0.0;
    }
}

void Steptest::update(long period_ns) noexcept {
    const double dt = seconds(period_ns);
    if (first) {
        const double at = position_fb;
        goal = std::isfinite(at) ? at : 0.0;
        follower.planner.reset(goal);
        first = false;
    }
    const bool was_running = running;
    const bool requested = run;
    if (requested && !was_running) {
        start();
    }
    running = requested;
    const int jog = requested ? 0 : (jog_plus ? 1 : 0) - (jog_minus ? 1 : 0);
    if (requested) {
        turn_at_ends(dt);
        goal = run_target;
    } else if (was_running) {
        goal = run_start;
    } else if (jog != 0) {
        // This is always further than the output can move in one period.
        const double speed = std::fmax(0.0, maxvel);
        const double brake = maxaccel > 0.0 ? speed * speed / maxaccel : 0.0;
        goal = follower.position() + jog * (brake + 2.0 * speed * dt);
        was_jogging = true;
    } else if (was_jogging) {
        was_jogging = false;
        follower.planner.stop();
        goal = follower.planner.target;
    }
    follower.run(goal, maxvel, maxaccel, dt);
    position_cmd = follower.position();
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Steptest, "steptest", mw::sdk::MANY);
