// SPDX-License-Identifier: GPL-2.0-or-later
// Orders for states, programs, spindles, coolant and tools.
#pragma once

#include "clients/rsh/orders.hh"

namespace mw::rsh {

Result<Waiting> abort_all(const Ordered &o);
Result<Waiting> set_debug(const Ordered &o);
Result<Waiting> set_estop(const Ordered &o);
Result<Waiting> set_machine(const Ordered &o);
Result<Waiting> set_mode(const Ordered &o);
Result<Waiting> mdi(const Ordered &o);
Result<Waiting> open_program(const Ordered &o);
Result<Waiting> run(const Ordered &o);
Result<Waiting> pause(const Ordered &o);
Result<Waiting> resume(const Ordered &o);
Result<Waiting> step(const Ordered &o);
Result<Waiting> reset_interpreter(const Ordered &o);
Result<Waiting> set_optional_stop(const Ordered &o);
Result<Waiting> set_flood(const Ordered &o);
Result<Waiting> set_mist(const Ordered &o);
Result<Waiting> set_lube(const Ordered &o);
Result<Waiting> set_spindle(const Ordered &o);
Result<Waiting> set_brake(const Ordered &o);
Result<Waiting> set_spindle_override(const Ordered &o);
Result<Waiting> load_tool_table(const Ordered &o);
Result<Waiting> set_tool_offset(const Ordered &o);

/// Posts the command; the answer waits for it.
Result<Waiting> ask(const Ordered &o, const messages::Command &command, Until until = Until::AS_SET);
/// Reports that the current mode does not permit the order.
void tell_wrong_mode(const Ordered &o, const messages::Declaration &what);
/// The word at an index, or an empty text.
std::string word(const Ordered &o, std::size_t place);

}  // namespace mw::rsh
