// SPDX-License-Identifier: GPL-2.0-or-later
// The model on a terminal, with ncurses.
#pragma once

#include <csignal>

#include "base/result.hh"
#include "hal/tools/view/watch_model.hh"

namespace mw::hal::view {

/// Shows the model and handles keys until q, or until `stop` becomes nonzero. An error when standard output
/// is not a terminal.
Result<> run_terminal(WatchModel &model, volatile std::sig_atomic_t &stop);

}  // namespace mw::hal::view
