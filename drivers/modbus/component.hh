// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL component for a setup: its pins, and a thread for each link.
#pragma once

#include <csignal>

#include "base/result.hh"
#include "drivers/modbus/transactions.hh"

namespace mw::modbus {

/// Creates the pins, marks the component as ready and repeats the transactions until `stop` is not 0. If a
/// device does not answer, this is reported once and counted on its pin num_errors, the last values are kept,
/// and the device is polled again.
Result<> run(const Setup &setup, const volatile std::sig_atomic_t &stop);

}  // namespace mw::modbus
