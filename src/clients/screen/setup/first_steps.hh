// SPDX-License-Identifier: GPL-2.0-or-later
// Configuration before the start of a machine: the list of configurations, and a new configuration from
// answers. docs/reference/api.md, First steps.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hh"
#include "clients/screen/http/background_jobs.hh"
#include "machine/setup/plan.hh"

namespace mw::screen {

/// The commissioning steps at a machine, in another process. It communicates in lines of JSON as in
/// docs/reference/api.md. Its end switches the machine off.
class StepsProcess {
  public:
    virtual ~StepsProcess() = default;
    /// Never waits. A line that cannot be sent now is dropped, because an old renewal of a button must not be
    /// sent later.
    virtual void send(std::string_view line) = 0;
    /// Nothing if there is no complete line.
    virtual std::optional<std::string> next_line() = 0;
    /// Called when the operator has left: the process switches the machine off and ends.
    virtual void close() = 0;
    virtual bool hasEnded() = 0;
};

/// A configuration as shown to the user.
struct Choice {
    std::string ini;           ///< absolute path
    std::string name;          ///< name within its group
    std::string machine;       ///< [EMC]MACHINE
    std::string kind;          ///< "mill", "lathe", "foam", "gantry", "other": the drawing of the machine
    std::string axes;          ///< "XYZ"
    std::string unit;          ///< "mm", "inch"; empty: unknown
    std::string notes;         ///< notes of the author
    std::string picture;       ///< absolute path; empty: none
    bool hasSteps = false;     ///< the machine can be commissioned
    bool isSimulated = false;  ///< it has a simulated board
};
struct ChoiceGroup {
    std::string title, folder;
    bool isCopied = false;  ///< a copy in the user's folder is started
    std::vector<Choice> choices;
};

struct FirstStepsSetup {
    std::string screen_folder;
    std::string key;  ///< required in each request; it is part of the printed address
    /// Blocking functions; each is called by one thread at a time.
    std::function<std::vector<ChoiceGroup>()> find;
    std::function<std::string()> last;  ///< INI file of the last start; empty: none
    struct Made {
        std::string ini, program;
    };
    std::function<Result<Made>(const std::string &folder, const setup::Plan &, const setup::Answers &)> make;
    /// Output of the program; an error if the machine does not run it.
    std::function<Result<std::string>(const Made &)> try_out;
    struct Start {
        std::string ini;
        int port = 0;  ///< port of its screen in a browser; 0: it has a separate display
    };
    /// The configuration that will be started; for a sample a copy.
    std::function<Result<Start>(const std::string &ini)> prepare;
    std::string proposed_folder;  ///< proposed folder for new machines
    /// Starts the commissioning steps at a machine.
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
    /// Passes on the prompts of the steps. Call it often while isCommissioning().
    void look();
    bool isCommissioning() const { return process_ != nullptr; }
    /// Ends the steps; isCommissioning() remains true until the machine is off.
    void end_steps();

    /// The INI file to be started; nothing until the user has chosen one.
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
    /// used only by jobs
    std::vector<ChoiceGroup> found_;
    std::vector<FirstStepsSetup::Made> made_;
    std::optional<std::string> chosen_;
    std::set<SessionId> trusted_;  ///< sockets of the user of this server
    std::unique_ptr<StepsProcess> process_;
    SessionId operator_ = 0;  ///< socket that operates the steps; 0: they end
};

}  // namespace mw::screen
