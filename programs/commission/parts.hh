// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of `millwright commission`. Each takes its words and returns the exit status.
#pragma once

#include <string>
#include <vector>

namespace mw::programs::commission {

int command_describe(const std::vector<std::string> &words);
int command_find(const std::vector<std::string> &words);
int command_check(const std::vector<std::string> &words);
int command_tune(const std::vector<std::string> &words);
int command_report(const std::vector<std::string> &words);
int command_write(const std::vector<std::string> &words);

}  // namespace mw::programs::commission
