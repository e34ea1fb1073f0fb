// SPDX-License-Identifier: GPL-2.0-or-later
// Boards in memory with faults in the description of their firmware, for LinuxCNC's test hm2-idrom.
#pragma once

#include "drivers/mesa/hostmot2/hal/driver.hh"

namespace mw::mesa {

/// Registers hm2_test.0 with the description number `pattern`: 0, or a negated errno with a message in the
/// log
/// (-ENODEV: there is no such pattern). [while loading]
MW_HOSTMOT2_API int load_test_board(int comp_id, int pattern);

}  // namespace mw::mesa
