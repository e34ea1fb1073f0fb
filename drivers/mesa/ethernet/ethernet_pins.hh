// SPDX-License-Identifier: GPL-2.0-or-later
// The pins and parameters of the connection to an Ethernet board. Source: shared/hardware.md, part A3.
#pragma once

#include "drivers/mesa/ethernet/ethernet_bus.hh"
#include "hal/sdk/component.hh"
#include "hal/sdk/module.hh"

namespace mw::mesa {

/// Reads settings from parameters before a read and shows the result after it. In HAL memory.
class EthernetPins {
  public:
    /// [while loading]
    void declare(sdk::Declare &d) noexcept {
        d.pin(packet_error_, "packet-error");
        d.pin(packet_error_level_, "packet-error-level");
        d.pin(packet_error_exceeded_, "packet-error-exceeded");
        d.pin(packet_error_total_, "packet-error-total");
        const EthernetSettings settings;
        d.param(packet_read_timeout_, "packet-read-timeout", settings.read_timeout);
        d.param(packet_error_limit_, "packet-error-limit", settings.error_limit);
        d.param(packet_error_increment_, "packet-error-increment", settings.error_increment);
        d.param(packet_error_decrement_, "packet-error-decrement", settings.error_decrement);
        d.param(io_error_, "io_error");
        d.pin(no_answer_, "packets-not-answered");
        d.pin(write_lost_, "packets-write-lost");
        d.pin(send_failed_, "packets-send-failed");
        d.pin(receive_failed_, "packets-receive-failed");
        d.pin(short_answer_, "packets-wrong-size");
        d.pin(stale_, "packets-stale");
        rtapi_snprintf(name_.text, sizeof name_.text, "%s", d.prefix());
    }

    /// Called before the request of a cycle. When io_error is set, by an operator or by HAL, the traffic
    /// stops; when it is reset, the board is compared and served again. [servo thread]
    void before(EthernetBus &bus) noexcept {
        bus.settings = {.read_timeout = packet_read_timeout_,
                        .error_limit = packet_error_limit_,
                        .error_increment = packet_error_increment_,
                        .error_decrement = packet_error_decrement_};
        if (io_error_ && !bus.isStopped()) {
            bus.stop();
        } else if (!io_error_ && bus.isStopped()) {
            bus.resume();
        }
    }

    /// Called after the read of a cycle. [servo thread]
    void after(const EthernetBus &bus, long period_ns) noexcept {
        const bool failed = bus.isFailed() || bus.isStopped();
        if (failed && !packet_error_) {
            tell(bus, period_ns);
        }
        if (bus.isStopped() && !io_error_) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: all traffic with the board is stopped until io_error is set to FALSE\n",
                            name_.text);
        }
        packet_error_ = failed;
        packet_error_level_ = bus.errors().level();
        packet_error_exceeded_ = bus.errors().isExceeded();
        packet_error_total_ = packet_error_total_ + (bus.errors().total() - shown_total_);
        shown_total_ = bus.errors().total();
        io_error_ = bus.isStopped();
        const EthernetCounters &counters = bus.counters();
        no_answer_ = counters.no_answer;
        write_lost_ = counters.write_lost;
        send_failed_ = counters.send_failed;
        receive_failed_ = counters.receive_failed;
        short_answer_ = counters.short_answer;
        stale_ = counters.stale;
    }

  private:
    /// Writes one message for a burst of failures.
    void tell(const EthernetBus &bus, long period_ns) const noexcept {
        if (bus.last_cycle() == nullptr) {
            return;
        }
        const CycleTimes &cycle = *bus.last_cycle();
        const auto timeout_us = static_cast<long>(read_timeout_ns(packet_read_timeout_, period_ns) / 1000);
        switch (cycle.outcome) {
        case CycleOutcome::DONE: break;
        case CycleOutcome::NO_ANSWER:
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: the board has not answered within %ld us\n", name_.text,
                            timeout_us);
            break;
        case CycleOutcome::SEND_FAILED:
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: the request cannot be sent: errno %d\n", name_.text,
                            cycle.error);
            break;
        case CycleOutcome::RECEIVE_FAILED:
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: the answer cannot be received: errno %d\n", name_.text,
                            cycle.error);
            break;
        case CycleOutcome::SHORT_ANSWER:
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: an answer of the board has the wrong size\n", name_.text);
            break;
        case CycleOutcome::WRITE_LOST:
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: a write packet has not reached the board; all registers are written again\n",
                            name_.text);
            break;
        case CycleOutcome::OTHER_BOARD:
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: the board that answers is not the one of the start; restart the machine\n",
                            name_.text);
            break;
        }
    }

    sdk::Out<bool> packet_error_, packet_error_exceeded_;
    sdk::Out<std::int32_t> packet_error_level_;
    sdk::InOut<std::uint32_t> packet_error_total_;
    sdk::ParamRw<std::int32_t> packet_read_timeout_, packet_error_limit_, packet_error_increment_,
        packet_error_decrement_;
    sdk::ParamRw<bool> io_error_;
    sdk::Out<std::uint32_t> no_answer_, write_lost_, send_failed_, receive_failed_, short_answer_, stale_;
    std::uint32_t shown_total_ = 0;
    sdk::Name name_;
};

}  // namespace mw::mesa
