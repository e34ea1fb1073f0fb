// SPDX-License-Identifier: GPL-2.0-or-later
// [FILTER]: programs that make G-code out of other files, for the operator's screen.
#pragma once

#include <map>
#include <string>

#include "base/ini/ini_file.hh"
#include "base/result.hh"
#include "clients/screen/piece_queue.hh"

namespace mw::programs {

/// Commands by the extension of files, in lower case with its dot.
std::map<std::string, std::string> filters_of(const ini::IniFile &ini);

/// Where the programs of filters lie, which outlive the server: a folder of this user and machine.
std::string filtered_folder(const std::string &instance);

struct FilterRun {
    std::string command;  ///< for a shell; the file is its last word
    std::string folder;   ///< in which it runs
    std::string input;    ///< path of the file
    std::string output;   ///< path of the program, replaced as a whole when all is well
};

/// Runs it to its end, or until nobody reads. `pieces` gets lines of JSON: {"progress": 40} as the filter
/// says FILTER_PROGRESS=40, then {"made": "/path"} or {"error": "..."}. Blocks.
void run_filter(const FilterRun &run, screen::PieceQueue &pieces);

}  // namespace mw::programs
