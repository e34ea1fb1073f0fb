// SPDX-License-Identifier: GPL-2.0-or-later
// Which process the kernel ends first when memory is gone.
#pragma once

namespace mw {

/// For this process and those that it starts: -1000 never, 0 as its size says, 1000 first. Everybody may
/// raise it; to lower it needs CAP_SYS_RESOURCE. False: it stays as it was.
bool set_oom_score(int score);

}  // namespace mw
