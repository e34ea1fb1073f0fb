// SPDX-License-Identifier: GPL-2.0-or-later
// The sender of a command, and the rights of the run that it starts (docs/integrator/security.md).
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "machine/task/sequencer/confinement.hh"
#include "machine/task/states/jog_guard.hh"
#include "messages/mailbox/command_server.hh"
#include "messages/mailbox/memory.hh"
#include "messages/mailbox/process_watch.hh"

namespace mw::task {

/// One thread; never blocks.
class Senders {
  public:
    using Authority = mailbox::Authority;
    /// The confinement must outlive this object.
    explicit Senders(const Confinement &confinement)
        : confinement_(confinement),
          jogs_({[this](std::uint64_t owner) { return processes_.state_of(owner); },
                 [this](std::uint64_t owner) { processes_.forget(owner); }}) {}
    Senders(const Senders &) = delete;
    Senders &operator=(const Senders &) = delete;

    /// Scope of executing a command. Scopes may be nested: a stop during a long call of another command.
    class Sending {
      public:
        Sending(Senders &senders, const mailbox::CommandServer::Delivery &delivery)
            : senders_(senders), before_(std::exchange(senders.sender_, delivery.authority)) {}
        ~Sending() { senders_.sender_ = before_; }
        Sending(const Sending &) = delete;
        Sending &operator=(const Sending &) = delete;

      private:
        Senders &senders_;
        Authority before_;
    };
    Authority sender() const { return sender_; }
    /// An error if task may not open this file for the sender.
    Result<> check_file(const std::string &path) const {
        return sender_ == Authority::CONFIGURE ? Result<>{} : check_program(confinement_, path);
    }
    void note_opened() { opener_ = sender_; }
    /// Authority for a run of the open program: the lower authority of the clients that opened and started
    /// it.
    Authority of_program() const { return std::min(sender_, opener_); }

    void begin_run(Authority authority) { run_ = authority; }
    /// For a run with lower authority that continues.
    void limit_run() { run_ = opener_ = Authority::OPERATE; }
    bool isRunConfined() const { return run_ != Authority::CONFIGURE; }
    /// Restrictions of the run, and of the clean-up after it; null: any file.
    const Confinement *confinement() const { return isRunConfined() ? &confinement_ : nullptr; }

    /// Called when the command was accepted. Jogs of panels and of this process need no guard.
    void note_taken(const mailbox::CommandServer::Delivery &delivery) {
        const bool guarded = !delivery.isPanel && delivery.owner != own_process_;
        jogs_.note(delivery.command, guarded ? delivery.owner : 0);
    }
    std::vector<JogGuard::Left> left_jogs(const motion::Status &motion) { return jogs_.step(motion); }

  private:
    const Confinement &confinement_;
    Authority sender_ = Authority::CONFIGURE;
    Authority opener_ = Authority::CONFIGURE;  ///< of the client that opened the program
    Authority run_ = Authority::CONFIGURE;     ///< of the current or last run
    const std::uint64_t own_process_ = mailbox::owner_word();
    mailbox::ProcessWatch processes_;
    JogGuard jogs_;
};

}  // namespace mw::task
