// SPDX-License-Identifier: GPL-2.0-or-later
// pid: PID controllers with feed-forward and auto-tuning, up to 16 (`num_chan=`, 3 by default, or `names=`).
//
// Built as at_pid too (PID_MODULE). Function pid.N.do-pid-calcs. Inputs: command, feedback [units], enable
// (bit), command-deriv and feedback-deriv [units/s] (estimated while not linked), error-previous-target (bit,
// true at start: compare with the command of the period before), index-enable (bit: its falling edge
// announces a jump of positions). Outputs: error, output, saturated (bit), saturated-s [s], saturated-count
// [periods]. Tuning (inputs): Pgain (1 at start), Igain, Dgain, FF0 to FF3, bias, deadband, maxoutput,
// maxerror, maxerrorI, maxerrorD, maxcmdD, maxcmdDD, maxcmdDDD (0: no limit). Auto-tuning: tune-mode (bit)
// opens the loop, tune-start (bit, I/O) begins and is set back at the end; tune-type 0 finds P, I, D and 1
// finds P, I, FF1; tune-cycles, tune-effort. `debug=1` adds pins with the inner values.
// While command, feedback or a linked derivative is not a number the controller counts as disabled.
#include <cmath>

#include "components/pid/pid_core.hh"
#include "hal/sdk/component.hh"

static int debug = 0;
RTAPI_MP_INT(debug, "1: export inner values as pins");

namespace mw::components {
using namespace sdk;

/// A float input that knows whether it is linked: while it is not linked, its slot points at its own value.
struct LinkableInput {
    volatile double *slot = nullptr;
    const volatile double *own = nullptr;

    void declare(Declare &d, const char *name) noexcept {
        Name full;
        rtapi_snprintf(full.text, sizeof full.text, "%s.%s", d.prefix(), name);
        void **address = reinterpret_cast<void **>(const_cast<double **>(&slot));
        d.keep(hal_pin_new(full.text, HAL_FLOAT, HAL_IN, address, d.comp_id()));
        own = slot;
    }
    bool isLinked() const noexcept { return slot != own; }
    /// 0 while it is not linked.
    double get() const noexcept { return isLinked() ? *slot : 0.0; }
};

/// The additional pins of debug=1.
struct InnerPins {
    Out<double> error_i, error_d, command_d, command_dd, command_ddd, ultimate_gain, ultimate_period;

    void declare(Declare &declare) noexcept {
        declare.legacy_pin(error_i, "error-i", "errorI");
        declare.legacy_pin(error_d, "error-d", "errorD");
        declare.legacy_pin(command_d, "command-d", "commandD");
        declare.legacy_pin(command_dd, "command-dd", "commandDD");
        declare.legacy_pin(command_ddd, "command-ddd", "commandDDD");
        declare.pin(ultimate_gain, "ultimate-gain");
        declare.pin(ultimate_period, "ultimate-period");
    }
    void show(const pid::Controller &controller) noexcept {
        error_i = controller.error_i;
        error_d = controller.error_d;
        command_d = controller.command_d;
        command_dd = controller.command_dd;
        command_ddd = controller.command_ddd;
    }
};

struct Pid {
    In<double> command, feedback;
    LinkableInput command_deriv, feedback_deriv;
    In<bool> enable, error_previous_target, index_enable, tune_mode;
    Out<double> error, output, saturated_s;
    Out<bool> saturated;
    Out<std::int32_t> saturated_count;
    In<double> p, i, d, ff0, ff1, ff2, ff3, bias, deadband;
    In<double> max_output, max_error, max_error_i, max_error_d, max_cmd_d, max_cmd_dd, max_cmd_ddd;
    InOut<bool> tune_start;
    InOut<std::uint32_t> tune_type, tune_cycles;
    InOut<double> tune_effort;
    InnerPins inner;

    pid::Controller controller;
    double last_command = 0.0;
    double last_feedback = 0.0;
    pid::Tuner tuner;

    void declare(Declare &declare) noexcept;
    void update(long period_ns) noexcept;

