// SPDX-License-Identifier: GPL-2.0-or-later
// The operator of commissioning at a terminal, or a script that writes lines.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "programs/commission/operator_channel.hh"
#include "programs/run/keyboard.hh"

namespace mw::programs {

/// Shows prompts and reads actions, without waiting. Lines: "confirm", "hold SECONDS", "number 12.5", "choice
/// positive", "cannot". At a terminal Enter confirms and ends a line, and a held space bar is the button.
class OperatorLine final : public OperatorChannel {
  public:
    OperatorLine();

    /// Shows the current prompt if it is new, and passes on the operator's action. False at the end of the
    /// input.
    bool look(commissioning::Guide &guide, double now_s) override;
    void show_finding(const commissioning::Step &step, const commissioning::Finding &finding) override;
    void show_failure(const std::string &) override {}
    void show_end(const commissioning::Guide &guide, const std::string &error) override;

  private:
    /// Text in the operator's language; a script reads English.
    std::string shown(std::string_view english) const;
    void show(const commissioning::Guide &guide);
    bool read(double now_s);
    void take(commissioning::Guide &guide, double now_s, const std::string &line);

    std::unique_ptr<Keyboard> keyboard_;  ///< null: a script
    std::string input_;
    int shown_ = -1, pressed_for_ = -1;  ///< numbers of prompts
    double held_until_s_ = -1, space_seen_s_ = -1;
    bool isEnded_ = false, isSpaceHeld_ = false;
};

}  // namespace mw::programs
