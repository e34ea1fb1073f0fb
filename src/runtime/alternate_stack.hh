// SPDX-License-Identifier: GPL-2.0-or-later
// A stack for signal handlers of the creating thread, so that a crash can be reported when the thread's own
// stack is exhausted.
#pragma once

#include <csignal>
#include <cstddef>

namespace mw::runtime {

class AlternateStack {
  public:
    AlternateStack() noexcept {
        stack_t stack{};
        stack.ss_sp = bytes_;
        stack.ss_size = SIZE;
        ::sigaltstack(&stack, nullptr);
    }
    ~AlternateStack() {
        stack_t none{};
        none.ss_flags = SS_DISABLE;
        ::sigaltstack(&none, nullptr);
    }
    AlternateStack(const AlternateStack &) = delete;
    AlternateStack &operator=(const AlternateStack &) = delete;

  private:
    /// More than the largest vector state that the kernel saves on it (MINSIGSTKSZ can be 11 kB).
    static constexpr std::size_t SIZE = 64U << 10U;
    alignas(16) unsigned char bytes_[SIZE];
};

}  // namespace mw::runtime
