// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that stores calls until their block has succeeded (under cutter compensation also until the end of
// the previous move is final), then passes them on in order. Can undo the calls of a failed block.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "gcode/canon/canon.hh"

namespace mw::gcode::detail {

class Program;

class CanonQueue final : public Canon {
  public:
    /// Sets the block of the following calls; the block is announced with its first call.
    void enter_block(const Program *program, int line, int sequence, bool isNumbered, int call_level);

    std::size_t size() const { return calls_.size(); }
    bool empty() const { return calls_.empty(); }
    /// rollback() can undo all changes from now on, until commit().
    void begin_undo() {
        kept_ = calls_.size();
        commit();
    }
    void commit() {
        if (!changed_.empty()) {
            changed_.clear();
        }
    }
    /// Drops the calls since begin_undo(), and restores earlier calls that have changed.
    void rollback();
    /// Drops all calls.
    void clear();
    /// Passes the first `count` calls to `target`.
    void flush(Canon &target, std::size_t count);
    void flush(Canon &target) {
        if (!calls_.empty()) {
            flush(target, calls_.size());
        }
    }

    /// Not used: enter_block() sets the block.
    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &call) override;
    /// As take(), for a type known at compile time.
    template <AlternativeOf<CanonCall> Call>
    void take(Call &&call) {
        mark_block();
        calls_.emplace_back(std::forward<Call>(call));
    }

    /// An axis and the end of a move along it.
    struct AxisEnd {
        int axis = 0;
        double value = 0;
    };
    /// Changes the end of the moves, beginning with call `from`. The two axes are those of the selected
    /// plane.
    void move_ends(std::size_t from, AxisEnd first, AxisEnd second);

  private:
    struct Block {
        const Program *program = nullptr;  ///< null: the calls belong to no block
        int line = 0, sequence = 0, call_level = 0;
        bool isNumbered = false;
    };
    /// Index of the first call of a block.
    struct Mark {
        std::size_t call = 0;
        Block block;
    };
    void mark_block();
    void truncate(std::size_t count);

    std::vector<CanonCall> calls_;
    std::size_t kept_ = 0;                                    ///< number of calls that rollback() keeps
    std::vector<std::pair<std::size_t, CanonCall>> changed_;  ///< original values of changed calls among them
    std::vector<Mark> marks_;                                 ///< in the order of the calls
    Block block_;
    bool block_marked_ = false;
};

}  // namespace mw::gcode::detail
