// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the I/O controller: component "iocontrol", pins iocontrol.0.* (requirement E1, man page
// iocontrol).
#pragma once

#include "base/result.hh"
#include "hal/core/user_pin.hh"
#include "io/controller.hh"

namespace mw::io {

/// Not realtime; one thread.
class Pins {
  public:
    /// Makes the component and its pins.
    Result<> create(hal::Hal &hal);
    /// Ends the component; its pins vanish.
    void destroy();

    Inputs read() const;
    void write(const Outputs &outputs);

  private:
    Result<> make_inputs(hal::Hal &hal);
    Result<> make_outputs(hal::Hal &hal);

    hal::Hal *hal_ = nullptr;
    int comp_id_ = 0;
    hal::UserPin<bool> emc_enable_in_, tool_prepared_, tool_changed_, lube_level_, toolchanger_fault_,
        fault_ack_;
    hal::UserPin<std::int32_t> toolchanger_reason_;
    hal::UserPin<bool> user_enable_out_, user_request_enable_, coolant_mist_, coolant_flood_, lube_;
    hal::UserPin<bool> tool_prepare_, tool_change_, emc_abort_, toolchanger_faulted_;
    hal::UserPin<std::int32_t> tool_prep_number_, tool_prep_pocket_, tool_prep_index_, tool_number_,
        tool_from_pocket_;
    hal::UserPin<std::int32_t> state_;
};

}  // namespace mw::io
