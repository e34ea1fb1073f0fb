// SPDX-License-Identifier: GPL-2.0-or-later
// The routes of docs/reference/api.md.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "clients/screen/files/files.hh"
#include "clients/screen/files/message_log.hh"
#include "clients/screen/files/offered_programs.hh"
#include "clients/screen/files/user_files.hh"
#include "clients/screen/hal/hal_service.hh"
#include "clients/screen/http/background_jobs.hh"
#include "clients/screen/path/time_chunks.hh"
#include "clients/screen/session/screens.hh"

namespace mw::screen {

struct ApiSetup {
    MachineFacts facts;
    ScreensSetup screens;
    std::string screen_folder;
    /// Begins to read a program in a separate thread. An error if too many programs are being read. The path
    /// is in the folder facts.program_prefix.
    std::function<Result<std::shared_ptr<PieceQueue>>(const std::string &path, const Requester &)> read_path;
    /// As above, for the times of the program at these overrides.
    std::function<Result<std::shared_ptr<PieceQueue>>(const std::string &path, const TimeOverrides &,
                                                      const Requester &)>
        read_times{};
    /// As above, for a filter that converts `path` to `made`.
    std::function<Result<std::shared_ptr<PieceQueue>>(const std::string &path, const std::string &made,
                                                      const Requester &)>
        run_filter{};
    HalService::Connect connect_hal;
    std::vector<DialogFacts> dialogs{};
    HalService::Begin begin_hal{};
    std::string offers_folder{};  ///< for OfferedPrograms
};

/// Threads for blocking work, so that one does not wait for the other; both end before the Api.
struct Threads {
    BackgroundJobs &disk, &hal;
};

/// One thread, except for the jobs that it passes to `threads`.
class Api final : public Application {
  public:
    /// Monotonic time. [ns]
    using Clock = std::function<std::int64_t()>;

    /// Interval between two reads of the HAL values that screens show.
    static constexpr std::int64_t WATCH_NS = 100000000;

    Api(Sockets &sockets, const Threads &threads, ApiSetup setup, Clock clock);

    /// Call it every few milliseconds.
    void tick();

    void answer(const Request &request, Reply reply) override;
    void read(std::shared_ptr<BodySource> source, std::function<void(std::string)> take) override;
    void opened(SessionId session, Role role, Protection protection) override {
        screens_.opened(session, {role, protection}, clock_());
    }
    void received(SessionId session, std::string_view text) override {
        screens_.received(session, text, clock_());
    }
    void closed(SessionId session) override;

    std::size_t count_screens() const { return screens_.count(); }

  private:
    void answer_files(const Request &request, const std::string &name, Reply reply);
    void write_file(const Request &request, const std::string &name, Reply reply);
    void answer_offers(const Request &request, Reply reply);
    void write_log(const std::string &line, std::int64_t age_ns);
    bool isKeepsake(const Request &request, Reply &reply);
    Role needed_role(const Request &request) const;
    void answer_hal(const Request &request, Reply reply);
    void look_at_hal();
    Response answer_path(const Request &request);
    Response answer_times(const Request &request);
    Response answer_filter(const Request &request);
    /// Path of the program that a filter has created, or would create, from a file; nothing if the file is a
    /// program.
    std::optional<std::string> made_of(const std::string &name) const;
    /// The program that is interpreted when this file is opened.
    Result<std::string> program_of(const std::string &name) const;
    Response answer_tools();
    Response metrics() const;

    Threads threads_;
    ApiSetup setup_;
    Clock clock_;
    Screens screens_;
    ProgramFiles files_;      ///< used only by jobs
    OfferedPrograms offers_;  ///< used only by jobs
    UserFiles keepsakes_;
    MessageLog log_;                     ///< used only by jobs
    std::vector<std::string> operable_;  ///< HAL names that operators may set by panels
    HalService hal_;                     ///< used only by jobs
    bool hasHalBegun_ = false;           ///< work that waits for HAL is done
    bool hal_read_ = false;              ///< HAL is being read
    std::int64_t next_watch_ns_ = 0;
};

}  // namespace mw::screen
