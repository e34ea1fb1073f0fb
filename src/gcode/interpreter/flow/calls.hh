// SPDX-License-Identifier: GPL-2.0-or-later
// Subroutines: O- sub, call and return, M98 and M99, and the profiles of lathe cycles. All functions return
// false after setting the fault.
#pragma once

#include <array>
#include <vector>

#include "gcode/interpreter/flow/flow_parts.hh"

namespace mw::gcode::detail {

/// An O- call with computed values.
struct CallRequest {
    NameId label = NO_ID;
    std::uint32_t column = 0, count = 0;
    std::array<double, ARGUMENT_COUNT> few{};  ///< missing arguments are 0
    std::vector<double> many;                  ///< all arguments when there are more

    /// The span has at least ARGUMENT_COUNT arguments.
    std::span<double> arguments() { return many.empty() ? std::span<double>(few) : std::span<double>(many); }
    std::span<const double> arguments() const {
        return many.empty() ? std::span<const double>(few) : std::span<const double>(many);
    }
};
bool compute_call(const BlockView &view, const OWord &oword, const FlowParts &parts, CallRequest &out);
bool call_sub(const CallRequest &request, const FlowParts &parts);
/// Skips a definition that the program reaches line by line; a definition inside a running subroutine is an
/// error.
bool pass_definition(const OWord &oword, const FlowParts &parts);
/// The value of an O- return or endsub.
bool compute_return(const BlockView &view, const OWord &oword, const FlowParts &parts, ReturnValue &out);
/// A label without a keyword: a subroutine for M98.
bool pass_fanuc_label(const OWord &oword, const FlowParts &parts);

/// Enters a call level: a subroutine, or a script when `sub` is none.
bool enter_call(Call &&call, const Sub &sub, const FlowParts &parts);
/// Returns to the caller: the line after the call, or the rest of the block with the remapped code.
bool leave_call(const ReturnValue &value, const FlowParts &parts);

bool call_fanuc(const FlowParts &parts);
/// M99 in a subroutine: `turn` is set when M98 requires more calls; otherwise the call ends.
bool return_fanuc(const FlowParts &parts, LoopTurn &turn);
/// G70 to G72: reads the profile from a subroutine, then cuts it.
bool call_profile(const FlowParts &parts);

}  // namespace mw::gcode::detail
