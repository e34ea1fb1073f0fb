// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated board: it executes the packets of a host at given times.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/mesa/board/firmware.hh"
#include "drivers/mesa/board/spaces.hh"
#include "drivers/mesa/lbp16/packet.hh"

namespace mw::mesa::board {

/// A command that the board has executed.
struct ExecutedCommand {
    std::int64_t time_ns = 0;
    lbp16::Command command;
    std::span<const std::byte> data;  ///< data that were written or read
};

/// One line of a log: time [ns], R or W with the space, address, units and data as hexadecimal numbers.
std::string log_line(const ExecutedCommand &executed);

/// The answer to a packet.
struct Reply {
    std::vector<std::byte> bytes;
    std::int64_t time_ns = 0;  ///< later than the packet if the board waits
};

/// A board and its connected hardware. Times are ns since its creation and do not decrease. [one thread]
class Board {
  public:
    explicit Board(const Model &model, PhysicsPlan physics = {});
    Board(const Board &) = delete;
    Board &operator=(const Board &) = delete;

    /// Executes a packet that arrives at `time_ns`. Returns no reply if the packet has no reads, or the board
    /// has no power.
    std::optional<Reply> execute(std::span<const std::byte> packet, std::int64_t time_ns);
    /// Advances the time.
    void advance(std::int64_t time_ns);
    /// Resets all registers to their values at power-up; the board does not answer for `off_ns`.
    void restart(std::int64_t time_ns, std::int64_t off_ns);

    using Log = std::function<void(const ExecutedCommand &)>;
    void set_log(Log log) { log_ = std::move(log); }

    Firmware &firmware() { return *firmware_; }
    const Physics &physics() const { return physics_; }
    std::int64_t now_ns() const { return firmware_->now_ns(); }
    std::uint16_t control(ControlAddress address) const;

  private:
    static constexpr std::size_t SPACES = 8;

    bool execute_one(const lbp16::ReceivedCommand &received, Reply &reply);
    bool execute_units(const lbp16::ReceivedCommand &received, Reply &reply);
    bool read_information(const lbp16::Command &command, Reply &reply);
    std::uint64_t read_unit(const lbp16::Command &command, std::uint32_t address);
    /// False when the write is not permitted.
    bool write_unit(const lbp16::Command &command, std::uint32_t address, std::uint64_t value);
    void write_control(std::uint32_t address, std::uint16_t value);
    bool mayWrite(const lbp16::Command &command, std::uint32_t address) const;
    void count_error(ErrorBit bit, ControlAddress counter);
    void count(ControlAddress counter);
    std::vector<std::byte> &memory_of(lbp16::Space space);

    Model model_;
    Physics physics_;
    std::unique_ptr<Firmware> firmware_;
    std::array<SpaceFacts, SPACES> facts_;
    std::array<std::uint16_t, SPACES> pointers_{};
    std::array<std::vector<std::byte>, SPACES> memories_;
    Flash flash_;
    Log log_;
    std::int64_t power_on_ns_ = 0;
    std::int64_t wait_ns_ = 0;  ///< wait of the current packet
    bool restarts_ = false;     ///< the current packet resets the board
};

}  // namespace mw::mesa::board
