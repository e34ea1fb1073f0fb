// SPDX-License-Identifier: GPL-2.0-or-later
// A connection of schedrmt: lines in, lines out, one after another. Its answers are those of LinuxCNC 2.9's.
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

/// What a connection has set for itself.
struct OwnState {
    bool greeted = false;    ///< HELLO with the right password
    bool isEnabled = false;  ///< may command the queue
    bool isEchoing = true;
    bool isVerbose = false;
    std::string protocol = "1.1";
};

/// What all connections share; everything must outlive them.
struct Shared {
    const rsh::Settings &settings;
    rsh::SharedView &view;
    Scheduler &scheduler;
};

/// One thread. What a connection has started continues when it ends: the queue is the server's.
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
    /// Bytes that wait in here, and answers that are not read, before others are taken.
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
