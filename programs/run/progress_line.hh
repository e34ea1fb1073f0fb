// SPDX-License-Identifier: GPL-2.0-or-later
// Shows the progress of reading a program on a terminal.
#pragma once

#include <chrono>

#include "gcode/analysis/preview.hh"

namespace mw::programs {

/// A line on standard error that is updated twice a second; no effect if it is not a terminal.
class ProgressLine {
  public:
    ProgressLine();
    void show(const gcode::PreviewProgress &now);
    void clear();

  private:
    bool is_terminal_;
    bool shown_ = false;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_ = begin_;
};

}  // namespace mw::programs
