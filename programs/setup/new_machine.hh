// SPDX-License-Identifier: GPL-2.0-or-later
// Creates the folder of a new machine from answers, and tries the machine.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/setup/files.hh"

namespace mw::programs {

/// Reads lines of "key = value"; skips empty lines and those that begin with #.
Result<setup::Answers> read_answers(const std::string &text, const std::string &name);
/// Text for read_answers(): all answers of a machine, presets included.
std::string answers_text(const setup::Answers &given);

/// Name of the records in the folder of a machine: the answers, and the files as generated.
inline constexpr const char *ANSWERS_FILE = "answers.txt", *GENERATED_FOLDER = ".generated";
/// Writes the record of generated files.
Result<> write_generated(const std::string &folder, const std::vector<setup::File> &files);

struct NewMachine {
    std::string ini, program;  ///< absolute paths
};

/// Creates the folder with the files of the plan and of the answers, completely or not at all; a folder that
/// is not empty is rejected.
Result<NewMachine> make_machine(const std::string &folder, const setup::Plan &plan,
                                const setup::Answers &given);

struct Trial {
    bool good = false;
    std::string output;  ///< output of the program run
};

/// Starts the machine in virtual time in a separate process, homes it and runs the program. Blocks for at
/// most two minutes; a stop signal also ends it.
Result<Trial> try_machine(const NewMachine &machine);

}  // namespace mw::programs
