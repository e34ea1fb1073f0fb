// SPDX-License-Identifier: GPL-2.0-or-later
// Configurations of machines that may be chosen: those of the user, samples, and those of other packages.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::programs {

/// Where packages put configurations of theirs.
inline constexpr const char *AUX_EXAMPLES = "/usr/share/linuxcnc/aux_examples";

bool isFolder(const std::string &path);
/// Without links and dots; the path as it is where it leads nowhere.
std::string canonical_path(const std::string &path);

struct Configuration {
    std::string ini;      ///< whole path
    std::string name;     ///< as it is shown: relative to the folder of its group
    std::string machine;  ///< [EMC]MACHINE, may be empty
};
struct ConfigurationGroup {
    std::string title;
    std::string folder;
    bool isCopied = false;  ///< samples: a copy of the user's is started
    std::vector<Configuration> configurations;
};

/// Groups in the order in which they are shown, without empty ones. Sources: ~/millwright/configs,
/// ~/linuxcnc/configs, LINUXCNC_AUX_CONFIGS (folders separated by colons), AUX_EXAMPLES, samples of ours.
std::vector<ConfigurationGroup> find_configurations();

/// Copies the folder of a sample to ~/millwright/configs, with a link to the programs that it names by
/// ../../nc_files, unless it is there already. @return the path of the INI file there
Result<std::string> copy_sample(const ConfigurationGroup &group, const Configuration &configuration);

/// [PICKCONFIG]LAST_CONFIG of ~/.linuxcncrc; empty when there is none.
std::string last_configuration();
/// Keeps it there, and what else the file has.
Result<> remember_configuration(const std::string &ini);

}  // namespace mw::programs
