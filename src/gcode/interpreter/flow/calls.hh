// SPDX-License-Identifier: GPL-2.0-or-later
// Subroutines: O- sub, call and return, M98 and M99, and those with the profile of a lathe cycle. All return
// false after setting the fault.
#pragma once

#include <array>
#include <vector>

#include "gcode/interpreter/flow/flow_parts.hh"

namespace mw::gcode::detail {

/// An O- call with its values computed.
struct CallRequest {
    NameId label = NO_ID;
    std::uint32_t column = 0, count = 0;
    std::array<double, ARGUMENT_COUNT> few{};  ///< those not given are 0
    std::vector<double> many;                  ///< all of them when they are more

    /// At least ARGUMENT_COUNT of them.
    std::span<double> arguments() { return many.empty() ? std::span<double>(few) : std::span<double>(many); }
    std::span<const double> arguments() const {
        return many.empty() ? std::span<const double>(few) : std::span<const double>(many);
    }
};
bool compute_call(const BlockView &view, const OWord &oword, const FlowParts &parts, CallRequest &out);
bool call_sub(const CallRequest &request, const FlowParts &parts);
/// A definition met from above is passed over; one inside of a subroutine that runs is none.
bool pass_definition(const OWord &oword, const FlowParts &parts);
/// What an O- return or endsub gives back.
bool compute_return(const BlockView &view, const OWord &oword, const FlowParts &parts, ReturnValue &out);
/// A label alone: of a subroutine for M98.
bool pass_fanuc_label(const OWord &oword, const FlowParts &parts);

/// One level more: a subroutine, or a script when `sub` is none.
bool enter_call(Call &&call, const Sub &sub, const FlowParts &parts);
/// Back to the caller: the line after the call, or the rest of the block with the remapped code.
bool leave_call(const ReturnValue &value, const FlowParts &parts);

bool call_fanuc(const FlowParts &parts);
/// M99 in a subroutine: `turn` is set when M98 has asked for more calls, else the call is over.
bool return_fanuc(const FlowParts &parts, LoopTurn &turn);
/// G70 to G72 read their profile from a subroutine, then cut it.
bool call_profile(const FlowParts &parts);

}  // namespace mw::gcode::detail
