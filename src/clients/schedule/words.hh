// SPDX-License-Identifier: GPL-2.0-or-later
// Questions and orders for a queue of programs: one row for each.
#pragma once

#include <string>
#include <vector>

#include "clients/schedule/session.hh"

namespace mw::schedule {

struct Said {
    const Shared &shared;
    OwnState &own;
    rsh::Words words;  ///< words after the name
};

/// The answer to GET NAME; `name` in capitals.
Result<std::vector<std::string>> answer_to(const std::string &name, const Said &said);
/// SET NAME, after HELLO. Orders that need SET ENABLE are rejected without it.
Result<> carry_out_order(const std::string &name, const Said &said);
/// HELP; `about` in capitals, empty: everything.
std::vector<std::string> help(const std::string &about);

}  // namespace mw::schedule
