// SPDX-License-Identifier: GPL-2.0-or-later
// The interface to the operator of commissioning: a terminal, a script or a screen.
#pragma once

#include <string>

#include "machine/commissioning/guide.hh"

namespace mw::programs {

/// Name of the requested action, for scripts and the browser.
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
    /// Shows news, and passes on the operator's actions, without waiting. Called once in each cycle. @param
    /// now_s time of the machine. False: the operator has left.
    virtual bool look(commissioning::Guide &guide, double now_s) = 0;
    /// Called when a step has ended.
    virtual void show_finding(const commissioning::Step &step, const commissioning::Finding &finding) = 0;
    /// Called when the machine cannot be started.
    virtual void show_failure(const std::string &error) = 0;
    /// Called when the session has ended; `error` is empty unless the session could not continue.
    virtual void show_end(const commissioning::Guide &guide, const std::string &error) = 0;
};

/// Appends the data waiting at standard input. False at its end.
bool read_standard_input(std::string &input);

}  // namespace mw::programs
