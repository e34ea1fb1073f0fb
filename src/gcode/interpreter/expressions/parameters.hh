// SPDX-License-Identifier: GPL-2.0-or-later
// Numbered and named parameters, with an undo log so that a failed block changes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

inline constexpr int PARAMETER_COUNT = 5603;  ///< numbers are 1 to 5602
inline constexpr int ARGUMENT_COUNT = 30;     ///< #1 to #30 belong to the subroutine

/// Numbers of parameters with a meaning. Lengths are in machine units unless stated.
enum ParameterNumber : int {
    P_PROBE_RESULT = 5061,  // nine, program units
    P_PROBE_SUCCESS = 5070,
    P_G28 = 5161,  // nine
    P_G30 = 5181,
    P_G92_APPLIED = 5210,
    P_G92 = 5211,
    P_COORDINATE_SYSTEM = 5220,
    P_G5X = 5221,  // nine systems, twenty apart: nine axes and the rotation
    P_INPUT_RESULT = 5399,
    P_TOOL_NUMBER = 5400,
    P_MACHINE_POSITION = 5021,  // nine, program units, read only
    P_TOOL_OFFSET = 5401,       // nine, of the loaded tool's table entry
    P_TOOL_DIAMETER = 5410,
    P_TOOL_FRONTANGLE = 5411,
    P_TOOL_BACKANGLE = 5412,
    P_TOOL_ORIENTATION = 5413,
    P_POSITION = 5420,     // nine, program units
    P_BUILD_FIRST = 5400,  // 5400 to 5428 are read only
    P_BUILD_LAST = 5428,
    P_DEBUG_SHOWN = 5599,        // 0: (debug,...) prints nothing
    P_TOOL_FAULT = 5600,         // 1 after the changer has reported a fault
    P_TOOL_FAULT_REASON = 5601,  // pin toolchanger-reason of the changer
    P_VAR_FIRST = 31,            // first number stored in the parameter file
};

/// Parameters that the interpreter itself computes.
constexpr bool isBuiltInNumber(int number) {
    constexpr int AXIS_NUMBERS = 9;
    return (number >= P_BUILD_FIRST && number <= P_BUILD_LAST) ||
           (number >= P_MACHINE_POSITION && number < P_MACHINE_POSITION + AXIS_NUMBERS);
}

/// One change of parameters, so that it can be repeated on another set. An undo is also a change.
struct ParameterChange {
    enum class Kind : std::uint8_t {
        NUMBER,         ///< `number` becomes `value`
        GLOBAL,         ///< `id` becomes `value`
        LOCAL,          ///< `id` of the innermost call becomes `value`
        FORGET_GLOBAL,  ///< `id` has no value
        FORGET_LOCAL,
        FORGET_NAMES,
        PUSH_CALL,
        KEEP_ASIDE,  ///< saves #31 up to `number`
        POP_CALL,
        POP_SHARING_CALL,
    };
    Kind kind = Kind::NUMBER;
    int number = 0;
    NameId id = NO_ID;
    double value = 0;
};

class Parameters {
    struct Named {
        NameId id = NO_ID;
        double value = 0;

        bool operator==(const Named &) const = default;
    };

  public:
    Parameters();

    /// Everything that the current subroutine can read.
    struct Values {
        std::vector<double> numbers;
        std::vector<std::optional<double>> globals;
        std::vector<Named> locals;
    };
    Values values() const { return {values_, globals_, frames_.back().locals}; }
    bool hasValues(const Values &values) const {
        return values.numbers == values_ && values.globals == globals_ &&
               values.locals == frames_.back().locals;
    }

    double get(int number) const { return values_[static_cast<std::size_t>(number)]; }
    /// Sets the value; keeps the old one until commit().
    void set(int number, double value);

    /// Named parameters: global (first character _) or of the innermost call.
    std::optional<double> named(NameId id, bool global) const;
    void set_named(NameId id, bool global, double value);

    /// Removes global names and names of the main program.
    void forget_names();

    void push_call();  ///< Begins a call: new local names; saves #1 to #30.
    /// Sets the new call's parameters from #1 on. rollback() does not undo this.
    void set_arguments(std::span<const double> given);
    /// For the new call: also saves #31 to #count.
    void keep_aside(std::size_t count);
    /// Restores the caller's values. #1 to #30 are also restored unless `sharing` is true.
    void pop_call(bool sharing);
    int depth() const { return static_cast<int>(depth_); }
    /// Names and values of a call level (0: the main program), and of all globals.
    std::vector<std::pair<NameId, double>> locals(int level) const;
    std::vector<std::pair<NameId, double>> globals() const;
    /// #1 to #30 of the caller of a level.
    std::array<double, ARGUMENT_COUNT> saved_arguments(int level) const;

    void commit() { log_.clear(); }
    void rollback();

    /// Records changes from now on, for take_changes().
    void record_changes(bool recorded) {
        recorded_ = recorded;
        changes_.clear();
    }
    /// Appends the changes since the last call to `changes`, in order.
    void take_changes(std::vector<ParameterChange> &changes);
    /// Applies a change of another set of parameters. Cannot be rolled back.
    void apply(const ParameterChange &change);

    Result<> load(const std::string &path);
    /// Parses a text in memory; `path` names it in errors. An error changes nothing.
    Result<> parse(std::string_view text, const std::string &path);
    /// Text of the parameter file: the required numbers, and all others that the file contained.
    std::string text() const;
    Result<> save(const std::string &path) const;

  private:
    struct Frame {
        std::vector<Named> locals;
        double arguments[ARGUMENT_COUNT] = {};
        std::vector<double> more;  ///< the caller's parameters from #31 on, for calls with more arguments
    };
    struct Undo {
        enum class Kind { NUMBER, GLOBAL, LOCAL } kind = Kind::NUMBER;
        int number = 0;
        NameId id = NO_ID;
        std::optional<double> old;
    };

    std::vector<double> values_;
    std::vector<std::optional<double>> globals_;  ///< values by NameId
    std::vector<Frame> frames_;                   ///< frames above depth_ keep their memory for the next call
    std::size_t depth_ = 1;
    void record(const ParameterChange &change) {
        if (recorded_) {
            changes_.push_back(change);
        }
    }
    void forget_local(NameId id);

    std::vector<Undo> log_;
    bool recorded_ = false;
    std::vector<ParameterChange> changes_;
    std::vector<int> file_numbers_;  ///< numbers that the parameter file contained
};

}  // namespace mw::gcode::detail
