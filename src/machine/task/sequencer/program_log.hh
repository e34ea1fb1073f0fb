// SPDX-License-Identifier: GPL-2.0-or-later
// A file that a program writes: (logopen,...) or (probeopen ...). Task never waits for the disk.
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

/// Files of the computer. All calls may block.
class LogDisk {
  public:
    virtual ~LogDisk() = default;
    /// Returns a descriptor. `confinement` is that of a run that may only operate; null otherwise.
    virtual Result<int> open(const std::string &path, bool appending, const Confinement *confinement);
    virtual Result<> write(int file, std::string_view text);
    virtual Result<> close(int file);
};

enum class LogWorks : std::uint8_t {
    ALONE,    ///< in a separate thread
    ON_CALL,  ///< in each call, for virtual clocks
};

/// Opens, writes and closes in the order of the calls; each line reaches the file as soon as the disk accepts
/// it. Called by one thread; does not wait for the disk.
class ProgramLog {
  public:
    explicit ProgramLog(LogWorks works, std::shared_ptr<LogDisk> disk = std::make_shared<LogDisk>());
    /// Waits at most 0.5 s for pending lines; reports lost lines on standard error.
    ~ProgramLog();
    ProgramLog(const ProgramLog &) = delete;
    ProgramLog &operator=(const ProgramLog &) = delete;

    /// Opens a file after closing the open one, which may be the same file. The result is in opened().
    void open(const std::string &path, bool appending, const Confinement *confinement = nullptr);
    /// Nothing until the last open() is done.
    std::optional<Result<>> opened() const;
    /// No effect when no file is open. An error when more than 1 MB waits for the disk: later lines are not
    /// written to this file.
    Result<> write(const std::string &line);
    /// Drops an open() that has not started.
    void close();

    /// Reason why lines are lost; returned once.
    std::optional<Error> take_failure();
    /// Message that the disk has not answered for 1 s; returned once.
    std::optional<std::string> take_delay();
    /// True if all lines are in the files and the files are closed, or the disk has not answered for 1 s.
    /// After a failure it is false until take_failure() was called.
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
    bool open_ = false;
    std::thread thread_;
};

}  // namespace mw::task
