// SPDX-License-Identifier: GPL-2.0-or-later
// A connection of linuxcncrsh, which reads and answers one line after the other.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "clients/rsh/commander.hh"
#include "clients/rsh/conversation.hh"
#include "clients/rsh/line_input.hh"
#include "clients/rsh/orders.hh"
#include "clients/rsh/own_state.hh"
#include "clients/rsh/settings.hh"

namespace mw::rsh {

/// All calls come from one thread. A line is read after the previous line has been answered. Jogs of a
/// connection stop when it ends.
class Session final : public Conversation {
  public:
    /// The arguments must outlive the session.
    Session(const Settings &settings, SharedView &shared, Joining joining);
    ~Session() override;
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    void take(std::string_view bytes) override;
    void end_input() override { input_.end(); }
    bool isFull() const override { return input_.waiting() > MAX_WAITING; }
    void step(double now_s) override;
    std::string &output() override { return output_; }
    /// True while it waits for the machine or jogs it.
    bool isBusy() const override { return wait_.has_value() || commander_.isJogging(); }
    bool isOver() const override { return isOver_; }
    bool wantsShutdown() const override { return wantsShutdown_; }

  private:
    /// Maximum size of waiting input, and of unread answers, before no more input is accepted.
    static constexpr std::size_t MAX_WAITING = 65536;

    struct Wait {
        std::string order;
        Waiting what;
        double end_s = 0;               ///< 0: no limit
        std::uint64_t shown_cycle = 0;  ///< task cycle after which the status shows the end; 0: not ended
    };

    std::optional<std::string> next_line();
    void carry_out(const std::string &line, double now_s);
    void hello(const Words &words);
    void get(const Words &words);
    void set(const Words &words, const std::string &rest, double now_s);
    void shut_down();
    std::optional<std::string> lacks(const Order &order) const;
    void look_at_wait(double now_s);
    /// Nothing before the end; else an error, empty if the machine has reported it.
    std::optional<Result<>> end_of(const Waiting &waiting);
    bool isProbeWithoutContact(const client::Outcome &outcome) const;

    void say(const std::string &line, const char *end = "\r\n");
    void tell_error(const std::string &text);
    void consent(const std::string &order);
    void refuse(const std::string &order, const std::string &why);

    const Settings &settings_;
    SharedView &shared_;
    Commander commander_;
    OwnState own_;
    std::deque<std::string> errors_;
    LineInput input_;
    std::string output_;
    std::optional<Wait> wait_;
    bool isOver_ = false, wantsShutdown_ = false;
};

}  // namespace mw::rsh
