// SPDX-License-Identifier: GPL-2.0-or-later
// The data that a writer shares with its thread, and the processing of its jobs.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <vector>

#include "machine/journal/writer.hh"

namespace mw::journal {

struct Writer::Job {
    enum class Kind : std::uint8_t { BEGIN, PROGRESS, DOUBT, END, FORGET, FILE, READ };
    Kind kind = Kind::END;
    Run run{};  ///< for BEGIN; PROGRESS and DOUBT use one field of it
    std::string path{}, text{};
    Old old = Old::DROPPED;    ///< for FILE
    bool awaited = false;      ///< for FILE: the caller waits for the error
    Then then{};               ///< for READ
    std::uint64_t number = 0;  ///< number of the job
};

/// The mutex is never locked during disk access. Either the thread or the caller runs work().
class Writer::Core {
  public:
    Core(std::unique_ptr<Disk> disk_of_files, std::string journal_path)
        : disk_(std::move(disk_of_files)), path_(std::move(journal_path)) {}

    bool isJournalled() const { return !path_.empty(); }
    /// Called before the thread starts.
    void find();
    const Found &found() const { return found_; }
    void ask(Job job);
    void run_thread();
    /// False when there were no jobs.
    bool work();
    /// Writes the files again that failed before.
    void write_failed();
    bool isSettled(const std::string &path) const;
    /// Result of the last write of the file.
    Result<> wait_for(const std::string &path, std::chrono::milliseconds longest);
    /// True when the thread has executed all jobs and ended.
    bool end_thread(std::chrono::milliseconds longest);
    /// Files whose last text is not on the disk, with the reasons.
    std::vector<std::string> unwritten() const;
    std::optional<std::string> take_trouble();
    std::optional<std::string> take_delay(std::int64_t now_ns);

  private:
    using Jobs = std::deque<Job>;
    /// State of a file being written.
    struct FileState {
        std::uint64_t asked = 0, done = 0;  ///< numbers of jobs
        std::optional<Error> failure{};     ///< of the last completed job
        bool reported = false;              ///< the failure has been reported
    };

    void do_jobs(Jobs &jobs);
    Result<> do_job(Job &job);
    void do_file(Job &job);
    void do_read(const Job &job);
    Result<> put_file(const Job &job);
    Result<> begin_file(Job &job);
    Result<> write_records();
    Result<> rewrite();
    void tell(const Result<> &result);
    void set_busy(std::uint64_t number, const std::string &path);
    bool isBehind() const;

    Found found_;
    mutable std::mutex mutex_;  ///< guards the members up to last_job_
    std::condition_variable asked_, done_;
    std::deque<std::string> troubles_;
    std::uint64_t busy_job_ = 0;  ///< number of the job that uses the disk; 0: none
    std::string busy_path_;
    bool late_ = false;              ///< that job is late
    std::uint64_t watched_job_ = 0;  ///< number of the job watched by take_delay()
    std::int64_t watched_since_ns_ = 0;
    Jobs jobs_;
    std::map<std::string, FileState> files_;
    bool ending_ = false, ended_ = false;
    std::uint64_t last_job_ = 0;

    // Used by the working thread.
    std::unique_ptr<Disk> disk_;
    const std::string path_;             ///< path of the journal
    std::map<std::string, Job> failed_;  ///< files, by their paths
    std::optional<Run> run_;             ///< content of the journal
    std::uint64_t key_ = 0;              ///< key of its records
    std::string records_;                ///< records to append
    std::uint64_t bytes_ = 0;            ///< size of the journal
    bool file_sound_ = false;            ///< records may be appended to the journal
    bool hadProgress_ = false;           ///< the last jobs included progress
    bool trouble_reported_ = false;
};

}  // namespace mw::journal
