// SPDX-License-Identifier: GPL-2.0-or-later
// What could follow on a line that somebody types.
#pragma once

#include <string>
#include <vector>

#include "hal/script/session.hh"

namespace mw::hal::script {

/// The words that could stand where `line` ends and begin with its last, unfinished word: commands, then what
/// the position in the command demands (pins, signals, functions, modules, files...). Sorted; folders end
/// with '/'.
std::vector<std::string> completions(Session &session, const std::string &line);

/// The longest beginning that all have in common.
std::string common_beginning(const std::vector<std::string> &words);

}  // namespace mw::hal::script
