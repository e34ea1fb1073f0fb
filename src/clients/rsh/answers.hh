// SPDX-License-Identifier: GPL-2.0-or-later
// GET: a table of questions with their answers.
#pragma once

#include <string>
#include <vector>

#include "clients/rsh/own_state.hh"
#include "clients/rsh/settings.hh"
#include "clients/rsh/words.hh"
#include "messages/legacy/status_table.hh"

namespace mw::rsh {

struct Asked {
    const Settings &settings;
    SharedView &shared;
    OwnState &own;
    const messages::MachineStatus &status;
    const Words &words;  ///< words after the name of the question
};

inline legacy::Dialect dialect(const Asked &asked) {
    return asked.settings.isOld() ? legacy::Dialect::OLD_RSH : legacy::Dialect::RSH;
}

/// The lines of the answer.
using Answer = Result<std::vector<std::string>>;

/// `name` in capitals. Null if there is no such question.
using Answering = Answer (*)(const Asked &);
Answering answering(const Settings &settings, const std::string &name);
/// Names for HELP.
std::vector<std::string> question_names(const Settings &settings);

}  // namespace mw::rsh
