// SPDX-License-Identifier: GPL-2.0-or-later
// The devices connected to the simulated board: motors that follow steps or PWM, encoders on their shafts,
// switches.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/board/hand_panel.hh"
#include "drivers/mesa/board/modules/encoder.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa::board {

enum class MotorType : std::uint8_t {
    STEPPER,  ///< follows each step immediately
    PWM,      ///< speed follows the duty with a first-order lag
};

/// A motor of the file.
struct MotorPlan {
    std::string name;
    MotorType type = MotorType::STEPPER;
    unsigned unit = 0;  ///< number of the step generator or of the PWM generator
    std::int64_t steps_per_rev = 200;
    double full_rev_s = 1;       ///< speed at a duty of 1 [rev/s]
    double time_constant_s = 0;  ///< time constant of the lag
    double start_rev = 0;
};

struct EncoderPlan {
    unsigned encoder = 0;
    std::size_t motor = 0;  ///< index of the motor
    std::int64_t counts_per_rev = 4000;
    double index_rev = 0;  ///< position of the index, from 0 to below 1
};

/// A channel of a smart serial port.
struct RemoteChannel {
    unsigned port = 0, channel = 0;

    bool operator==(const RemoteChannel &) const = default;
};

struct SwitchPlan {
    unsigned pin = 0;          ///< pin of the whole board, bit of the field Input of `remote`, or input of
                               ///< InMux
    bool multiplexed = false;  ///< at an input of InMux
    std::optional<RemoteChannel> remote{};
    std::size_t motor = 0;
    double at_rev = 0;
    bool above = false;        ///< closed above `at_rev`; otherwise below it
    bool closed_level = true;  ///< level of the pin while it is closed
};

/// A resolver on the shaft of a motor.
struct ResolverPlan {
    unsigned channel = 0;
    std::size_t motor = 0;
    std::int64_t cycles_per_rev = 1;
    double zero_rev = 0;  ///< position at which its angle is 0
};

/// A smart serial card on a channel.
struct RemotePlan {
    unsigned port = 0, channel = 0;
    std::string card;  ///< key of a RemoteCard
};

/// Value of an input of a smart serial card, as bits of the card.
struct FieldPlan {
    RemoteChannel remote;
    std::string name;                    ///< name of the field in the card
    std::uint32_t value = 0;             ///< value without a motor
    std::optional<std::size_t> motor{};  ///< motor whose counts are the value
    std::int64_t counts_per_rev = 0;
};

struct PhysicsPlan {
    std::vector<MotorPlan> motors;
    std::vector<EncoderPlan> encoders;
    std::vector<SwitchPlan> switches;
    std::vector<ResolverPlan> resolvers;
    std::vector<RemotePlan> remotes;
    std::vector<FieldPlan> fields;
    std::shared_ptr<HandPanel> panel{};  ///< null: none
};

/// Lines `motor NAME stepgen=N steps_per_rev=N [start_rev=]`, `motor NAME pwm=N full_rev_s=
/// time_constant_s=`, `encoder N motor=NAME counts_per_rev=N [index_rev=]`, `switch PIN motor=NAME
/// below_rev=|above_rev= [closed=high|low] [remote=CHANNEL [port=N] | inmux=0]`, `resolver CHANNEL motor=NAME
/// [cycles_per_rev=] [zero_rev=]`, `field CHANNEL name=AnalogIn1 value=N|motor=NAME counts_per_rev=N
/// [port=N]`, `panel FILE` (hand_panel.hh) and `remote CHANNEL card=7i76 [port=N]`; units and pins must exist
/// in `idrom`.
Result<PhysicsPlan> parse_physics(std::string_view text, const std::string &file, const Idrom &idrom);

/// Inputs of the motors in a time step without changes.
struct DriveInputs {
    std::vector<std::int64_t> steps;  ///< steps of each step generator whose pins are driven
    std::vector<double> duties;       ///< duty of each PWM generator whose pins are driven
};

/// The motors at the current time. [one thread]
class Physics {
  public:
    explicit Physics(PhysicsPlan plan);

    using OnMove = std::function<void(unsigned encoder, const ShaftMove &move)>;
    /// Advances the time and reports the movements of the encoder shafts.
    void advance(std::int64_t from_ns, std::int64_t to_ns, const DriveInputs &inputs, const OnMove &on_move);

    /// The shaft of an encoder, if one is connected.
    std::optional<Shaft> shaft(unsigned encoder) const;
    /// The electrical revolutions of a resolver, if one is connected.
    std::optional<double> resolver_rev(unsigned channel) const;
    /// The level of a pin with one or more switches.
    std::optional<bool> switch_level(unsigned pin) const;
    /// The level of any switch.
    bool level_of(const SwitchPlan &one) const;
    /// Value of a field of a smart serial card.
    std::uint32_t field_value(const FieldPlan &field) const;
    /// `levels` of the inputs of InMux, with the levels of the switches connected there.
    std::uint32_t multiplexed_levels(std::uint32_t levels) const;
    /// The position of the motor with that index in the plan [rev].
    double position_rev(std::size_t motor) const;
    /// Whole steps that a stepper has made.
    std::int64_t position_steps(std::size_t motor) const { return motors_[motor].steps; }
    const PhysicsPlan &plan() const { return plan_; }

  private:
    struct Motor {
        std::int64_t steps = 0;
        double rev = 0, rev_s = 0;
    };
    void show_positions();
    std::int64_t count_of(const EncoderPlan &encoder) const;
    void move_motors(double span_s, const DriveInputs &inputs, MotorType type);
    void step(std::int64_t from_ns, std::int64_t to_ns, const DriveInputs &inputs, const OnMove &on_move,
              MotorType type);

    PhysicsPlan plan_;
    std::vector<Motor> motors_;
};

}  // namespace mw::mesa::board
