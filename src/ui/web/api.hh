// SPDX-License-Identifier: GPL-2.0-or-later
// The routes of docs/api.md.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "ui/web/elsewhere.hh"
#include "ui/web/files.hh"
#include "ui/web/screens.hh"

namespace mw::ui::web {

struct ApiSetup {
    MachineFacts facts;
    ScreensSetup screens;
    std::string screen_folder;
    /// Begins to read a program in a thread of its own; an error when too many are read. The path is one of
    /// facts.program_prefix.
    std::function<Result<std::shared_ptr<PieceQueue>>(const std::string &path)> read_path;
};

/// One thread, but for the jobs that it gives to `elsewhere`, which must end before it.
class Api final : public Application {
  public:
    /// Time that never goes back. [ns]
    using Clock = std::function<std::int64_t()>;

    Api(Sockets &sockets, Elsewhere &elsewhere, ApiSetup setup, Clock clock);

    /// Every few milliseconds.
    void tick() { screens_.tick(clock_()); }

    void answer(const Request &request, Reply reply) override;
    void opened(SessionId session) override { screens_.opened(session, clock_()); }
    void received(SessionId session, std::string_view text) override {
        screens_.received(session, text, clock_());
    }
    void closed(SessionId session) override { screens_.closed(session); }

    std::size_t count_screens() const { return screens_.count(); }

  private:
    void answer_files(const Request &request, const std::string &name, Reply reply);
    void write_file(const Request &request, const std::string &name, Reply reply);
    Response answer_path(const Request &request);
    Response answer_tools();
    Response metrics() const;

    Elsewhere &elsewhere_;
    ApiSetup setup_;
    Clock clock_;
    Screens screens_;
    ProgramFiles files_;  ///< used by jobs alone
};

}  // namespace mw::ui::web
