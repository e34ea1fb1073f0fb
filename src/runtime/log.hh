// SPDX-License-Identifier: GPL-2.0-or-later
// A log for realtime threads: fixed records in a ring, printed by another thread in the order of writing.
#pragma once

#include <array>
#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <memory>

namespace mw::runtime {

/// As msg_level_t of rtapi.h.
enum class LogLevel : std::uint8_t { NONE = 0, ERR, WARN, INFO, DBG, ALL };

class Log {
  public:
    static constexpr std::size_t TEXT_SIZE = 1004;
    static constexpr std::size_t RECORDS = 1024;

    /// Receives a line. `text` is zero-terminated and does not end with a newline.
    using Sink = void (*)(void *context, LogLevel level, const char *text);

    /// SYNCHRONOUS prints within the call (virtual clock, tools); DRAINED prints in a separate thread
    /// (realtime).
    enum class Mode : std::uint8_t { SYNCHRONOUS, DRAINED };

    /// A null sink prints texts of level ALL (those of rtapi_print) on standard output, others on standard
    /// error.
    explicit Log(Mode mode = Mode::SYNCHRONOUS, Sink sink = nullptr, void *context = nullptr);
    ~Log();
    Log(const Log &) = delete;
    Log &operator=(const Log &) = delete;

    /// Appends a message if `level` is within the current one; realtime-safe when DRAINED. A message is a
    /// line; a text of level ALL without a newline is continued by the next one. A text longer than TEXT_SIZE
    /// ends in "...". [any thread]
    void print(LogLevel level, const char *format, ...) noexcept __attribute__((format(printf, 3, 4)));
    void vprint(LogLevel level, const char *format, std::va_list args) noexcept;
    /// Appends at any level.
    void vprint_always(LogLevel level, const char *format, std::va_list args) noexcept;

    void set_level(LogLevel level) noexcept { level_.store(level, std::memory_order_relaxed); }
    LogLevel level() const noexcept { return level_.load(std::memory_order_relaxed); }

    /// Prints the waiting records in this thread. [not realtime]
    void drain();
    /// Number of messages lost because the ring was full.
    std::uint64_t lost() const noexcept;
    /// Replaces the sink; returns the previous one in `sink` and `context`. [not realtime]
    void swap_sink(Sink &sink, void *&context);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::atomic<LogLevel> level_{LogLevel::ERR};
};

}  // namespace mw::runtime
