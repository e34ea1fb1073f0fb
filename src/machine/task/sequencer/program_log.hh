// SPDX-License-Identifier: GPL-2.0-or-later
// A file that a program writes: (logopen,...) or (probeopen ...). Task never waits for its disk.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "base/result.hh"
#include "machine/task/sequencer/confinement.hh"

namespace mw::task {

/// The files of the computer. All calls may block.
class LogDisk {
  public:
    virtual ~LogDisk() = default;
    /// A descriptor. `confinement`: of a run that has only the authority to operate; null otherwise.
    virtual Result<int> open(const std::string &path, bool isAppending, const Confinement *confinement);
    virtual Result<> write(int file, std::string_view text);
    virtual Result<> close(int file);
};

enum class LogWorks : std::uint8_t {
    ALONE,    ///< in a thread of the log
    ON_CALL,  ///< within each call: for virtual clocks
};

/// Opens, writes and closes in the order of the calls; each line reaches the file as soon as the disk takes
/// it. Called by one thread, which never waits for the disk.
class ProgramLog {
  public:
    explicit ProgramLog(LogWorks works, std::shared_ptr<LogDisk> disk = std::make_shared<LogDisk>());
    /// Waits at most 0.5 s for what is still to be written; what does not fit is reported on standard error.
    ~ProgramLog();
    ProgramLog(const ProgramLog &) = delete;
    ProgramLog &operator=(const ProgramLog &) = delete;

    /// Closes what is open before; the same file may be opened again. Answered by opened().
    void open(const std::string &path, bool isAppending, const Confinement *confinement = nullptr);
    /// Nothing while the last open() is not done.
    std::optional<Result<>> opened() const;
    /// Nothing happens when none is open. An error when more than 1 MB waits for the disk: nothing more is
    /// written into this file, and earlier lines are.
    Result<> write(const std::string &line);
    /// An open() that has not begun is dropped.
    void close();

    /// Why lines are lost, once.
    std::optional<Error> take_failure();
    /// That the disk has not answered for 1 s, once.
    std::optional<std::string> take_delay();
    /// All is in the files, and they are closed where they were to be; or the disk has not answered for 1 s.
    /// Not before take_failure() where there is one.
    bool isSettled() const;

  private:
    struct Job;
    struct Shared;
    static void work(Shared &shared);
    static void run_thread(const std::shared_ptr<Shared> &shared);
    void ask(Job job);

    LogWorks works_;
    std::shared_ptr<Shared> shared_;
    std::string path_;  ///< as named by the program
    bool isOpen_ = false;
    std::thread thread_;
};

}  // namespace mw::task
