// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that keeps calls until their block has succeeded (and, under cutter compensation, until the move
// they follow has its final end), then hands them on in order.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "interp/canon/canon.hh"

namespace mw::interp::detail {

class Program;

class CanonQueue final : public Canon {
  public:
    /// The block that calls from here on belong to; it is announced with its first call.
    void enter_block(const Program *program, int line, int sequence, bool isNumbered, int call_level);

    std::size_t size() const { return calls_.size(); }
    bool empty() const { return calls_.empty(); }
    /// Drops all calls after the first `count`.
    void truncate(std::size_t count);
    /// Hands on the first `count` calls.
    void flush(Canon &target, std::size_t count);
    void flush(Canon &target) { flush(target, calls_.size()); }

    /// Blocks are named by enter_block().
    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &call) override;
    /// The same for one whose kind is known where it is made.
    template <AlternativeOf<CanonCall> Call>
    void take(Call &&call) {
        mark_block();
        calls_.emplace_back(std::forward<Call>(call));
    }

    /// For cutter compensation, which changes the ends of moves that wait.
    CanonCall &call(std::size_t index) { return calls_[index]; }

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

    std::vector<CanonCall> calls_;
    std::vector<Mark> marks_;  ///< in the order of the calls
    Block block_;
    bool isBlockMarked_ = false;
};

}  // namespace mw::interp::detail
