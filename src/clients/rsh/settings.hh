// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of the command line and the INI file, for all connections.
#pragma once

#include <string>

#include "base/ini/ini_file.hh"

namespace mw::rsh {

/// NEWER: LinuxCNC 2.10, the default of a server. OLD: LinuxCNC 2.9.
enum class Dialect { NEWER, OLD };

struct Settings {
    std::string name = "EMCNETSVR";        ///< name in the answer to HELLO
    std::string connect_password = "EMC";  ///< password for HELLO
    std::string enable_password = "EMCTOO";
    std::string program_folder;  ///< for programs whose name is not a path; empty: the folder of the INI file
    Dialect dialect = Dialect::NEWER;
    const ini::IniFile *ini = nullptr;  ///< of the machine; must outlive this object
    double task_period_s = 0.001;
    int num_joints = 3;
    int num_spindles = 1;

    bool isOld() const { return dialect == Dialect::OLD; }
};

}  // namespace mw::rsh
