// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that keeps calls until their block has succeeded (and, under cutter compensation, until the move
// they follow has its final end), then hands them on in order. Takes back what a block that fails has done.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "gcode/canon/canon.hh"

namespace mw::gcode::detail {

class Program;

class CanonQueue final : public Canon {
  public:
    /// The block that calls from here on belong to; it is announced with its first call.
    void enter_block(const Program *program, int line, int sequence, bool isNumbered, int call_level);

    std::size_t size() const { return calls_.size(); }
    bool empty() const { return calls_.empty(); }
    /// From here on, until commit(), all that happens can be taken back.
    void begin_undo() {
        kept_ = calls_.size();
        commit();
    }
    void commit() {
        if (!changed_.empty()) {
            changed_.clear();
        }
    }
    /// Drops the calls since begin_undo(), and what was changed in those before.
    void rollback();
    /// Drops all calls.
    void clear();
    /// Hands on the first `count` calls.
    void flush(Canon &target, std::size_t count);
    void flush(Canon &target) {
        if (!calls_.empty()) {
            flush(target, calls_.size());
        }
    }

    /// Blocks are named by enter_block().
    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &call) override;
    /// The same for one whose kind is known where it is made.
    template <AlternativeOf<CanonCall> Call>
    void take(Call &&call) {
        mark_block();
        calls_.emplace_back(std::forward<Call>(call));
    }

    /// An axis and where a move ends along it.
    struct AxisEnd {
        int axis = 0;
        double value = 0;
    };
    /// The moves from call `from` on end there instead; the two axes are those of the selected plane.
    void move_ends(std::size_t from, AxisEnd first, AxisEnd second);

  private:
    struct Block {
        const Program *program = nullptr;  ///< none: calls of no block
        int line = 0, sequence = 0, call_level = 0;
        bool isNumbered = false;
    };
    /// The call before which a block begins.
    struct Mark {
        std::size_t call = 0;
        Block block;
    };
    void mark_block();
    void truncate(std::size_t count);

    std::vector<CanonCall> calls_;
    std::size_t kept_ = 0;                                    ///< those that rollback() leaves
    std::vector<std::pair<std::size_t, CanonCall>> changed_;  ///< among them, as they were
    std::vector<Mark> marks_;                                 ///< in the order of the calls
    Block block_;
    bool isBlockMarked_ = false;
};

}  // namespace mw::gcode::detail
