// SPDX-License-Identifier: GPL-2.0-or-later
// Connects the agent to the HTTP server of the screen.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "clients/publish/mtconnect/agent.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::publish::mtconnect {

/// For one thread, that of the server.
class Service final : public screen::Application {
  public:
    /// Time of day, and a monotonic time.
    struct Clock {
        std::function<TimeMs()> utc_ms;
        std::function<double()> steady_s;
    };
    Service(const Agent &agent, Clock clock);

    void answer(const screen::Request &request, screen::Reply reply) override;
    void opened(screen::SessionId, screen::Role, screen::Protection) override {}
    void received(screen::SessionId, std::string_view) override {}
    void closed(screen::SessionId) override {}

    /// Sends due documents of streams. True while there are streams.
    bool tick();

  private:
    struct Running {
        Stream stream;
        std::shared_ptr<screen::PieceQueue> pieces;
    };

    const Agent &agent_;
    Clock clock_;
    std::vector<Running> streams_;
};

}  // namespace mw::publish::mtconnect
