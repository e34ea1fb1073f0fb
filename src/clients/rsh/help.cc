// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/help.hh"

#include "clients/rsh/answers.hh"
#include "clients/rsh/orders.hh"

namespace mw::rsh {
namespace {

using Lines = std::vector<std::string>;

Lines listed(Lines head, const Lines &names) {
    for (const std::string &name : names) {
        head.push_back("    " + name);
    }
    return head;
}

}  // namespace

Lines help(const Settings &settings, const std::string &about) {
    if (about.empty()) {
        return {"Available commands:", "  Hello <password> <client name> <protocol version>",
                "  Get <question>",    "  Set <order>",
                "  Shutdown",          "  Quit",
                "  Help <command>"};
    }
    if (about == "GET") {
        return listed(
            {"Usage: Get <question>", "  Answers with the question and what is asked for. Questions:"},
            question_names(settings));
    }
    if (about == "SET") {
        return listed({"Usage: Set <order>",
                       "  Needs Hello, most need 'Set enable <password>', and a machine that is on. Orders:"},
                      order_usages(settings));
    }
    if (about == "HELLO") {
        return {"Usage: Hello <password> <client name> <protocol version>",
                "  Answered by 'HELLO ACK <server name> <protocol version>', or by 'HELLO NAK'."};
    }
    if (about == "QUIT") {
        return {"Usage: Quit", "  Ends this connection."};
    }
    if (about == "SHUTDOWN") {
        return {"Usage: Shutdown",
                "  Ends the server, and with it the machine whose display it is. Needs 'Set "
                "enable <password>'."};
    }
    if (about == "HELP") {
        return {"Usage: Help <command>", "  Describes a command."};
    }
    return {about + " is not a valid command."};
}

}  // namespace mw::rsh
