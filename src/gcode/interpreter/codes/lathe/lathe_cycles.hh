// SPDX-License-Identifier: GPL-2.0-or-later
// G70 (finishing), G71 and G72 (roughing along Z and along X) and their variants for pockets. The profile is
// a subroutine of which only the moves count; it is read as a call, then cut.
#pragma once

#include <optional>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_parts.hh"
#include "gcode/interpreter/codes/lathe/lathe_layers.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// The cycle whose profile is being read, and the last roughing cycle.
class LatheCycles {
  public:
    /// Begins to read the profile from the following blocks.
    void open(LatheRequest request) { request_ = std::move(request); }
    const LatheRequest *request() const { return request_ ? &*request_ : nullptr; }
    /// Records the move of a block of the profile's subroutine, if it has one. False after setting the fault.
    bool record(const BlockValues &values, const Settings &settings, const State &state);
    /// The profile is complete: cuts it. False after setting the fault.
    bool finish(State &state, CanonQueue &canon, Fault &fault);
    /// Discards the profile.
    void drop() { request_.reset(); }
    /// Called at the end of the program: a later G70 does not use the last roughing.
    void forget_roughing() { roughed_.reset(); }

  private:
    /// The last roughing cycle of the program, for the G70 that follows it.
    struct Roughed {
        int label = 0;  ///< label of the profile's subroutine
        bool isFacing = false;
    };
    bool record_arc(const BlockValues &values, const Settings &settings, const State &state, const Pose &from,
                    const Pose &end);
    bool take_corner_word(const BlockValues &values);
    bool cut(const LatheRequest &request, State &state, CanonQueue &canon, Fault &fault);

    std::optional<LatheRequest> request_;
    std::optional<Roughed> roughed_;
};

}  // namespace mw::gcode::detail
