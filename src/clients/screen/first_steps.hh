// SPDX-License-Identifier: GPL-2.0-or-later
// Before the start of a machine: the list of configurations, and a new configuration from answers.
// docs/reference/api.md, First steps.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hh"
#include "clients/screen/background_jobs.hh"
#include "machine/setup/plan.hh"

namespace mw::screen {

/// The steps at a machine, in another process: lines of JSON as in docs/reference/api.md. Its end switches
/// the machine off.
class StepsProcess {
  public:
    virtual ~StepsProcess() = default;
    /// Never waits: a line that cannot be taken now is dropped, since an old renewal of a button is no longer
    /// news.
    virtual void send(std::string_view line) = 0;
    /// Nothing: no whole line is there.
    virtual std::optional<std::string> next_line() = 0;
    /// The operator is gone: it switches off and ends by itself.
    virtual void close() = 0;
    virtual bool hasEnded() = 0;
};

/// A configuration as a person sees it.
struct Choice {
    std::string ini;           ///< whole path
    std::string name;          ///< in its group
    std::string machine;       ///< [EMC]MACHINE
    std::string kind;          ///< "mill", "lathe", "foam", "gantry", "other": the drawing of the machine
    std::string axes;          ///< "XYZ"
    std::string unit;          ///< "mm", "inch"; empty: unknown
    std::string notes;         ///< what its author says of it
    std::string picture;       ///< whole path; empty: none
    bool hasSteps = false;     ///< it can be commissioned
    bool isSimulated = false;  ///< with a simulated board
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
    /// Starts the steps at a machine.
    std::function<Result<std::unique_ptr<StepsProcess>>(const std::string &ini)> commission;
};

/// One thread, except for the jobs that it passes to `disk`.
class FirstSteps final : public Application {
  public:
    FirstSteps(BackgroundJobs &disk, Sockets &sockets, FirstStepsSetup setup)
        : disk_(disk), sockets_(sockets), setup_(std::move(setup)) {}

    void answer(const Request &request, Reply reply) override;
    void opened(SessionId session, Role role, Protection protection) override;
    void received(SessionId session, std::string_view text) override;
    void closed(SessionId session) override;
    /// Passes on what the steps have shown. Call often while isCommissioning().
    void look();
    bool isCommissioning() const { return process_ != nullptr; }
    /// Ends the steps; isCommissioning() until the machine is off.
    void end_steps();

    /// The INI file that is to be started; nothing until a person has chosen one.
    const std::optional<std::string> &chosen() const { return chosen_; }

  private:
    Response list();
    Response picture(const std::string &ini);
    Response make(const std::string &body);
    Response try_out(const std::string &body);
    void start(const std::string &body, Reply reply);
    bool isListed(const std::string &ini) const;
    void begin_steps(SessionId session, std::string_view text);
    void reject_steps(SessionId session, const std::string &why);

    BackgroundJobs &disk_;
    Sockets &sockets_;
    FirstStepsSetup setup_;
    /// Used by jobs alone.
    std::vector<ChoiceGroup> found_;
    std::vector<FirstStepsSetup::Made> made_;
    std::optional<std::string> chosen_;
    std::set<SessionId> trusted_;  ///< sockets of the user of this server
    std::unique_ptr<StepsProcess> process_;
    SessionId operator_ = 0;  ///< at the steps; 0: they end
};

}  // namespace mw::screen
