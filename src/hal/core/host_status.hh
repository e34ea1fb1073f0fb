// SPDX-License-Identifier: GPL-2.0-or-later
// Status that the realtime process of an instance reports to all processes.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mw::hal {

namespace detail {
class Segment;
}

class HostStatus {
  public:
    explicit HostStatus(detail::Segment &segment) : segment_(segment) {}

    /// True when the host's threads have realtime priority. [any thread, realtime-safe]
    bool isRealtime() const noexcept;
    /// The reason why they have no realtime priority, as reported by the realtime process at its start. Empty
    /// when they have it, or in virtual time.
    std::string realtime_missing() const;
    void set_realtime_missing(std::string_view why);
    /// The reason why the realtime host has ended or is crashing; nothing otherwise.
    std::optional<std::string> end_reason() const;
    /// Stores the reason why this host ends; only the first text is kept. [any thread, async-signal-safe]
    void note_end(const char *text) noexcept;
    /// Number of events; see mw_ext_lost_positions. [any thread, realtime-safe]
    std::atomic<std::uint32_t> &lost_positions() noexcept;

  private:
    detail::Segment &segment_;
};

}  // namespace mw::hal
