// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps what must outlive a power cut: the journal of the program that runs, and small files that change
// while it does. Whoever asks never waits for the disk.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "journal/disk.hh"
#include "journal/records.hh"

namespace mw::journal {

/// What was there when the machine started.
struct Found {
    std::optional<Run> run;  ///< one that has not ended
    std::string refusal;     ///< why it cannot be gone on with; empty: nothing is known against it
};

enum class Works : std::uint8_t {
    ALONE,    ///< in a thread of its own
    ON_CALL,  ///< in work(): for virtual clocks
};

/// What is asked is done in its order, each part synced before the next; a progress or a file that waits is
/// overtaken by the next one. Asked by one thread.
class Writer {
  public:
    /// `path`: of the journal; empty: runs are not journalled.
    Writer(std::unique_ptr<Disk> disk, std::string path, Works works);
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;
    /// Does all that is asked first.
    ~Writer();

    bool isOn() const { return !path_.empty(); }
    const Found &found() const { return found_; }

    /// From here on the journal is of this run; with `progress` of one that is gone on with. The program's
    /// mark is made where it is not known.
    void begin(Start start, std::optional<Progress> progress = {}, std::optional<Doubt> doubt = {});
    void note(const Progress &progress);
    void note(const Doubt &doubt);
    /// It has ended in order.
    void end();
    /// Nobody wants to go on with it: there is no journal any more.
    void forget();
    void keep_file(const std::string &path, std::string text, Old old = Old::DROPPED);
    /// Waits for the disk: the file has this text when it returns, and nothing that was asked before comes
    /// over it.
    Result<> write_file(const std::string &path, const std::string &text, Old old = Old::DROPPED);

    /// What the operator is to know, once.
    std::optional<std::string> take_trouble();
    /// With Works::ON_CALL: does what was asked; false when there was nothing.
    bool work();

  private:
    enum class Kind : std::uint8_t { BEGIN, PROGRESS, DOUBT, END, FORGET, FILE };
    struct Job {
        Kind kind = Kind::END;
        Run run;  ///< of BEGIN; the field in question of PROGRESS and DOUBT
        std::string path, text;
        std::uint64_t number = 0;  ///< counts what is asked
        Old old = Old::DROPPED;    ///< of FILE
    };
    using Jobs = std::deque<Job>;

    void find();
    void ask(Job job);
    void run_thread();
    void do_jobs(Jobs &jobs);
    Result<> do_job(Job &job);
    Result<> do_file(const Job &job);
    Result<> put_file(const std::string &path, const std::string &text, Old old);
    Result<> begin_file(Job &job);
    Result<> write_records();
    Result<> rewrite();
    void tell(const Result<> &result);

    std::unique_ptr<Disk> disk_;  ///< from the start on under disk_mutex_
    std::string path_;
    Found found_;

    std::mutex mutex_;
    std::condition_variable asked_;
    Jobs jobs_;                           ///< under the mutex
    std::optional<std::string> trouble_;  ///< under the mutex
    bool isEnding_ = false;               ///< under the mutex
    std::uint64_t last_job_ = 0;          ///< under the mutex

    std::mutex disk_mutex_;                         ///< never taken within mutex_; the disk is used under it
    std::map<std::string, std::uint64_t> written_;  ///< files by write_file(): which job; under that mutex

    // Of whoever works.
    std::optional<Run> run_;    ///< as the file says it
    std::uint64_t key_ = 0;     ///< of its records
    std::string records_;       ///< to be appended
    std::uint64_t bytes_ = 0;   ///< of the file
    bool isFileSound_ = false;  ///< records may be appended to it
    bool isTroubleTold_ = false;
    std::thread thread_;
};

}  // namespace mw::journal
