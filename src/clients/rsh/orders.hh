// SPDX-License-Identifier: GPL-2.0-or-later
// SET: a table of orders, each with what it asks of the machine or of the connection.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "clients/rsh/commander.hh"
#include "clients/rsh/own_state.hh"
#include "clients/rsh/settings.hh"
#include "clients/rsh/words.hh"

namespace mw::rsh {

/// State of a connection that an order needs.
enum class Needs : std::uint8_t { NOTHING, HELLO, ENABLE, MACHINE_ON };

/// When an order is answered.
enum class Until : std::uint8_t {
    AS_SET,    ///< as WAIT_MODE says
    TAKEN,     ///< when the machine has taken it: what it starts may take long
    ENDED,     ///< when it has ended
    WHATEVER,  ///< when it has ended or is rejected
    WHATEVER_TAKEN
};

/// What the answer waits for; nothing: it is done.
struct Waiting {
    Until until = Until::AS_SET;
    std::vector<client::Serial> serials;
    /// Besides; an error ends the wait.
    std::function<Result<bool>(const messages::MachineStatus &)> isOver;
    /// A probe that meets nothing has done what it was asked.
    bool isProbe = false;
};

struct Ordered {
    const Settings &settings;
    SharedView &shared;
    OwnState &own;
    Commander &commander;
    std::deque<std::string> &errors;  ///< of this connection alone, as GET ERROR tells them
    const Words &words;               ///< behind the name of the order
    const std::string &rest;          ///< the same as it was written
    const messages::MachineStatus &status() const { return shared.status(); }
};

using Ordering = Result<Waiting> (*)(const Ordered &);

struct Order {
    const char *name;
    Needs needs;
    const char *usage;  ///< its words, for HELP
    Ordering ordering;
};

/// `name` in capitals. Null: there is no such order.
const Order *find_order(const Settings &settings, const std::string &name);
/// "NAME WORDS" of each, for HELP.
std::vector<std::string> order_usages(const Settings &settings);

}  // namespace mw::rsh
