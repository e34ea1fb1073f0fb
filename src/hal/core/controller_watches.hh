// SPDX-License-Identifier: GPL-2.0-or-later
// The modules of this realtime process that need to know when the controlling process ends, and that report
// when the machine is stopped and off. [the host's thread] The shared words are atomic, so a module accesses
// them in any thread.
#pragma once

#include <cstdint>
#include <vector>

namespace mw::hal {

class ControllerWatches {
  public:
    /// `is_gone` is set to 1 at the end of the controlling process; the module sets `is_safe` to a nonzero
    /// value when its machine is stopped and off. Both are memory of the component.
    void add(std::uint32_t *is_gone, const std::uint32_t *is_safe, int comp_id);
    /// From now on, count_check() increments `checks`. Returns false if the component does not watch the
    /// controlling process.
    bool count_checks(int comp_id, std::uint32_t *checks);
    void remove(int comp_id);
    bool isEmpty() const noexcept { return watches_.empty(); }

    void report_gone() noexcept;
    void count_check() noexcept;
    /// True when every module reports that its machine is stopped and off.
    bool isSafe() const noexcept;

  private:
    struct Watch {
        std::uint32_t *is_gone;
        const std::uint32_t *is_safe;
        int comp_id;
        std::uint32_t *checks = nullptr;  ///< null: not requested
    };
    std::vector<Watch> watches_;
};

}  // namespace mw::hal
