// SPDX-License-Identifier: GPL-2.0-or-later
// SET: a table of orders for the machine or the connection.
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

/// Required state of the connection for an order.
enum class Needs : std::uint8_t { NOTHING, HELLO, ENABLE, MACHINE_ON };

/// Condition for answering an order.
enum class Until : std::uint8_t {
    AS_SET,    ///< as set by WAIT_MODE
    TAKEN,     ///< when the machine has taken it; the action that it starts may take long
    ENDED,     ///< when it has ended
    WHATEVER,  ///< when it has ended or is rejected
    WHATEVER_TAKEN
};

/// Condition for an answer; nothing: it is complete.
struct Waiting {
    Until until = Until::AS_SET;
    std::vector<client::Serial> serials;
    /// Additional condition; an error ends the wait.
    std::function<Result<bool>(const messages::MachineStatus &)> isOver;
    /// A probe without contact is not an error.
    bool isProbe = false;
};

struct Ordered {
    const Settings &settings;
    SharedView &shared;
    OwnState &own;
    Commander &commander;
    std::deque<std::string> &errors;  ///< errors of this connection, for GET ERROR
    const Words &words;               ///< words after the name of the order
    const std::string &rest;          ///< the words as written
    const messages::MachineStatus &status() const { return shared.status(); }
};

using Ordering = Result<Waiting> (*)(const Ordered &);

struct Order {
    const char *name;
    Needs needs;
    const char *usage;  ///< usage for HELP
    Ordering ordering;
};

/// `name` in capitals. Null if there is no such order.
const Order *find_order(const Settings &settings, const std::string &name);
/// "NAME WORDS" of each, for HELP.
std::vector<std::string> order_usages(const Settings &settings);

}  // namespace mw::rsh
