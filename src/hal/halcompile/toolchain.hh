// SPDX-License-Identifier: GPL-2.0-or-later
// Compiles and links components with the machine's C compiler, and installs them.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::halcompile {

/// Paths relative to the program: in a build folder or installed.
struct Places {
    std::string include_folder;  ///< the C headers
    std::string library_folder;  ///< libmillwright_hal.so
    std::string module_folder;   ///< realtime modules are installed here
    std::string program_folder;  ///< userspace components are installed here
    std::string man_folder;      ///< has manN folders
    std::string data_folder;     ///< Makefile.modinc

    /// For the program at `program`; $RTLIB_DIR, $USER_MODULE_DIR and $EMC2_HOME change the installation
    /// folders.
    static Places of_program(const std::string &program);
};

enum class Kind { REALTIME, USERSPACE };

struct BuildOrder {
    Kind kind = Kind::REALTIME;
    std::string source;         ///< C or C++, by its extension
    std::string source_folder;  ///< folder for "headers"
    std::string output;
    std::vector<std::string> compile_args, link_args;
};

/// Compiles and links; the compiler's own messages go to stderr. Returns the functions called by the module
/// that realtime functions must not call (memory, files, waiting).
Result<std::vector<std::string>> build(const Places &places, const BuildOrder &order);

/// Copies a file with these permissions, atomically.
Result<> install_file(const std::string &from, const std::string &to, unsigned mode);

/// Runs a program and waits for it; returns its exit status.
Result<int> run_program(const std::vector<std::string> &words);

/// Words of a text, quoted as in a shell.
Result<std::vector<std::string>> split_shell_words(const std::string &text);

}  // namespace mw::halcompile
