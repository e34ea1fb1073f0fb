// SPDX-License-Identifier: GPL-2.0-or-later
// Compiles and links components with the machine's C compiler, and puts them where they are loaded from.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::halcompile {

/// Where things are, seen from the program: in a build folder or installed.
struct Places {
    std::string include_folder;  ///< the C headers
    std::string library_folder;  ///< libmillwright_hal.so
    std::string module_folder;   ///< realtime modules are installed here
    std::string program_folder;  ///< userspace components are installed here
    std::string man_folder;      ///< manN folders lie in it
    std::string data_folder;     ///< Makefile.modinc

    /// Of the program at `program`; $RTLIB_DIR, $USER_MODULE_DIR and $EMC2_HOME change where things are
    /// installed.
    static Places of_program(const std::string &program);
};

enum class Kind { REALTIME, USERSPACE };

struct BuildOrder {
    Kind kind = Kind::REALTIME;
    std::string source;         ///< C or C++, by its suffix
    std::string source_folder;  ///< where "headers" are looked for
    std::string output;
    std::vector<std::string> compile_args, link_args;
};

/// Compiles and links; the compiler's own messages go to stderr. Answers what the module calls that must not
/// be called from realtime functions (memory, files, waiting).
Result<std::vector<std::string>> build(const Places &places, const BuildOrder &order);

/// Copies a file with these permissions, at once or not at all.
Result<> install_file(const std::string &from, const std::string &to, unsigned mode);

/// Runs a program and waits for it; its exit status.
Result<int> run_program(const std::vector<std::string> &words);

/// Words of a text, quoted as in a shell.
Result<std::vector<std::string>> split_shell_words(const std::string &text);

}  // namespace mw::halcompile
