// SPDX-License-Identifier: GPL-2.0-or-later
// The names of older programs that show HAL: what menus and scripts start.
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace mw::hal::view {

/// The words of `millwright hal` for those of `halmeter [-s] [pin|sig|param NAME] [-g X Y [WIDTH]]`; nothing
/// when they are wrong. `isTerminal`: the values can be shown live, else they come as lines.
std::vector<std::string> meter_words(const std::vector<std::string> &words, bool isTerminal, bool &isWrong);

/// `halmeter`, on a terminal or as lines of text.
int halmeter(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop);

/// `halscope`: says what records instead.
int halscope(const std::vector<std::string> &words);

}  // namespace mw::hal::view
