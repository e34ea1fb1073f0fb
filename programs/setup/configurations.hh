// SPDX-License-Identifier: GPL-2.0-or-later
// Configurations of machines for selection: those of the user, samples, and those of other packages.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::programs {

/// Folder where packages install their configurations.
inline constexpr const char *AUX_EXAMPLES = "/usr/share/linuxcnc/aux_examples";

bool isFolder(const std::string &path);
/// The path without links and dots; unchanged if it does not exist.
std::string canonical_path(const std::string &path);

struct Configuration {
    std::string ini;      ///< absolute path
    std::string name;     ///< displayed name: relative to the folder of its group
    std::string machine;  ///< [EMC]MACHINE, may be empty
};
struct ConfigurationGroup {
    std::string title;
    std::string folder;
    bool isCopied = false;  ///< samples: a copy for the user is started
    std::vector<Configuration> configurations;
};

/// The groups in display order, without empty ones. Sources: ~/millwright/configs, ~/linuxcnc/configs,
/// LINUXCNC_AUX_CONFIGS (folders separated by colons), AUX_EXAMPLES, our samples.
std::vector<ConfigurationGroup> find_configurations();

/// Copies the folder of a sample to ~/millwright/configs, unless it exists there, with a link to the programs
/// that it refers to by ../../nc_files. @return the path of the INI file there
Result<std::string> copy_sample(const ConfigurationGroup &group, const Configuration &configuration);

/// [PICKCONFIG]LAST_CONFIG of ~/.linuxcncrc; empty if it is not set.
std::string last_configuration();
/// Stores it in this key, and keeps the rest of the file.
Result<> remember_configuration(const std::string &ini);

}  // namespace mw::programs
