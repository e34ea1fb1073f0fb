// SPDX-License-Identifier: GPL-2.0-or-later
// Manual tool change as an in-process part: component hal_manualtoolchange (man page of that name).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/result.hh"
#include "hal/core/user_pin.hh"

namespace mw::machine {

/// How a tool is loaded by hand.
enum class ToolHand : std::uint8_t {
    SIMULATED,  ///< no person: a change is confirmed after a short delay
    PERSON,     ///< confirmed by the pin change_button, or by confirm()
};

/// Reports each change to `notice`.
class ManualToolChange {
  public:
    using Notice = std::function<void(const std::string &)>;

    Result<> create(hal::Instance &hal, ToolHand hand, Notice notice);
    void destroy();
    void step(std::int64_t now_ns);

    /// True if a person is asked to change the tool.
    bool isAsking() const {
        return hal_ != nullptr && hand_ == ToolHand::PERSON && asked_ns_ >= 0 && !confirmed_;
    }
    /// The person confirms the change; no effect when none is requested.
    void confirm() { confirmed_ = confirmed_ || isAsking(); }

  private:
    hal::Instance *hal_ = nullptr;
    int comp_id_ = 0;
    ToolHand hand_ = ToolHand::SIMULATED;
    bool confirmed_ = false;
    Notice notice_;
    hal::UserPin<bool> change_, changed_, change_button_;
    hal::UserPin<std::int32_t> number_;
    std::int64_t asked_ns_ = -1;
};

}  // namespace mw::machine
