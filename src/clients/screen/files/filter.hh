// SPDX-License-Identifier: GPL-2.0-or-later
// [FILTER]: programs that convert other files to G-code, for the operator's screen.
#pragma once

#include <map>
#include <string>

#include "base/ini/ini_file.hh"
#include "base/result.hh"
#include "clients/screen/http/piece_queue.hh"

namespace mw::screen {

/// Commands by file name extension, in lower case with the dot.
std::map<std::string, std::string> filters_of(const ini::IniFile &ini);

/// Folder for programs created by filters, which outlive the server; for this user and machine.
std::string filtered_folder(const std::string &instance);

struct FilterRun {
    std::string command;  ///< shell command; the file is its last word
    std::string folder;   ///< working folder
    std::string input;    ///< path of the file
    std::string output;   ///< path of the program, replaced atomically on success
};

/// Runs the filter to its end, or until there is no reader. `pieces` receives lines of JSON: {"progress": 40}
/// for the filter's FILTER_PROGRESS=40, then {"made": "/path"} or {"error": "..."}. Blocks.
void run_filter(const FilterRun &run, PieceQueue &pieces);

}  // namespace mw::screen
