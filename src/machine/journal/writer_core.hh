// SPDX-License-Identifier: GPL-2.0-or-later
// What a writer shares with its thread, and how its jobs are done.
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
    Run run{};  ///< of BEGIN; the field in question of PROGRESS and DOUBT
    std::string path{}, text{};
    Old old = Old::DROPPED;    ///< of FILE
    bool isWaitedFor = false;  ///< of FILE: the caller gets the error
    Then then{};               ///< of READ
    std::uint64_t number = 0;  ///< counts what is asked
};

/// Its mutex is never locked while the disk is used. One thread calls work(), or the one that asks.
class Writer::Core {
  public:
    Core(std::unique_ptr<Disk> disk_of_files, std::string journal_path)
        : disk_(std::move(disk_of_files)), path_(std::move(journal_path)) {}

    bool isJournalled() const { return !path_.empty(); }
    /// Before the thread begins.
    void find();
    const Found &found() const { return found_; }
    void ask(Job job);
    void run_thread();
    /// False when there was nothing to do.
    bool work();
    /// Writes the files again that could not be written.
    void write_failed();
    bool isSettled(const std::string &path) const;
    /// How the last write of the file has ended.
    Result<> wait_for(const std::string &path, std::chrono::milliseconds longest);
    /// True: the thread has done all that was asked, and ended.
    bool end_thread(std::chrono::milliseconds longest);
    /// Each file whose last text is not on the disk, and why.
    std::vector<std::string> unwritten() const;
    std::optional<std::string> take_trouble();
    std::optional<std::string> take_delay(std::int64_t now_ns);

  private:
    using Jobs = std::deque<Job>;
    /// A file that is written.
    struct FileState {
        std::uint64_t asked = 0, done = 0;  ///< numbers of jobs
        std::optional<Error> failure{};     ///< of the last one that is done
        bool isToldOf = false;              ///< the failure
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
    mutable std::mutex mutex_;  ///< of the members up to last_job_
    std::condition_variable asked_, done_;
    std::deque<std::string> troubles_;
    std::uint64_t busy_job_ = 0;  ///< that uses the disk; 0: none
    std::string busy_path_;
    bool isLate_ = false;            ///< that job
    std::uint64_t watched_job_ = 0;  ///< of take_delay()
    std::int64_t watched_since_ns_ = 0;
    Jobs jobs_;
    std::map<std::string, FileState> files_;
    bool isEnding_ = false, isOver_ = false;
    std::uint64_t last_job_ = 0;

    // Of the thread that works.
    std::unique_ptr<Disk> disk_;
    const std::string path_;             ///< of the journal
    std::map<std::string, Job> failed_;  ///< files, by their paths
    std::optional<Run> run_;             ///< as the file says it
    std::uint64_t key_ = 0;              ///< of its records
    std::string records_;                ///< to be appended
    std::uint64_t bytes_ = 0;            ///< of the file
    bool isFileSound_ = false;           ///< records may be appended to it
    bool hadProgress_ = false;           ///< among the last jobs
    bool isTroubleTold_ = false;
};

}  // namespace mw::journal
