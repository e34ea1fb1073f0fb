// SPDX-License-Identifier: GPL-2.0-or-later
// Values of expressions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/ast.hh"
#include "gcode/syntax/fault.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// Parameters of the interpreter itself: modes, positions, INI and HAL values.
class BuiltIns {
  public:
    virtual ~BuiltIns() = default;
    virtual bool isBuiltInName(std::string_view name) const = 0;
    /// Nothing when the parameter has no value (an INI key that does not exist).
    virtual std::optional<double> built_in(std::string_view name) const = 0;
    /// #5400 to #5428.
    virtual double built_in(int number) const = 0;
};

class Evaluator {
  public:
    Evaluator(Parameters &parameters, Names &names, const BuiltIns &built_ins, Fault &fault)
        : parameters_(parameters), names_(names), built_ins_(built_ins), fault_(fault) {}

    /// False after setting the fault.
    bool value(const Arena &arena, NodeId node, double &out) const;
    /// A value that must be a whole number (within 1e-4).
    bool whole(const Arena &arena, NodeId node, int &out) const;

    std::optional<double> named(NameId name) const;
    bool isReadOnly(NameId name) const;
    bool isGlobal(NameId name) const;
    /// True if the number is in the range of readable parameters.
    static bool isNumber(double index) {
        int number = 0;
        return take_number(index, number);
    }
    /// The number of the parameter `index`; false unless isNumber().
    static bool take_number(double index, int &number) {
        // Most values are whole numbers and need no rounding.
        constexpr double MOST = PARAMETER_COUNT - 1;
        if (index >= 1.0 && index <= MOST) {
            number = static_cast<int>(index);
            if (number == index) {
                return true;
            }
        }
        return round_number(index, number);
    }
    /// Sets the fault with the reason why take_number() was false, and returns false.
    static bool refuse_number(double index, std::uint32_t column, Fault &fault);
    double numbered(int number) const {
        return isBuiltInNumber(number) ? built_ins_.built_in(number) : parameters_.get(number);
    }

  private:
    enum class NameClass : std::uint8_t { UNKNOWN, LOCAL, GLOBAL, BUILT_IN };
    static bool round_number(double index, int &number);
    NameClass classify(NameId name) const;
    bool parameter(const Arena &arena, const Node &node, double &out) const;
    bool function(const Arena &arena, const Node &node, double &out) const;
    bool binary(const Arena &arena, const Node &node, double &out) const;

    Parameters &parameters_;
    Names &names_;
    const BuiltIns &built_ins_;
    Fault &fault_;
    mutable std::vector<NameClass> classes_;
};

}  // namespace mw::gcode::detail
