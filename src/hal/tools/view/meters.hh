// SPDX-License-Identifier: GPL-2.0-or-later
// LinuxCNC's program names for showing HAL, as used by menus and scripts.
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace mw::hal::view {

/// Words of `millwright hal` that correspond to `halmeter [-s] [pin|sig|param NAME] [-g X Y [WIDTH]]`;
/// nothing when they are not valid. `isTerminal`: values are shown live, otherwise as lines.
std::vector<std::string> meter_words(const std::vector<std::string> &words, bool is_terminal, bool &wrong);

/// `halmeter`, on a terminal or as lines of text.
int halmeter(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop);

/// `halscope`: prints the name of the replacement.
int halscope(const std::vector<std::string> &words);

}  // namespace mw::hal::view
