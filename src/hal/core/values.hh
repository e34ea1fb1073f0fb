// SPDX-License-Identifier: GPL-2.0-or-later
// Values by name: of the parameter, else of the pin, else of the signal with that name.
// Not realtime-safe. [any non-realtime thread and process]
#pragma once

#include <string_view>

#include "base/result.hh"
#include "hal/core/value.hh"

namespace mw::hal {

namespace detail {
class Segment;
}

class Values {
  public:
    explicit Values(detail::Segment &segment) : segment_(segment) {}

    /// As getp: parameter or pin.
    Result<Value> get(std::string_view name) const;
    /// As setp: parameter or pin; rejects OUT pins, linked pins and RO parameters.
    Result<> set(std::string_view name, const Value &value);
    Result<> set(std::string_view name, std::string_view text);
    /// Sets the value of an IN or IO pin as if its signal had changed; for tests and simulations.
    Result<> force(std::string_view pin_or_signal, const Value &value);
    /// Current address of the value of a pin, parameter or signal, for programs that read often. The address
    /// of a pin's value changes when the pin is linked or unlinked; for your own pins use the slot.
    Result<volatile void *> address_of(std::string_view name, Type type);

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
