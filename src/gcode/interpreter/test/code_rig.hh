// SPDX-License-Identifier: GPL-2.0-or-later
// The objects that codes use, without an interpreter.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gcode/canon/call_text.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"
#include "gcode/interpreter/codes/saved_modes.hh"
#include "gcode/interpreter/test/mill.hh"

namespace mw::gcode::test {

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

using Calls = std::vector<std::string>;
using Words = std::initializer_list<std::pair<char, double>>;

struct CodeRig {
    Mill mill;
    Settings settings;
    detail::BlockPlace place;
    detail::CanonQueue canon;
    detail::Parameters parameters;
    detail::ToolTable tools{mill};
    detail::SavedModes saved_modes;
    detail::LatheCycles lathe;
    std::vector<NurbsPoint> points;
    detail::Awaited awaited;
    detail::FanucCall fanuc_call;
    detail::CodeParts parts{mill,        settings, place,  canon,   parameters, tools,
                            saved_modes, lathe,    points, awaited, fanuc_call};
    detail::State state;
    detail::Fault fault;
    detail::Outcome outcome = detail::Outcome::OK;  ///< outcome of the last code

    /// A block with these words.
    detail::BlockValues block(Words words = {}) {
        detail::BlockValues values(fault);
        for (const auto &[name, value] : words) {
            const auto index = static_cast<std::size_t>(detail::BlockValues::index(name));
            values.present |= detail::bit_of(detail::BlockValues::index(name));
            values.value[index] = value;
            values.column[index] = 1;
        }
        return values;
    }
    /// Runs the function of a code or word.
    bool run(GCode code, Words words = {}) {
        const detail::Effect effect = detail::find_code(code)->run(code, block(words), state, parts);
        outcome = effect.next;
        return effect.done;
    }
    /// The queued calls, in order.
    std::vector<std::string> calls() {
        CallTexts out;
        canon.flush(out);
        return out.texts;
    }
};

}  // namespace mw::gcode::test
