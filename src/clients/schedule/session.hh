// SPDX-License-Identifier: GPL-2.0-or-later
// A connection of schedrmt, which reads and answers one line after the other. Its answers are those of
// LinuxCNC 2.9.
#pragma once

#include <string>
#include <string_view>

#include "clients/rsh/conversation.hh"
#include "clients/rsh/line_input.hh"
#include "clients/rsh/settings.hh"
#include "clients/rsh/shared_view.hh"
#include "clients/rsh/words.hh"
#include "clients/schedule/scheduler.hh"

namespace mw::schedule {

/// Settings of one connection.
struct OwnState {
    bool greeted = false;    ///< HELLO was sent with the correct password
    bool isEnabled = false;  ///< may command the queue
    bool isEchoing = true;
    bool isVerbose = false;
    std::string protocol = "1.1";
};

/// Objects shared by all connections; all must outlive the connections.
struct Shared {
    const rsh::Settings &settings;
    rsh::SharedView &view;
    Scheduler &scheduler;
};

/// All calls come from one thread. Programs that a connection has started continue when it ends, because the
/// queue belongs to the server.
class Session final : public rsh::Conversation {
  public:
    explicit Session(const Shared &shared) : shared_(shared) {}

    void take(std::string_view bytes) override { input_.take(bytes); }
    void end_input() override { input_.end(); }
    bool isFull() const override { return input_.waiting() > MAX_WAITING; }
    void step(double now_s) override;
    std::string &output() override { return output_; }
    bool isBusy() const override { return false; }
    bool isOver() const override { return isOver_; }
    bool wantsShutdown() const override { return wantsShutdown_; }

  private:
    /// Maximum size of waiting input, and of unread answers, before no more input is accepted.
    static constexpr std::size_t MAX_WAITING = 65536;

    void carry_out(const std::string &line);
    void hello(const rsh::Words &words);
    void get(const rsh::Words &words);
    void set(const rsh::Words &words);
    void shut_down();
    void say(const std::string &line, const char *end = "\r\n");
    void refuse(const std::string &order, const std::string &why);

    Shared shared_;
    OwnState own_;
    rsh::LineInput input_;
    std::string output_;
    bool isOver_ = false, wantsShutdown_ = false;
};

}  // namespace mw::schedule
