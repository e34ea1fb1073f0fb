// SPDX-License-Identifier: GPL-2.0-or-later
// The lines of one file: in memory, or in windows for large files whose lines are read in order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::gcode::detail {

/// Minimum size of files that remain on disk if they have no O words [bytes].
inline constexpr std::uint64_t WINDOWED_FROM_BYTES = 16U << 20U;

class ProgramText {
  public:
    explicit ProgramText(std::string text);
    ~ProgramText();
    ProgramText(ProgramText &&) noexcept;
    ProgramText &operator=(ProgramText &&) noexcept;

    /// Large files remain on disk until hold().
    static Result<ProgramText> open(const std::string &path);
    /// Reads a file on disk into memory, for reading its lines in any order.
    Result<> hold();
    bool isHeld() const { return reader_ == nullptr; }

    std::uint64_t count_bytes() const { return size_; }
    int count_lines() const { return count_; }
    /// Position of a line; of a file on disk, the position of its window [bytes].
    std::uint64_t place_of(int line) const;
    /// `line` from 1, without the newline. For a file on disk it is valid until lines of two other windows
    /// have been read, and empty when the file can no longer be read: see failure().
    std::string_view line(int line) const;
    /// Why lines cannot be read: the file was changed or removed. Empty without an error.
    const std::string &failure() const;

    /// Visits all lines in order, and records their positions. The visitor returns false to stop. @return
    /// false when it was stopped.
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
    std::vector<std::uint64_t> starts_;  ///< start of each line in text_
    std::unique_ptr<Reader> reader_;     ///< for a file on disk
    std::uint64_t size_ = 0;
    int count_ = 0;
    std::uint64_t scanned_ = 0;
};

}  // namespace mw::gcode::detail
