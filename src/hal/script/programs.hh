// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that HAL files start with loadusr: as processes, or as parts of this process.
#pragma once

#include <csignal>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/instance.hh"

namespace mw::hal::script {

struct ProgramRequest {
    enum class Wait { NO, UNTIL_READY, UNTIL_END };

    std::vector<std::string> argv;  ///< program and arguments
    Wait wait = Wait::NO;
    std::string component;       ///< its HAL component: named with -Wn, else the program's base name
    bool ignoresStatus = false;  ///< with UNTIL_END: any exit status is accepted
};

enum class ProgramStart {
    RUNNING,  ///< started; also ready or ended, if the command waits for that
    LEFT_OUT  ///< not started here: its pins will not exist
};

class ProgramHost {
  public:
    virtual ~ProgramHost() = default;
    virtual Result<ProgramStart> start(const ProgramRequest &request) = 0;
    /// Requests the program of a component to end (SIGTERM).
    virtual Result<> stop(const std::string &component) = 0;
    /// Ends all programs with components, and all programs started here without a component; returns when
    /// they have ended.
    virtual Result<> stop_all() = 0;
    /// Waits until the component is removed.
    virtual Result<> wait_for_end(const std::string &component) = 0;
};

/// Starts processes; finds them through PATH. [one thread, not realtime]
class SystemProgramHost final : public ProgramHost {
  public:
    /// Waiting fails when `stop` is not null and *stop is not zero.
    explicit SystemProgramHost(Instance &hal, const volatile std::sig_atomic_t *stop = nullptr)
        : hal_(hal), stop_(stop) {}

    Result<ProgramStart> start(const ProgramRequest &request) override;
    Result<> stop(const std::string &component) override;
    Result<> stop_all() override;
    Result<> wait_for_end(const std::string &component) override;
    /// True if a program was started. It may create a component later.
    bool hasStarted() const noexcept { return started_; }

  private:
    Result<> wait_until_ready(const ProgramRequest &request, int pid);
    Result<> wait_for_status(const ProgramRequest &request, int pid);
    static bool isProgram(const CompInfo &component);
    bool isProgramLeft() const;
    bool isComponent(int pid) const;
    void await_end(long longest_ns);
    void kill_programs();
    void reap();

    Instance &hal_;
    bool isStopped() const { return stop_ != nullptr && *stop_ != 0; }

    const volatile std::sig_atomic_t *stop_;
    std::vector<int> children_;
    bool started_ = false;
};

/// For the virtual clock: creates programs that exist as parts of this process; starts no others.
class InProcessProgramHost final : public ProgramHost {
  public:
    using Part = std::function<Result<>(const ProgramRequest &request)>;

    /// `make` is called for `loadusr ... NAME ...`, with any folder in the name.
    void add_part(const std::string &program, Part make) { parts_[program] = std::move(make); }

    Result<ProgramStart> start(const ProgramRequest &request) override;
    Result<> stop(const std::string &component) override;
    Result<> stop_all() override { return {}; }
    Result<> wait_for_end(const std::string &component) override;

  private:
    std::map<std::string, Part> parts_;
};

/// The last part of a path.
std::string base_name(const std::string &path);

}  // namespace mw::hal::script
