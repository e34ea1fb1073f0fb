// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps what must outlive a power cut: the journal of the program that runs, and small files that change
// while it does. The disk is used by a separate thread.
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

/// What was there when the machine started.
struct Found {
    std::optional<Run> run;  ///< one that has not ended
    std::string refusal;     ///< why it cannot be gone on with; empty: nothing is known against it
};

enum class Works : std::uint8_t {
    ALONE,    ///< in a thread of its own
    ON_CALL,  ///< in work(): for virtual clocks
};

/// Does jobs in the order of the calls, and syncs each part before the next. A new progress replaces one that
/// waits; a new text of a file replaces its text that waits. One thread calls the methods. It waits for the
/// disk only in those whose comment mentions it.
class Writer {
  public:
    /// `path`: of the journal; empty: runs are not journalled.
    Writer(std::unique_ptr<Disk> disk, std::string path, Works works);
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;
    ~Writer() { finish(); }

    bool isOn() const;
    const Found &found() const;

    /// From here on the journal is of this run; with `progress` of one that is gone on with. The program's
    /// mark is made where it is not known.
    void begin(Start start, std::optional<Progress> progress = {}, std::optional<Doubt> doubt = {});
    void note(const Progress &progress);
    void note(const Doubt &doubt);
    /// It has ended in order.
    void end();
    /// Nobody wants to go on with it: there is no journal any more.
    void forget();

    /// A text that cannot be written is kept, and written again with the next text of the file, before the
    /// file is read, and in finish().
    void keep_file(const std::string &path, std::string text, Old old = Old::DROPPED);
    /// Waits for the disk, at most 1 s, and not for one that take_delay() has found late: the file has this
    /// text when it returns without an error, and no earlier text replaces it. A disk that answers later
    /// still writes it.
    Result<> write_file(const std::string &path, const std::string &text, Old old = Old::DROPPED);
    /// Reads a file after what was asked for it before is written; an error when that cannot be written.
    /// `then` is called in the thread of the disk.
    using Then = std::function<void(Result<std::string>)>;
    void read_file(const std::string &path, Then then);
    /// The file has its last text, or writing it has failed, or take_delay() has found the disk late.
    bool isSettled(const std::string &path) const;

    /// What the operator is to know, once.
    std::optional<std::string> take_trouble();
    /// Which file the disk has not answered for in 1 s, once. Called in each cycle at clock time `now_ns`.
    std::optional<std::string> take_delay(std::int64_t now_ns);
    /// With Works::ON_CALL: does what was asked; false when there was nothing.
    bool work();
    /// Nothing is asked afterwards. Waits for all that was asked, at most 0.5 s where a thread does it;
    /// files that are not written are then named on standard error.
    void finish();

  private:
    struct Job;
    class Core;

    std::shared_ptr<Core> core_;  ///< also of the thread, which outlives this while its disk does not answer
    std::thread thread_;
    bool isFinished_ = false;
};

}  // namespace mw::journal
