// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL component that carries a setup out: its pins, and a thread for each link.
#pragma once

#include <csignal>

#include "base/result.hh"
#include "drivers/modbus/transactions.hh"

namespace mw::modbus {

/// Makes the pins, says that the component is ready and repeats the transactions until `stop` is not 0. A
/// device that does not answer is told once, counted on its pin num_errors, and asked again; what was read
/// last stays.
Result<> run(const Setup &setup, const volatile std::sig_atomic_t &stop);

}  // namespace mw::modbus
