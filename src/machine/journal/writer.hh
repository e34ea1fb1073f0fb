// SPDX-License-Identifier: GPL-2.0-or-later
// Stores data that must survive a power cut: the journal of the running program, and small files that change
// while it runs. A separate thread accesses the disk.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "machine/journal/disk.hh"
#include "machine/journal/records.hh"

namespace mw::journal {

/// State on disk when the machine started.
struct Found {
    std::optional<Run> run;  ///< a run that has not ended
    std::string refusal;     ///< reason why the run cannot be continued; empty: no reason is known
};

enum class Works : std::uint8_t {
    ALONE,    ///< in a separate thread
    ON_CALL,  ///< in work(), for virtual clocks
};

/// Executes jobs in the order of the calls, and syncs each part before the next. A new progress replaces a
/// waiting one; a new text of a file replaces its waiting text. One thread calls the methods. A method waits
/// for the disk only if its comment states this.
class Writer {
  public:
    /// `path` of the journal; empty: runs are not journalled.
    Writer(std::unique_ptr<Disk> disk, std::string path, Works works);
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;
    ~Writer() { finish(); }

    bool isOn() const;
    const Found &found() const;

    /// Starts the journal of this run; `progress` is that of a continued run. Determines the program's mark
    /// if it is unknown.
    void begin(Start start, std::optional<Progress> progress = {}, std::optional<Doubt> doubt = {});
    void note(const Progress &progress);
    void note(const Doubt &doubt);
    /// The run has ended normally.
    void end();
    /// The run will not be continued: removes the journal.
    void forget();

    /// Replaces a file. A text that cannot be written is kept. It is written again with the next text of the
    /// file, before the file is read, and in finish().
    void keep_file(const std::string &path, std::string text, Old old = Old::DROPPED);
    /// Waits for the disk, at most 1 s, and not if take_delay() has found it late. After success the file has
    /// this text, and no earlier text replaces it. If the disk answers later, it still writes the text.
    Result<> write_file(const std::string &path, const std::string &text, Old old = Old::DROPPED);
    /// Reads a file after its pending texts have been written; an error when writing fails. `then` is called
    /// in the thread of the disk.
    using Then = std::function<void(Result<std::string>)>;
    void read_file(const std::string &path, Then then);
    /// True if the file has its last text, or writing has failed, or take_delay() has found the disk late.
    bool isSettled(const std::string &path) const;

    /// Message for the operator; each message is returned once.
    std::optional<std::string> take_trouble();
    /// The file for which the disk has not answered in 1 s; returned once. Call it in each cycle at clock
    /// time `now_ns`.
    std::optional<std::string> take_delay(std::int64_t now_ns);
    /// With Works::ON_CALL: executes the jobs; false when there were none.
    bool work();
    /// No calls are permitted afterwards. Waits for all jobs, at most 0.5 s with a thread; then names
    /// unwritten files on standard error.
    void finish();

  private:
    struct Job;
    class Core;

    std::shared_ptr<Core>
        core_;  ///< shared with the thread, which outlives this object while its disk does not answer
    std::thread thread_;
    bool finished_ = false;
};

}  // namespace mw::journal
