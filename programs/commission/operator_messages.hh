// SPDX-License-Identifier: GPL-2.0-or-later
// The operator of commissioning at a screen: lines of JSON on standard input and output,
// docs/reference/api.md.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "programs/commission/operator_channel.hh"

namespace mw::programs {

/// State of a guide for a screen; `error` is empty while the session can continue.
std::string state_message(const commissioning::Guide &guide, const std::string &error);

struct NumberedAct {
    int prompt_number = 0;
    commissioning::Act act;
};
/// Nothing if the line is not an action.
std::optional<NumberedAct> read_act(std::string_view line);

/// From its creation on, standard output contains only states. Output of the machine and its programs is
/// redirected to standard error. Create it before the machine.
class OperatorMessages final : public OperatorChannel {
  public:
    OperatorMessages();
    ~OperatorMessages() override;
    OperatorMessages(const OperatorMessages &) = delete;
    OperatorMessages &operator=(const OperatorMessages &) = delete;

    bool look(commissioning::Guide &guide, double now_s) override;
    void show_finding(const commissioning::Step &, const commissioning::Finding &) override {}
    void show_failure(const std::string &error) override;
    void show_end(const commissioning::Guide &guide, const std::string &error) override;

  private:
    void print(const std::string &line);

    std::FILE *output_ = nullptr;
    std::string input_;
    int shown_number_ = -1;
    std::size_t shown_current_ = 0;
};

}  // namespace mw::programs
