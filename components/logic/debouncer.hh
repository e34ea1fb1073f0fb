// SPDX-License-Identifier: GPL-2.0-or-later
// A bit that must be stable before it counts. Realtime-safe.
#pragma once

namespace mw::logic {

/// Counts up in every period in which the input is true and down in every other one, between 0 and the delay.
/// The output changes when the count reaches an end.
class Debouncer {
  public:
    /// `delay` [periods], at least 1.
    bool run(bool input, long delay) noexcept {
        const long most = delay < 1 ? 1 : delay;
        count_ += input ? 1 : -1;
        if (count_ >= most) {
            count_ = most;
            output_ = true;
        } else if (count_ <= 0) {
            count_ = 0;
            output_ = false;
        }
        return output_;
    }

  private:
    long count_ = 0;
    bool output_ = false;
};

}  // namespace mw::logic
