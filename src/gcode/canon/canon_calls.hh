// SPDX-License-Identifier: GPL-2.0-or-later
// The calls of the canonical machine, each declared once. A call is a plain struct in canon_moves.hh or
// canon_actions.hh. NAME is its name in text (rs274 prints it, canterp and scripts use it); a call with two
// directions has NAMES instead, false first, selected by the fields in CHOICES. FIELDS are its arguments in
// text, in order: printing and reading use them unless the printer has a special rule.
// docs/developer/extending/canon_call.md adds a call step by step.
#pragma once

#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/overloaded.hh"
#include "gcode/canon/canon_actions.hh"
#include "gcode/canon/canon_moves.hh"

namespace mw::gcode {

using CanonVariant =
    std::variant<StraightFeed, StraightTraverse, ArcFeed, SetFeedRate, NurbsFeed, StraightProbe, RigidTap,
                 Dwell, StartSpeedFeedSynch, StopSpeedFeedSynch, OnReset, UseLengthUnits, SelectPlane,
                 SetG5xOffset, SetG92Offset, SetXyRotation, UseToolLengthOffset, SetFeedReference,
                 SetFeedMode, SetMotionControlMode, SetNaivecamTolerance, SetPlannerMode, SetSpindleMode,
                 SetSpindleSpeed, StartSpindle, StopSpindle, OrientSpindle, WaitOrientComplete, SelectTool,
                 ChangeTool, ChangeToolNumber, SetToolTableEntry, ReloadTools, SwitchMist, SwitchFlood,
                 SwitchFeedOverride, SwitchSpeedOverride, SwitchFeedHold, SwitchAdaptiveFeed,
                 SetDigitalOutput, SetAnalogOutput, WaitInput, ProgramStop, ProgramEnd, PalletShuttle, Finish,
                 UserCode, ProgramComment, OperatorMessage, PrintLine, OpenLog, LogLine, CloseLog, LogProbes,
                 CanonError>;

/// Any canon call. The variant is closed: a handler must handle each alternative, and the compiler reports a
/// missing one. Its special member functions are compiled once.
class CanonCall : public CanonVariant {
  public:
    using Variant = CanonVariant;
    CanonCall();
    template <AlternativeOf<CanonVariant> Call>
    CanonCall(Call &&call)
        : CanonVariant(std::in_place_type<std::remove_cvref_t<Call>>, std::forward<Call>(call)) {}
    CanonCall(const CanonCall &other);
    CanonCall(CanonCall &&other) noexcept;
    CanonCall &operator=(const CanonCall &other);
    CanonCall &operator=(CanonCall &&other) noexcept;
    ~CanonCall();
};

/// Name of a call in text.
template <class Call>
constexpr std::string_view name_of(const Call &call) {
    if constexpr (requires { Call::CHOICES; }) {
        std::size_t index = 0, place = 1;
        const auto count = [&](auto choice) {
            index += call.*choice ? place : 0;
            place *= 2;
        };
        std::apply([&](auto... choices) { (count(choices), ...); }, Call::CHOICES);
        return Call::NAMES[index];
    } else {
        return Call::NAME;
    }
}

/// A call whose text is generated from its FIELDS.
template <class Call>
concept RegularCall = requires { Call::FIELDS; };

}  // namespace mw::gcode
