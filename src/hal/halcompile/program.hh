// SPDX-License-Identifier: GPL-2.0-or-later
// The program halcompile: its options and the processing of each file.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/halcompile/emit_c.hh"

namespace mw::halcompile {

enum class Mode { PREPROCESS, COMPILE, INSTALL, DOCUMENT, INSTALL_DOC, VIEW_DOC, PRINT_MODINC, HELP };

struct Options {
    Mode mode = Mode::PREPROCESS;
    bool userspace = false;
    bool requiresLicense = false;
    int personalities = DEFAULT_PERSONALITIES;
    std::string output;  ///< -o
    std::vector<std::string> compile_args, link_args;
    std::vector<std::string> files;
};

/// Reads the command line without the program's name. Long options may be abbreviated if they are unique.
Result<Options> parse_options(const std::vector<std::string> &arguments);

/// Runs the program. `program` is the path of its executable, to find headers and libraries. Exit status 0,
/// or 1 when a file failed; messages are on stderr.
int run(const std::string &program, const std::vector<std::string> &arguments);

}  // namespace mw::halcompile
