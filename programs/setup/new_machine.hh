// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that a person has described: its folder is made, and it is tried.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/setup/plan.hh"

namespace mw::programs {

/// Lines of "key = value"; empty ones and those that begin with # are left out.
Result<setup::Answers> read_answers(const std::string &text, const std::string &name);
/// As read_answers() reads them: all of a machine, also where a preset was taken.
std::string answers_text(const setup::Answers &given);

struct NewMachine {
    std::string ini, program;  ///< whole paths
};

/// Makes the folder with the files of the plan and of the answers, whole or not at all; one that has
/// something in it is refused.
Result<NewMachine> make_machine(const std::string &folder, const setup::Plan &plan,
                                const setup::Answers &given);

struct Trial {
    bool isGood = false;
    std::string output;  ///< of the program that was run
};

/// Starts the machine in virtual time, homes it and runs the program, in a process of its own. Blocks, for
/// two minutes at most; a stop signal ends it, too.
Result<Trial> try_machine(const NewMachine &machine);

}  // namespace mw::programs
