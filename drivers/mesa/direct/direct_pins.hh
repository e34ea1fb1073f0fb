// SPDX-License-Identifier: GPL-2.0-or-later
// The pins and parameters of the connection to a board on PCI, EPP or SPI.
#pragma once

#include "drivers/mesa/direct/direct_bus.hh"
#include "hal/sdk/component.hh"
#include "hal/sdk/module.hh"

namespace mw::mesa {

/// Reads io_error before a read and shows the result after it. In HAL memory.
class DirectPins {
  public:
    /// [while loading]
    void declare(sdk::Declare &d) noexcept {
        d.pin(bus_error_, "bus-error");
        d.pin(bus_error_exceeded_, "bus-error-exceeded");
        d.pin(bus_error_total_, "bus-error-total");
        d.param(io_error_, "io_error");
        rtapi_snprintf(name_.text, sizeof name_.text, "%s", d.prefix());
    }

    /// When io_error is set, by an operator or by HAL, the traffic stops; when it is reset, the board is
    /// compared and served again. [servo thread]
    void before(DirectBus &bus) noexcept {
        if (io_error_ && !bus.isStopped()) {
            bus.stop();
        } else if (!io_error_ && bus.isStopped()) {
            bus.resume();
        }
    }

    /// Called after the read or the write of a cycle. [servo thread]
    void after(const DirectBus &bus) noexcept {
        const bool failed = bus.isFailed() || bus.isStopped();
        if (bus.isFailed() && !bus_error_) {
            tell(bus);
        }
        if (bus.isStopped() && !io_error_) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: all traffic with the board is stopped until io_error is set to FALSE\n",
                            name_.text);
        }
        bus_error_ = failed;
        bus_error_exceeded_ = bus.isStopped();
        bus_error_total_ = bus.failed_cycles();
        io_error_ = bus.isStopped();
    }

  private:
    /// Writes one message for a burst of failures.
    void tell(const DirectBus &bus) const noexcept {
        switch (bus.fault()) {
        case DirectFault::NONE: break;
        case DirectFault::ACCESS:
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: an access to the board has failed: errno %d\n", name_.text,
                            bus.last_error());
            break;
        case DirectFault::NO_COOKIE:
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: the board does not answer: it reads 0x%08x; check its power and its cable\n",
                            name_.text, bus.cookie());
            break;
        case DirectFault::OTHER_BOARD:
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: the board that answers is not the one of the start; restart the machine\n",
                            name_.text);
            break;
        }
    }

    sdk::Out<bool> bus_error_, bus_error_exceeded_;
    sdk::Out<std::uint32_t> bus_error_total_;
    sdk::ParamRw<bool> io_error_;
    sdk::Name name_;
};

}  // namespace mw::mesa
