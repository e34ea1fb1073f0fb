// SPDX-License-Identifier: GPL-2.0-or-later
// Limits for one loop or call of a program in checks. The counters restart when the main program reaches a
// line after all previous lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode::detail {

class Program;

/// A restarted loop: its lines in a program, at a call level.
struct LoopPass {
    const Program *program = nullptr;
    std::size_t depth = 0;
    int first = 0, last = 0;

    bool operator==(const LoopPass &) const = default;
    bool operator<(const LoopPass &o) const {
        return std::tie(program, depth, first, last) < std::tie(o.program, o.depth, o.first, o.last);
    }
};

/// State that determines the next pass of a loop.
struct LoopSnapshot {
    State state;
    Parameters::Values values;
};

class LoopBudget {
  public:
    explicit LoopBudget(const Settings &settings)
        : statements_(settings.statement_budget), idle_(settings.idle_budget),
          seconds_(settings.time_budget_s) {}

    bool isBounded() const { return statements_ > 0 || idle_ > 0 || seconds_ > 0; }
    void restart();
    /// Counts a statement; `main_line`: its line in the main program, 0 in a subroutine. False when a budget
    /// is used up, until restart().
    bool take_statement(int main_line) {
        if (main_line > furthest_line_) {
            begin_stretch(main_line);
        }
        ++taken_;
        ++taken_idle_;
        return !isSpent();
    }
    void mark_progress(double seconds) {
        taken_idle_ = spent_ ? taken_idle_ : 0;
        taken_seconds_ += seconds;
    }
    bool isSpent() const {
        return spent_ || (statements_ > 0 && taken_ > statements_) || (idle_ > 0 && taken_idle_ > idle_) ||
               (seconds_ > 0 && taken_seconds_ > seconds_);
    }
    /// True in the last part of each budget. Only then loops are recorded, because the loops running then are
    /// the endless ones.
    bool isWatching() const {
        return isBounded() && (isLate(taken_, statements_) || isLate(taken_idle_, idle_) ||
                               (seconds_ > 0 && taken_seconds_ > seconds_ / 2));
    }
    void note_pass(const LoopPass &pass) { ++passes_[pass]; }
    /// For loops that only a condition ends: true if two consecutive passes began with the same values and
    /// modes, so that all further passes are equal. The interval between compared passes increases.
    bool isRepeating(const LoopPass &pass, const State &state, const Parameters &parameters);
    /// The longest recorded loop that contains `line`.
    std::optional<LoopPass> loop_around(const Program *program, std::size_t depth, int line) const;
    int furthest_line() const { return furthest_line_; }
    /// Text that names the exhausted budget. Until restart() no statement is accepted.
    std::string spend();

  private:
    static bool isLate(std::uint64_t taken, std::uint64_t budget) { return budget > 0 && taken > budget / 2; }
    void begin_stretch(int main_line);

    std::uint64_t statements_, idle_;
    double seconds_;
    std::uint64_t taken_ = 0, taken_idle_ = 0;
    double taken_seconds_ = 0;
    int furthest_line_ = 0;
    bool spent_ = false;
    std::map<LoopPass, std::uint64_t> passes_;
    struct Watched {
        LoopPass pass;
        std::uint64_t count = 0, next = 64;
        std::unique_ptr<LoopSnapshot> last;
    };
    std::vector<Watched> watched_;
    std::size_t latest_ = 0;  ///< index in watched_
};

}  // namespace mw::gcode::detail
