// SPDX-License-Identifier: GPL-2.0-or-later
// The lines of one file: held in memory, or, for large files whose lines are read in order, in windows.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::gcode::detail {

/// Files from this size on stay on the disk while they have no O words [bytes].
inline constexpr std::uint64_t WINDOWED_FROM_BYTES = 16U << 20U;

class ProgramText {
  public:
    explicit ProgramText(std::string text);
    ~ProgramText();
    ProgramText(ProgramText &&) noexcept;
    ProgramText &operator=(ProgramText &&) noexcept;

    /// Large files are left on the disk, until hold() asks for all of it.
    static Result<ProgramText> open(const std::string &path);
    /// Reads a file that was left on the disk into memory: its lines will be asked for in any order.
    Result<> hold();
    bool isHeld() const { return reader_ == nullptr; }

    std::uint64_t count_bytes() const { return size_; }
    int count_lines() const { return count_; }
    /// Where a line begins; of a file on the disk, where its window begins [bytes].
    std::uint64_t place_of(int line) const;
    /// `line` from 1, without the newline. Of a file on the disk it is valid until lines of two other windows
    /// have been asked for, and empty once the file cannot be read any more: see failure().
    std::string_view line(int line) const;
    /// Why lines cannot be read: the file was changed or is gone. Empty while all is well.
    const std::string &failure() const;

    /// Visits all lines in order, and finds where they are. The visitor answers false to end it.
    /// @return false when it was ended.
    template <class Visitor>
    Result<bool> scan(Visitor &&visitor) {
        begin_scan();
        std::string_view content;
        while (next_of_scan(content)) {
            if (!visitor(count_, content)) {
                return false;
            }
        }
        return end_scan();
    }

  private:
    class Reader;
    explicit ProgramText(std::unique_ptr<Reader> reader);
    void begin_scan();
    bool next_of_scan(std::string_view &content);
    Result<bool> end_scan();

    std::string text_;
    std::vector<std::uint64_t> starts_;  ///< of each line in text_
    std::unique_ptr<Reader> reader_;     ///< of a file on the disk
    std::uint64_t size_ = 0;
    int count_ = 0;
    std::uint64_t scanned_ = 0;
};

}  // namespace mw::gcode::detail
