// SPDX-License-Identifier: GPL-2.0-or-later
// The operator panel of a simulated board: positions of the motors, and switches actuated by hand. It is a
// file that another program also maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/result.hh"

namespace mw::mesa::board {

/// The content of the file, in the order of the lines of the physics file.
struct HandPanelPage {
    static constexpr std::size_t MOTORS = 16, SWITCHES = 64;
    double position_rev[MOTORS] = {};
    /// 0: set by the position of the motor, 1: contact closed, 2: contact open.
    std::uint8_t contact[SWITCHES] = {};
};

/// One thread for each program that maps it; values of a running simulation may be one step old.
class HandPanel {
  public:
    /// Creates the file if it does not exist.
    static Result<std::shared_ptr<HandPanel>> open(const std::string &path);
    ~HandPanel();
    HandPanel(const HandPanel &) = delete;
    HandPanel &operator=(const HandPanel &) = delete;

    volatile HandPanelPage &page() { return *page_; }

  private:
    explicit HandPanel(HandPanelPage *page) : page_(page) {}
    HandPanelPage *page_;
};

}  // namespace mw::mesa::board
