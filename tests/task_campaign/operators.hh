// SPDX-License-Identifier: GPL-2.0-or-later
// The operators of the machine: they send commands, check that each command ends, and resume after pauses.
#pragma once

#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "task_campaign/bench.hh"
#include "task_campaign/plan.hh"

namespace mw::task_campaign {

struct Verdict {
    std::string fault;  ///< "rule: text"; empty: no violation
    double seconds = 0;
    int acts = 0, commands = 0, refused = 0, runs = 0, ended = 0, stopped = 0, crashes = 0, recovered = 0;
    std::map<std::string, int> counts;    ///< events, for instance faults during a run
    std::map<std::string, int> refusals;  ///< by reason, figures replaced
};

class Operators {
  public:
    Operators(const Plan &plan, const std::filesystem::path &folder, std::FILE *tell)
        : bench_(plan, folder), tell_(tell) {}

  protected:
    using Serial = client::Serial;
    enum class Expected { TAKEN, REFUSED, ANY };
    struct Order {
        Serial serial = 0;
        int client = 0;
        std::string name;
        Expected expected = Expected::ANY;
        std::int64_t posted_ms = 0, patience_ms = 0;
        std::optional<messages::Mode> mode;  ///< that it sets
        bool isRelease = false;
    };

    void fail(const std::string &rule, const std::string &text);
    bool isOver() const { return !verdict_.fault.empty(); }
    void tell(const std::string &text) const;
    void cycle();
    void cycles(int count);
    Serial post(int client, const messages::Command &command, Expected expected = Expected::ANY,
                std::int64_t patience_ms = 5000);
    messages::Progress ask(int client, const messages::Command &command, Expected expected = Expected::ANY);
    messages::Progress progress_of(Serial serial) const;
    bool isWaited(Serial serial) const;
    /// Commands of this client are not awaited; -1: of no client.
    void forget_orders(int client);
    const messages::MachineStatus &status() const { return bench_.status(); }
    bool isRunning() const { return status().task.interp_state != messages::InterpState::IDLE; }
    /// Acts as the operator: resumes after pauses, confirms proposals.
    void nurse();
    /// Waits until nothing runs, moves, waits or remains to be written.
    void settle();

    Bench bench_;
    std::FILE *tell_;
    Verdict verdict_;
    messages::Mode mode_ = messages::Mode::MANUAL;  ///< the last setting
    /// Mode that was being set at a stop, or the jog mode at the end of a released program. It may be active
    /// or not.
    std::optional<messages::Mode> mode_under_way_;
    bool isHeldByUs_ = false;  ///< no operator resumes

  private:
    void look_at_orders();
    void note_end(const Order &order, const client::Outcome &outcome);
    std::string what_it_waits_for() const;

    std::vector<Order> orders_;  ///< that have not ended
    std::map<Serial, client::Outcome> ended_;
    std::int64_t held_since_ms_ = -1;
    bool wasAway_ = false;  ///< a cycle ago
};

}  // namespace mw::task_campaign
