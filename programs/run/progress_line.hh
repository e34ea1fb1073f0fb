// SPDX-License-Identifier: GPL-2.0-or-later
// How far the reading of a program is, on a terminal.
#pragma once

#include <chrono>

#include "gcode/analysis/preview.hh"

namespace mw::programs {

/// A line of standard error that is written over twice a second; nothing where that is no terminal.
class ProgressLine {
  public:
    ProgressLine();
    void show(const gcode::PreviewProgress &now);
    void clear();

  private:
    bool isTerminal_;
    bool isShown_ = false;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_ = begin_;
};

}  // namespace mw::programs
