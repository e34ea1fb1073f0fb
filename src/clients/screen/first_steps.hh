// SPDX-License-Identifier: GPL-2.0-or-later
// Before the start of a machine: the list of configurations, and a new configuration from answers.
// docs/reference/api.md, First steps.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hh"
#include "clients/screen/background_jobs.hh"
#include "machine/setup/plan.hh"

namespace mw::screen {

/// A configuration as a person sees it.
struct Choice {
    std::string ini;      ///< whole path
    std::string name;     ///< in its group
    std::string machine;  ///< [EMC]MACHINE
    std::string kind;     ///< "mill", "lathe", "foam", "gantry", "other": the drawing of the machine
    std::string axes;     ///< "XYZ"
    std::string unit;     ///< "mm", "inch"; empty: not told
    std::string notes;    ///< what its author says of it
    std::string picture;  ///< whole path; empty: none
};
struct ChoiceGroup {
    std::string title, folder;
    bool isCopied = false;  ///< a copy of the user's is started
    std::vector<Choice> choices;
};

struct FirstStepsSetup {
    std::string screen_folder;
    std::string key;  ///< each request has it: the address that was printed has it
    /// What may block; each is called by one thread at a time.
    std::function<std::vector<ChoiceGroup>()> find;
    std::function<std::string()> last;  ///< INI file of the last time; empty: none
    struct Made {
        std::string ini, program;
    };
    std::function<Result<Made>(const std::string &folder, const setup::Plan &, const setup::Answers &)> make;
    /// What was printed; an error when the machine does not run its program.
    std::function<Result<std::string>(const Made &)> try_out;
    struct Start {
        std::string ini;
        int port = 0;  ///< of its screen in a browser; 0: it has a separate display
    };
    /// What will be started: of a sample, a copy.
    std::function<Result<Start>(const std::string &ini)> prepare;
    std::string proposed_folder;  ///< in which new machines are proposed
};

/// One thread, except for the jobs that it passes to `disk`.
class FirstSteps final : public Application {
  public:
    FirstSteps(BackgroundJobs &disk, FirstStepsSetup setup) : disk_(disk), setup_(std::move(setup)) {}

    void answer(const Request &request, Reply reply) override;
    void opened(SessionId, Role, Protection) override {}
    void received(SessionId, std::string_view) override {}
    void closed(SessionId) override {}

    /// The INI file that is to be started; nothing until a person has chosen one.
    const std::optional<std::string> &chosen() const { return chosen_; }

  private:
    Response list();
    Response picture(const std::string &ini);
    Response make(const std::string &body);
    Response try_out(const std::string &body);
    void start(const std::string &body, Reply reply);

    BackgroundJobs &disk_;
    FirstStepsSetup setup_;
    /// Used by jobs alone.
    std::vector<ChoiceGroup> found_;
    std::vector<FirstStepsSetup::Made> made_;
    std::optional<std::string> chosen_;
};

}  // namespace mw::screen
