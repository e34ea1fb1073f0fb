// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL component for a setup: its pins, and a thread for each link.
#pragma once

#include <csignal>

#include "base/result.hh"
#include "drivers/modbus/transactions.hh"

namespace mw::modbus {

/// Creates the pins, marks the component as ready and repeats the transactions until `stop` is not 0. A
/// device that does not answer is reported once, counted on its pin num_errors, and polled again; the last
/// values are kept.
Result<> run(const Setup &setup, const volatile std::sig_atomic_t &stop);

}  // namespace mw::modbus
