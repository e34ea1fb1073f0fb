// SPDX-License-Identifier: GPL-2.0-or-later
// All component modules, with the arguments for loading each.
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace mw::components::test {

/// Names of the modules in this folder, from the build.
inline std::vector<std::string> all_modules() {
    std::istringstream words(MW_ALL_COMPONENTS);
    std::vector<std::string> modules;
    for (std::string word; words >> word;) {
        modules.push_back(word);
    }
    return modules;
}

/// Arguments for modules that load little or nothing without them.
inline std::string arguments_of(const std::string &module) {
    static const std::map<std::string, std::string> ARGUMENTS = {{"logic", "personality=0x1f03"},
                                                                 {"mux_generic", "config=fs4"},
                                                                 {"demux_generic", "config=fs4"},
                                                                 {"stepgen", "step_type=0,1,2"},
                                                                 {"sampler", "cfg=bfsu depth=5"},
                                                                 {"streamer", "cfg=bfsu depth=5"},
                                                                 {"threads", "name1=fast period1=100000"},
                                                                 {"bitslice", "personality=4"},
                                                                 {"weighted_sum", "wsum_sizes=4"},
                                                                 {"debounce", "cfg=2"},
                                                                 {"pwmgen", "output_type=0,1,2"},
                                                                 {"carousel", "pockets=12"},
                                                                 {"bldc", "cfg=qi,hqHF,hB6,6,aB,n"},
                                                                 {"gantry", "personality=2"},
                                                                 {"lcd", "\"fmt_strings=X %8.3f\""},
                                                                 {"matrix_kb", "config=4x4s"},
                                                                 {"max31855", "personality=2"},
                                                                 {"message", "messages=Stop"},
                                                                 {"watchdog", "num_inputs=2"},
                                                                 {"enum", "\"enums=E;off;on,D;slow;fast\""},
                                                                 {"pid", "debug=1"},
                                                                 {"motmod", "num_joints=2"}};
    const auto found = ARGUMENTS.find(module);
    return found == ARGUMENTS.end() ? "" : found->second;
}

}  // namespace mw::components::test
