// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of `millwright`. Each takes its words and returns the exit status: 0 done, 1 rejected or
// failed, 2 wrong usage.
#pragma once

#include <string>
#include <vector>

namespace mw::programs {

int command_start(const std::vector<std::string> &words);
/// Arguments of `linuxcnc`.
int command_launch(const std::vector<std::string> &words);
int command_run(const std::vector<std::string> &words);
int command_ui(const std::vector<std::string> &words);
int command_recover(const std::vector<std::string> &words);
int command_publish(const std::vector<std::string> &words);
int command_nml(const std::vector<std::string> &words);
/// Arguments of `linuxcncrsh`, of `schedrmt`.
int command_rsh(const std::vector<std::string> &words);
int command_schedule(const std::vector<std::string> &words);
int command_check(const std::vector<std::string> &words);
/// Mesa boards on the network.
int command_boards(const std::vector<std::string> &words);
int command_doctor(const std::vector<std::string> &words);
/// Arguments of `linuxcnc_check_ini`.
int command_check_ini(const std::vector<std::string> &words);
/// Arguments: a folder, then answers of the form key=value.
int command_setup(const std::vector<std::string> &words);
/// Arguments: a part, then those of the part.
int command_commission(const std::vector<std::string> &words);
int command_select(const std::vector<std::string> &words);
/// Arguments of `linuxcnc_var`.
int command_var(const std::vector<std::string> &words);

}  // namespace mw::programs
