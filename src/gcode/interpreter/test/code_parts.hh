// SPDX-License-Identifier: GPL-2.0-or-later
// The objects that codes use, without an interpreter.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gcode/canon/call_text.hh"
#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/test/mill.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::test {

/// A block with these words.
inline detail::BlockValues block(std::initializer_list<std::pair<char, double>> words) {
    detail::BlockValues values;
    for (const auto &[name, value] : words) {
        const auto index = static_cast<std::size_t>(detail::BlockValues::index(name));
        values.present |= detail::bit_of(detail::BlockValues::index(name));
        values.value[index] = value;
        values.column[index] = 1;
    }
    return values;
}

/// Records calls as text.
class CallTexts final : public Canon {
  public:
    std::vector<std::string> texts;

    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &call) override {
        std::visit(
            [this]<class Call>(const Call &one) {
                std::string text;
                if constexpr (RegularCall<Call>) {
                    append_call(text, one);
                } else {
                    text = name_of(one);
                }
                texts.push_back(std::move(text));
            },
            call);
    }
};

struct CodeParts {
    Mill mill;
    Settings settings;
    detail::Machine machine{mill, settings};
    detail::ToolTable tools{mill};
    detail::Parameters parameters;
    detail::Awaited awaited;
    std::vector<NurbsPoint> points;
    detail::State state;
    detail::CanonQueue canon;
    detail::Fault fault;
    detail::Outcome outcome = detail::Outcome::OK;

    /// The queued calls, in order.
    std::vector<std::string> calls() {
        CallTexts out;
        canon.flush(out);
        return out.texts;
    }
};

using Calls = std::vector<std::string>;

/// The row of a code in the table.
inline const detail::Code &code(char letter, int number) {
    return *detail::find_code(letter, number);
}

}  // namespace mw::gcode::test
