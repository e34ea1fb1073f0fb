// SPDX-License-Identifier: GPL-2.0-or-later
// Faults of the link and of the board, from a text table; the same seed gives the same faults.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::mesa::board {

/// Faults of the packets of one direction. Probabilities are from 0 to 1.
struct DirectionFaults {
    double loss = 0, duplicate = 0, reorder = 0, cut = 0;
    std::int64_t delay_ns = 0;        ///< constant delay of each packet
    double jitter_ns = 0;             ///< standard deviation of an additional normally distributed delay
    double burst = 0;                 ///< probability that a burst begins
    unsigned burst_packets = 0;       ///< number of packets in a burst
    std::int64_t burst_delay_ns = 0;  ///< delay of the packets in a burst; 0: they are lost
    std::int64_t start_ns = 0;        ///< no faults before this time
};

enum class FaultType : std::uint8_t {
    RESET,        ///< registers as at power-up
    POWER_OFF,    ///< as RESET, and does not answer for a time
    WATCHDOG,     ///< the watchdog bites
    LINK_DOWN,    ///< all packets are lost for a time
    SECOND_HOST,  ///< another host reads registers and counters for a time
};

struct FaultEvent {
    FaultType type = FaultType::RESET;
    std::int64_t at_ns = 0, duration_ns = 0;
    std::int64_t period_ns = 0;  ///< interval of the reads of the second host
};

struct FaultPlan {
    std::uint64_t seed = 1;
    DirectionFaults to_board, to_host;
    std::vector<FaultEvent> events;
};

/// Lines `seed N`, `to_board` and `to_host` with loss=, duplicate=, reorder=, cut= (probabilities),
/// delay_us=, jitter_us=, burst= (probability), burst_packets=, burst_delay_us=, start_ms=, and `event
/// reset|power_off|watchdog| link_down|second_host at_ms= [duration_ms=] [period_us=]`.
Result<FaultPlan> parse_faults(std::string_view text, const std::string &file);

/// A packet with the time of its arrival.
struct Delivery {
    std::int64_t time_ns = 0;
    std::vector<std::byte> bytes;
    int host = 0;  ///< number of the host that sent it or that receives it
};

/// The faults of one direction. [one thread]
class FaultyDirection {
  public:
    FaultyDirection(const DirectionFaults &faults, std::uint64_t seed);
    /// Arrival times of a packet that is sent now, one for each copy. Packets overtake each other only by
    /// `reorder`.
    std::vector<Delivery> pass(std::vector<std::byte> bytes, std::int64_t now_ns, int host);

  private:
    bool happens(double probability);
    /// The delay of one packet; negative if it is lost.
    std::int64_t delay();

    DirectionFaults faults_;
    std::mt19937_64 random_;
    std::int64_t last_ns_ = 0;
    unsigned burst_left_ = 0;
};

}  // namespace mw::mesa::board
