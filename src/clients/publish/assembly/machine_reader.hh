// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the machine and passes on changes. It cannot command the machine.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "clients/publish/mtconnect/agent.hh"
#include "clients/publish/readings.hh"
#include "clients/publish/sparkplug/live_data.hh"
#include "messages/client/viewer.hh"

namespace mw::publish {

/// All calls come from one thread. Waits for a machine that is not running, and follows a restart.
class MachineReader {
  public:
    /// The machine, while it runs.
    using Attach = std::function<Result<client::Viewer>()>;

    /// The last message that was passed on: its number, and the run of the machine.
    struct Mark {
        std::uint64_t run = 0, number = 0;
    };

    /// `data` and `agent` receive the values; either may be null.
    MachineReader(Attach attach, Deadbands deadbands, LiveData *data, mtconnect::Agent *agent)
        : attach_(std::move(attach)), readings_(std::move(deadbands)), data_(data), agent_(agent) {}
    /// Messages up to `mark` were passed on before; `keep` stores each newer mark.
    void set_mark(const Mark &mark, std::function<void(const Mark &)> keep) {
        mark_ = mark;
        keep_ = std::move(keep);
    }

    /// Reads once. `steady_ns` is CLOCK_MONOTONIC.
    void step(TimeMs now, std::int64_t steady_ns);
    bool isAttached() const { return viewer_.has_value(); }

  private:
    void look_for_machine(TimeMs now, std::int64_t steady_ns);
    void end(TimeMs now);
    void pass_all(TimeMs now);
    void pass_messages(TimeMs now);
    void pass(const std::vector<Change> &changes, TimeMs now);

    Attach attach_;
    Readings readings_;
    LiveData *data_;
    mtconnect::Agent *agent_;
    std::optional<client::Viewer> viewer_;
    std::int64_t look_at_ns_ = 0;  ///< next search for a machine
    Mark mark_;
    std::function<void(const Mark &)> keep_;
};

}  // namespace mw::publish
