// SPDX-License-Identifier: GPL-2.0-or-later
// What the command line and the INI file settle for all connections.
#pragma once

#include <string>

#include "base/ini/ini_file.hh"

namespace mw::rsh {

/// NEWER: that of LinuxCNC 2.10, the default of a server. OLD: that of 2.9.
enum class Dialect { NEWER, OLD };

struct Settings {
    std::string name = "EMCNETSVR";        ///< as HELLO answers
    std::string connect_password = "EMC";  ///< of HELLO
    std::string enable_password = "EMCTOO";
    std::string program_folder;  ///< of programs whose name is no path; empty: that of the INI file
    Dialect dialect = Dialect::NEWER;
    const ini::IniFile *ini = nullptr;  ///< of the machine; must outlive this
    double task_period_s = 0.001;
    int num_joints = 3;
    int num_spindles = 1;

    bool isOld() const { return dialect == Dialect::OLD; }
};

}  // namespace mw::rsh
