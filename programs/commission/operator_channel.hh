// SPDX-License-Identifier: GPL-2.0-or-later
// How the operator of commissioning is reached: a terminal, a script or a screen.
#pragma once

#include <string>

#include "machine/commissioning/guide.hh"

namespace mw::programs {

/// Name of what the operator is asked for, for scripts and the browser.
inline const char *ask_name(commissioning::Ask ask) {
    switch (ask) {
    case commissioning::Ask::NOTHING: return "wait";
    case commissioning::Ask::CONFIRM: return "confirm";
    case commissioning::Ask::HOLD: return "hold";
    case commissioning::Ask::ACTION: return "do";
    case commissioning::Ask::NUMBER: return "number";
    case commissioning::Ask::CHOICE: return "choice";
    }
    return "";
}

class OperatorChannel {
  public:
    virtual ~OperatorChannel() = default;
    /// Shows what is new, and passes on what the operator did, without waiting. Once a cycle. @param now_s
    /// time of the machine. False: the operator is gone.
    virtual bool look(commissioning::Guide &guide, double now_s) = 0;
    /// A step has ended.
    virtual void show_finding(const commissioning::Step &step, const commissioning::Finding &finding) = 0;
    /// The machine cannot be started.
    virtual void show_failure(const std::string &error) = 0;
    /// The session has ended; `error` is empty unless it could not continue.
    virtual void show_end(const commissioning::Guide &guide, const std::string &error) = 0;
};

/// Adds what waits at standard input. False: it has ended.
bool read_standard_input(std::string &input);

}  // namespace mw::programs
