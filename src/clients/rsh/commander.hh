// SPDX-License-Identifier: GPL-2.0-or-later
// The client of the machine for an enabled connection. Its jogs stop when it ends.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "messages/client/client.hh"

namespace mw::rsh {

using Joining = std::function<Result<client::Client>()>;

/// The joint or axis of a jog.
struct JogTarget {
    bool isJoint = true;
    int index = 0;
    bool operator==(const JogTarget &) const = default;
};

/// All calls come from one thread. Continuous jogs have a lease that keep_jogging() renews. They end when
/// this program hangs or dies, and when the object is destroyed.
class Commander {
  public:
    explicit Commander(Joining joining) : joining_(std::move(joining)) {}
    ~Commander() { stop_jogs(); }
    Commander(const Commander &) = delete;
    Commander &operator=(const Commander &) = delete;

    /// Becomes a client unless it is one already.
    Result<> connect();
    Result<client::Serial> post(const messages::Command &command);
    client::Outcome outcome(client::Serial serial) { return client_->outcome(serial); }
    /// The commands that were posted together last.
    const std::vector<client::Serial> &last() const { return last_; }
    void begin_order() { isFresh_ = true; }

    Result<client::Serial> jog(const JogTarget &target, double velocity);
    Result<client::Serial> stop_jog(const JogTarget &target);
    void stop_jogs();
    bool isJogging() const { return !jogs_.empty(); }
    void keep_jogging(double now_s);

  private:
    struct Jog {
        JogTarget target;
        double velocity = 0;
        client::Serial serial = 0;  ///< command that started the jog, then its last renewal
        double renewed_s = -1;
    };

    Joining joining_;
    std::optional<client::Client> client_;
    std::vector<client::Serial> last_;
    bool isFresh_ = false;
    std::vector<Jog> jogs_;
};

}  // namespace mw::rsh