  private:
    void declare_tuning(Declare &declare) noexcept;
    pid::Tuning tuning() const noexcept;
    void tune(double dt) noexcept;
};

void Pid::declare(Declare &declare) noexcept {
    declare.pin(command, "command");
    declare.pin(feedback, "feedback");
    command_deriv.declare(declare, "command-deriv");
    feedback_deriv.declare(declare, "feedback-deriv");
    declare.pin(enable, "enable");
    declare.pin(error_previous_target, "error-previous-target", true);
    declare.pin(index_enable, "index-enable");
    declare.pin(error, "error");
    declare.pin(output, "output");
    declare.pin(saturated, "saturated");
    declare.pin(saturated_s, "saturated-s");
    declare.pin(saturated_count, "saturated-count");
    declare_tuning(declare);
    if (debug != 0) {
        inner.declare(declare);
    }
    declare.function<&Pid::update>(this, "do-pid-calcs");
}

void Pid::declare_tuning(Declare &declare) noexcept {
    declare.legacy_pin(p, "p-gain", "Pgain", 1.0);
    declare.legacy_pin(i, "i-gain", "Igain");
    declare.legacy_pin(d, "d-gain", "Dgain");
    declare.legacy_pin(ff0, "ff0", "FF0");
    declare.legacy_pin(ff1, "ff1", "FF1");
    declare.legacy_pin(ff2, "ff2", "FF2");
    declare.legacy_pin(ff3, "ff3", "FF3");
    declare.pin(bias, "bias");
    declare.pin(deadband, "deadband");
    declare.pin(max_output, "maxoutput");
    declare.pin(max_error, "maxerror");
    declare.legacy_pin(max_error_i, "maxerror-i", "maxerrorI");
    declare.legacy_pin(max_error_d, "maxerror-d", "maxerrorD");
    declare.legacy_pin(max_cmd_d, "maxcmd-d", "maxcmdD");
    declare.legacy_pin(max_cmd_dd, "maxcmd-dd", "maxcmdDD");
    declare.legacy_pin(max_cmd_ddd, "maxcmd-ddd", "maxcmdDDD");
    declare.pin(tune_mode, "tune-mode");
    declare.pin(tune_start, "tune-start");
    declare.pin(tune_type, "tune-type");
    declare.pin(tune_cycles, "tune-cycles", 50U);
    declare.pin(tune_effort, "tune-effort", 0.5);
}

pid::Tuning Pid::tuning() const noexcept {
    pid::Tuning result;
    result.p = p;
    result.i = i;
    result.d = d;
    result.ff0 = ff0;
    result.ff1 = ff1;
    result.ff2 = ff2;
    result.ff3 = ff3;
    result.bias = bias;
    result.deadband = deadband;
    result.max_error = max_error;
    result.max_error_i = max_error_i;
    result.max_error_d = max_error_d;
    result.max_command_d = max_cmd_d;
    result.max_command_dd = max_cmd_dd;
    result.max_command_ddd = max_cmd_ddd;
    result.max_output = max_output;
    return result;
}

/// One period in tune-mode: the controller is off, and the relay oscillates while tuning.
void Pid::tune(double dt) noexcept {
    const double difference = command - feedback;
    error = difference;
    controller.reset();
    if (tune_start && !tuner.isRunning()) {
        tuner.start();
    }
    if (!tuner.isRunning()) {
        output = bias.get();
        return;
    }
    pid::Tuning found = tuning();
    output = tuner.run(difference, {tune_effort, tune_cycles, tune_type, bias}, found, dt);
    if (!tuner.isRunning()) {
        tune_start = false;
        p = found.p;
        i = found.i;
        d = found.d;
        ff1 = found.ff1;
        if (debug != 0) {
            inner.ultimate_gain = tuner.ultimate_gain;
            inner.ultimate_period = tuner.ultimate_period;
        }
    }
}

void Pid::update(long period_ns) noexcept {
    const double dt = static_cast<double>(period_ns) * 1e-9;
    if (enable && tune_mode) {
        tune(dt);
        return;
    }
    if (tuner.isRunning()) {
        tuner = pid::Tuner{};
        tune_start = false;
    }
    pid::Inputs in;
    const double wanted = command;
    const double measured = feedback;
    // The values of a broken sensor must not affect the motor or remain in the integrator.
    const double command_derivative = command_deriv.get();
    const double feedback_derivative = feedback_deriv.get();
    const bool sane = std::isfinite(wanted) && std::isfinite(measured) && std::isfinite(command_derivative) &&
                      std::isfinite(feedback_derivative);
    last_command = std::isfinite(wanted) ? wanted : last_command;
    last_feedback = std::isfinite(measured) ? measured : last_feedback;
    in.isEnabled = enable && sane;
    in.command = last_command;
    in.feedback = last_feedback;
    in.has_command_derivative = command_deriv.isLinked() && sane;
    in.command_derivative = command_derivative;
    in.has_feedback_derivative = feedback_deriv.isLinked() && sane;
    in.feedback_derivative = feedback_derivative;
    in.usesPreviousTarget = error_previous_target;
    in.isIndexEnabled = index_enable;
    const pid::Outputs out = controller.run(in, tuning(), dt);
    error = out.error;
    output = out.output;
    saturated = out.saturated;
    saturated_s = out.saturated_s;
    saturated_count = out.saturated_count;
    if (debug != 0) {
        inner.show(controller);
    }
    if (!sane) {
        controller.reset();
    }
}

/// at_pid is another name for the module; the pins are those of pid.
static int load_pids(Request request) noexcept {
    request.prefix = "pid";
    return load_instances<Pid>(request);
}

}  // namespace mw::components

MW_MODULE(PID_MODULE, num_chan, 3, mw::pid::MAX_CHANNELS, mw::components::load_pids);
