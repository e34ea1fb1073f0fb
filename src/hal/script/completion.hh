// SPDX-License-Identifier: GPL-2.0-or-later
// Completion of a line that a person types.
#pragma once

#include <string>
#include <vector>

#include "hal/script/session.hh"

namespace mw::hal::script {

/// Possible words at the end of `line` that begin with its last, incomplete word: commands, then the objects
/// for this position (pins, signals, functions, modules, files...). Sorted; folders end with '/'.
std::vector<std::string> completions(Session &session, const std::string &line);

/// The longest common prefix.
std::string common_beginning(const std::vector<std::string> &words);

}  // namespace mw::hal::script
