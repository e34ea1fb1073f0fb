// SPDX-License-Identifier: GPL-2.0-or-later
// Loops without end: the error of a check names the loop, not where it happened to be.
#include <fmt/format.h>

#include "interp/flow/flow.hh"

namespace mw::interp::detail {

bool Flow::note_conditional_pass(int first, int last) {
    note_pass(first, last);
    // Scripts and changed tool tables have states that are not seen here.
    const bool isAllSeen = budget_.isBounded() && scripts_ == nullptr && !executor_.hasToolChanges();
    const LoopPass pass{program_, calls_.size(), first, last};
    if (!isAllSeen || !budget_.isRepeating(pass, executor_.state, executor_.parameters)) {
        return true;
    }
    executor_.fault.line = first;
    return executor_.fault.set("This is a loop without end: nothing has changed from one pass to the next", 0,
                               "in a check, inputs, HAL pins and probes stay as they are: a loop that waits "
                               "for one of them must end "
                               "when #<_task> is 0");
}

/// The outermost loop that has lately begun again is the one that does not end.
Step Flow::fail_budget() {
    line_read_ = next_;
    const std::string where = fmt::format("{}:{}", file(), next_);
    std::optional<LoopPass> loop;
    for (std::size_t depth = 0; depth <= calls_.size() && !loop; ++depth) {
        const bool isInnermost = depth == calls_.size();
        loop = budget_.loop_around(isInnermost ? program_ : calls_[depth].program, depth,
                                   isInnermost ? next_ : calls_[depth].line);
    }
    const std::string taken = budget_.spend();
    if (loop && loop->depth < calls_.size()) {
        unwind(std::max(loop->depth, nested_base_));
    }
    executor_.begin_block();
    executor_.fault = {};
    executor_.fault.set(
        loop
            ? fmt::format("This loop has run for {} (now at {}); is it a loop without end?", taken, where)
            : fmt::format("The program has run for {} since it came to line {}; is there a loop without end?",
                          taken, budget_.furthest_line()));
    executor_.fault.hint =
        "correct the condition that ends it; if it is right, allow more statements (millwright check "
        "--statements N, 0 for any number)";
    isContinuable_ = false;
    executor_.fault.line = loop ? loop->first : 0;
    return fail_block();
}

}  // namespace mw::interp::detail
