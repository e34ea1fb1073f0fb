// SPDX-License-Identifier: GPL-2.0-or-later
// The person who changes tools by hand, as an in-process part: component hal_manualtoolchange (man page of
// that name).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/result.hh"
#include "hal/core/user_pin.hh"

namespace mw::machine {

/// Without an operator to ask, a change is confirmed after a short while; each is told to `notice`.
class ManualToolChange {
  public:
    using Notice = std::function<void(const std::string &)>;

    Result<> create(hal::Hal &hal, Notice notice);
    void destroy();
    void step(std::int64_t now_ns);

  private:
    hal::Hal *hal_ = nullptr;
    int comp_id_ = 0;
    Notice notice_;
    hal::UserPin<bool> change_, changed_, change_button_;
    hal::UserPin<std::int32_t> number_;
    std::int64_t asked_ns_ = -1;
};

}  // namespace mw::machine
