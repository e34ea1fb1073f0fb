// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/record.hh"

#include <array>
#include <string_view>

namespace mw::commissioning {
namespace {

struct Text {
    Fault fault;
    std::string_view name, remedy;
};

constexpr std::array TEXTS{
    Text{Fault::NONE, "no fault", ""},
    Text{
        Fault::MOTOR_NOT_CONNECTED, "motor not connected",
        "Check the power of the drive, its enable input, and the wires of step and direction or of the speed "
        "command."},
    Text{Fault::ENCODER_NOT_CONNECTED, "encoder not connected",
         "The motor moved and the encoder did not count. Check its supply, its plug and its channel."},
    Text{Fault::ENCODER_PHASES_SWAPPED, "encoder phases swapped",
         "The encoder counts against its motor: the control loop would run away. Swap A and B at the "
         "encoder."},
    Text{Fault::SWITCH_NOT_CONNECTED, "switch not connected",
         "The input did not change. Check the wire, the common terminal and the number of the input."},
    Text{Fault::SWITCH_AT_OTHER_INPUT, "switch at another input",
         "Another input changed. Exchange the wires, or change the answer about the input."},
    Text{Fault::SWITCH_NOT_REACHED, "home switch not reached",
         "The axis moved and the switch was not actuated. Check the trip dog and the end with the switch."},
    Text{Fault::SWITCH_NOT_REPEATABLE, "home switch not repeatable",
         "Homing again gave another position. Check the switch, its mount, and lost steps."},
    Text{Fault::ESTOP_NOT_CONNECTED, "emergency stop not connected",
         "The input did not change. Do not continue before the emergency stop works."},
    Text{Fault::ESTOP_NORMALLY_OPEN, "emergency stop wired normally open",
         "A broken wire would go unnoticed. Use the contact that is closed while the button is released."},
    Text{Fault::NOISE, "noise on an input",
         "The input changed while nothing was touched. Use shielded wires away from motor wires, a common "
         "ground, "
         "and a filter."},
    Text{Fault::LATE_THREAD, "late thread",
         "The servo thread was late. `millwright doctor --latency 600` shows the causes."},
    Text{Fault::STALLED, "motor stalls",
         "Steps are lost at the minimum speed as well. Check current, voltage and friction."},
    Text{Fault::DRIVE, "drive fault", "Read the fault code of the drive."},
    Text{Fault::SCALE, "scale not confirmed",
         "The measured travel differs from the commanded travel after the correction. Measure again; check "
         "coupling "
         "and belt."},
    Text{Fault::SPINDLE, "spindle speed not confirmed",
         "The measured speed differs from the commanded speed after the correction. Check the speed output."},
    Text{Fault::PROBE_NOT_CONNECTED, "probe not connected",
         "The input did not change. Check the wire of the probe."},
    Text{Fault::NOT_TUNED, "not tuned", "The following error did not improve, or the loop has no margin."},
    Text{Fault::VALUE, "value not accepted",
         "The measured value does not fit the other values of the machine. Measure again."},
    Text{Fault::GIVEN_UP, "step not done", "Repeat the step when the machine is ready for it."},
    Text{Fault::STOPPED, "machine stopped",
         "Read the message of the machine, remove the cause, repeat the step."},
};

const Text &text_of(Fault fault) {
    for (const Text &text : TEXTS) {
        if (text.fault == fault) {
            return text;
        }
    }
    return TEXTS[0];
}

}  // namespace

std::string_view fault_name(Fault fault) {
    return text_of(fault).name;
}

std::string_view fault_remedy(Fault fault) {
    return text_of(fault).remedy;
}

}  // namespace mw::commissioning
