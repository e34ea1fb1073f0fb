// SPDX-License-Identifier: GPL-2.0-or-later
// Lines of GPIO chips: the requested lines, and access to them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mw::gpio {

/// Maximum number of lines of one component.
constexpr std::size_t MAX_LINES = 64;
/// Size of a line's name, with its zero. [bytes]
constexpr std::size_t NAME_SIZE = 32;

/// Levels of lines, bit i for line i of the component.
using Levels = std::uint64_t;

constexpr Levels bit_of(std::size_t line) noexcept {
    return Levels{1} << line;
}

enum class Direction : std::uint8_t { INPUT, OUTPUT };
enum class Drive : std::uint8_t { PUSH_PULL, OPEN_DRAIN, OPEN_SOURCE };
enum class Bias : std::uint8_t { AS_IS, DISABLED, PULL_DOWN, PULL_UP };

/// A requested line.
struct Line {
    char name[NAME_SIZE] = {};  ///< name as shown by gpioinfo
    Direction direction = Direction::INPUT;
    Drive drive = Drive::PUSH_PULL;
    Bias bias = Bias::AS_IS;
    bool inverted = false;  ///< active while low
};

struct Lines {
    Line line[MAX_LINES];
    std::size_t count = 0;
};

/// One message for the first cycle of a failure.
class FailureState {
  public:
    /// Evaluates the result of a call; true if a failure begins with this call.
    bool begins(bool good) noexcept {
        const bool begun = !good && !failing_;
        failing_ = !good;
        return begun;
    }
    bool isFailing() const noexcept { return failing_; }

  private:
    bool failing_ = false;
};

/// Reads and writes lines. [read and write: servo thread, no allocation]
class LineAccess {
  public:
    /// Claims the lines; outputs become inactive. Returns 0, or a negated errno with a message in the log
    /// that names the line. [while loading]
    virtual int open(const char *module, const Lines &lines) noexcept = 0;
    /// States of all inputs; false: they could not be read, and `levels` is unchanged.
    virtual bool read(Levels &levels) noexcept = 0;
    /// States of all outputs; false: they could not be written.
    virtual bool write(Levels levels) noexcept = 0;
    virtual void close() noexcept = 0;

  protected:
    ~LineAccess() = default;
};

}  // namespace mw::gpio
