// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/expressions/evaluator.hh"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "gcode/interpreter/expressions/degrees.hh"

namespace mw::gcode::detail {
namespace {

constexpr double DEGREE = std::numbers::pi / 180.0;

constexpr double WHOLE_TOLERANCE = 1e-4;
constexpr double EQUAL_TOLERANCE = 1e-4;  // tolerance of EQ and NE

double modulo(double a, double b) {
    const double rest = std::fmod(a, b);
    return rest < 0.0 ? rest + std::fabs(b) : rest;
}

}  // namespace

bool Evaluator::round_number(double index, int &number) {
    const bool in_range = index >= 1.0 - WHOLE_TOLERANCE && index < PARAMETER_COUNT - 0.5;
    if (!in_range || std::fabs(index - std::round(index)) > WHOLE_TOLERANCE) {
        return false;
    }
    number = static_cast<int>(std::lround(index));
    return true;
}

Evaluator::NameClass Evaluator::classify(NameId name) const {
    if (name >= classes_.size()) {
        classes_.resize(names_.size(), NameClass::UNKNOWN);
    }
    NameClass &known = classes_[name];
    if (known == NameClass::UNKNOWN) {
        const std::string &text = names_.text(name);
        const bool shared = !text.empty() && text[0] == '_';
        known = !shared                          ? NameClass::LOCAL
                : built_ins_.isBuiltInName(text) ? NameClass::BUILT_IN
                                                 : NameClass::GLOBAL;
    }
    return known;
}

bool Evaluator::isReadOnly(NameId name) const {
    return classify(name) == NameClass::BUILT_IN;
}

bool Evaluator::isGlobal(NameId name) const {
    return classify(name) != NameClass::LOCAL;
}

std::optional<double> Evaluator::named(NameId name) const {
    const NameClass kind = classify(name);
    if (kind == NameClass::BUILT_IN) {
        return built_ins_.built_in(names_.text(name));
    }
    return parameters_.named(name, kind == NameClass::GLOBAL);
}

bool Evaluator::whole(const Arena &arena, NodeId node, int &out) const {
    double number = 0;
    if (!value(arena, node, number)) {
        return false;
    }
    const double rounded = std::round(number);
    if (std::fabs(number - rounded) > WHOLE_TOLERANCE || std::fabs(number) > 1e9) {
        return fault_.set(fmt::format("{} is not a whole number", number), arena.nodes[node].column);
    }
    out = static_cast<int>(rounded);
    return true;
}

bool Evaluator::value(const Arena &arena, NodeId id, double &out) const {
    const Node &node = arena.nodes[id];
    double inner = 0;
    switch (node.kind) {
    case NodeKind::NUMBER: out = node.value; return true;
    case NodeKind::PARAMETER: return parameter(arena, node, out);
    case NodeKind::NAMED: {
        const std::optional<double> found = named(node.a);
        if (!found && !fault_.message.empty()) {
            fault_.column = node.column;  // a script that calculates the value has failed
            return false;
        }
        if (!found) {
            const std::string &name = names_.text(node.a);
            return fault_.set(fmt::format("Named parameter #<{}> not defined", name), node.column,
                              name.starts_with("_hal[")
                                  ? "there is no such pin, signal or parameter; checks and rs274 run without "
                                    "HAL: use EXISTS before reading it"
                                  : "");
        }
        out = *found;
        return true;
    }
    case NodeKind::NEGATE:
        if (!value(arena, node.a, inner)) {
            return false;
        }
        out = -inner;
        return true;
    case NodeKind::FUNCTION: return function(arena, node, out);
    case NodeKind::ATAN: {
        double x = 0;
        if (!value(arena, node.a, inner) || !value(arena, node.b, x)) {
            return false;
        }
        out = std::atan2(inner, x) / DEGREE;
        return true;
    }
    case NodeKind::BINARY: return binary(arena, node, out);
    case NodeKind::EXISTS_NUMBER:
        if (!value(arena, node.a, inner)) {
            return false;
        }
        out = isNumber(inner) ? 1.0 : 0.0;
        return true;
    case NodeKind::EXISTS_NAME: out = named(node.a) ? 1.0 : 0.0; return true;
    }
    return false;
}

bool Evaluator::parameter(const Arena &arena, const Node &node, double &out) const {
    double index = 0;
    if (!value(arena, node.a, index)) {
        return false;
    }
    int number = 0;
    if (!take_number(index, number)) {
        return refuse_number(index, node.column, fault_);
    }
    out = numbered(number);
    return true;
}

bool Evaluator::refuse_number(double index, std::uint32_t column, Fault &fault) {
    if (std::fabs(index - std::round(index)) > WHOLE_TOLERANCE) {
        return fault.set(fmt::format("{} is not the number of a parameter: it must be whole", index), column);
    }
    return fault.set("Parameter number out of range", column,
                     fmt::format("{} is not in 1..{}", index, PARAMETER_COUNT - 1));
}

bool Evaluator::function(const Arena &arena, const Node &node, double &out) const {
    double x = 0;
    if (!value(arena, node.a, x)) {
        return false;
    }
    switch (static_cast<Function>(node.op)) {
    case Function::ABS: out = std::fabs(x); break;
    case Function::ACOS:
        if (!(x >= -1.0 && x <= 1.0)) {
            return fault_.set("Argument to acos out of range", node.column);
        }
        out = std::acos(x) / DEGREE;
        break;
    case Function::ASIN:
        if (!(x >= -1.0 && x <= 1.0)) {
            return fault_.set("Argument to asin out of range", node.column);
        }
        out = std::asin(x) / DEGREE;
        break;
    case Function::COS: out = cosine_of_degrees(x); break;
    case Function::EXP: out = std::exp(x); break;
    case Function::FIX: out = std::floor(x); break;
    case Function::FUP: out = std::ceil(x); break;
    case Function::LN:
        if (!(x > 0.0)) {
            return fault_.set("Zero or negative argument to ln", node.column);
        }
        out = std::log(x);
        break;
    case Function::ROUND: out = x < 0.0 ? -std::floor(-x + 0.5) : std::floor(x + 0.5); break;
    case Function::SIN: out = sine_of_degrees(x); break;
    case Function::SQRT:
        if (!(x >= 0.0)) {
            return fault_.set("Negative argument to sqrt", node.column);
        }
        out = std::sqrt(x);
        break;
    case Function::TAN: out = tangent_of_degrees(x); break;
    }
    if (!std::isfinite(out)) {
        return fault_.set("The result of this function is not a finite number", node.column);
    }
    return true;
}

bool Evaluator::binary(const Arena &arena, const Node &node, double &out) const {
    double a = 0, b = 0;
    if (!value(arena, node.a, a) || !value(arena, node.b, b)) {
        return false;
    }
    switch (static_cast<Operator>(node.op)) {
    case Operator::POWER:
        if (a < 0.0 && b != std::floor(b)) {
            return fault_.set("Attempt to raise negative to non integer power", node.column);
        }
        out = std::pow(a, b);
        break;
    case Operator::TIMES: out = a * b; break;
    case Operator::DIVIDE:
        if (b == 0.0) {
            return fault_.set("Attempt to divide by zero", node.column);
        }
        out = a / b;
        break;
    case Operator::MODULO: out = modulo(a, b); break;
    case Operator::PLUS: out = a + b; break;
    case Operator::MINUS: out = a - b; break;
    case Operator::EQ: out = std::fabs(a - b) < EQUAL_TOLERANCE ? 1.0 : 0.0; break;
    case Operator::NE: out = std::fabs(a - b) >= EQUAL_TOLERANCE ? 1.0 : 0.0; break;
    case Operator::GT: out = a > b ? 1.0 : 0.0; break;
    case Operator::GE: out = a >= b ? 1.0 : 0.0; break;
    case Operator::LT: out = a < b ? 1.0 : 0.0; break;
    case Operator::LE: out = a <= b ? 1.0 : 0.0; break;
    case Operator::AND: out = a != 0.0 && b != 0.0 ? 1.0 : 0.0; break;
    case Operator::OR: out = a != 0.0 || b != 0.0 ? 1.0 : 0.0; break;
    case Operator::XOR: out = (a != 0.0) != (b != 0.0) ? 1.0 : 0.0; break;
    }
    if (!std::isfinite(out)) {
        return fault_.set("The result of this operation is not a finite number", node.column);
    }
    return true;
}

}  // namespace mw::gcode::detail
