// SPDX-License-Identifier: GPL-2.0-or-later
// Built only while this build has no realtime host process.
#include "machine/machine.hh"

namespace mw::machine {

Result<std::unique_ptr<Machine>> make_realtime_machine(const MachineParts &, const MachineOptions &) {
    return fail("this build has no realtime host process");
}

}  // namespace mw::machine
