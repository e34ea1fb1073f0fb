// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/virtual/virtual_board.hh"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/board/model.hh"

namespace mw::mesa {

namespace {

/// The time of a board. It advances with a clock, and is ahead of it while packets are in transit or accesses
/// take time.
class FollowedClock {
  public:
    explicit FollowedClock(std::function<std::int64_t()> clock_ns)
        : clock_ns_(std::move(clock_ns)), last_ns_(clock_ns_()) {}

    /// The current time for a board that is at `board_ns`.
    std::int64_t now(std::int64_t board_ns) const {
        return std::max(begin_ns_ + (clock_ns_() - last_ns_), board_ns);
    }
    /// As now(). When the clock has advanced, its next step counts from here, so that the lead of the board
    /// within a cycle does not accumulate.
    std::int64_t follow(std::int64_t board_ns) {
        const std::int64_t now_ns = now(board_ns), clock = clock_ns_();
        if (clock != last_ns_) {
            begin_ns_ = now_ns;
            last_ns_ = clock;
        }
        return now_ns;
    }

  private:
    std::function<std::int64_t()> clock_ns_;
    std::int64_t last_ns_;       ///< last time of the clock
    std::int64_t begin_ns_ = 0;  ///< time of the board when the clock was at last_ns_
};

class VirtualTransport final : public lbp16::Transport {
  public:
    VirtualTransport(board::Model model, board::PhysicsPlan physics, std::function<std::int64_t()> clock_ns)
        : clock_(std::move(clock_ns)), board_(model, std::move(physics)), link_(board_, {}),
          transport_(link_) {}

    lbp16::TransportResult send(std::span<const std::byte> packet) noexcept override {
        transport_.sleep_until(clock_.follow(transport_.now_ns()));
        return transport_.send(packet);
    }
    lbp16::TransportResult receive(std::span<std::byte> packet) noexcept override {
        return transport_.receive(packet);
    }
    void wait_until(std::int64_t deadline_ns) noexcept override { transport_.wait_until(deadline_ns); }
    std::int64_t now_ns() const noexcept override { return clock_.now(transport_.now_ns()); }

  private:
    FollowedClock clock_;
    board::Board board_;
    board::Link link_;
    board::BoardTransport transport_;
};

/// Registers of a simulated board without any protocol.
class SimulatedRegisters final : public RegisterAccess {
  public:
    SimulatedRegisters(const board::Model &model, board::PhysicsPlan physics,
                       std::function<std::int64_t()> clock_ns)
        : clock_(std::move(clock_ns)), board_(model, std::move(physics)) {}

    bool read(std::uint16_t address, std::span<std::uint32_t> values) noexcept override {
        pass(ACCESS_NS);
        for (std::uint32_t &value : values) {
            value = board_.firmware().read(address);
            address = static_cast<std::uint16_t>(address + 4);
        }
        return true;
    }
    bool write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept override {
        pass(ACCESS_NS);
        for (const std::uint32_t value : values) {
            board_.firmware().write(address, value);
            address = static_cast<std::uint16_t>(address + 4);
        }
        return true;
    }
    void pause(std::chrono::nanoseconds duration) override { pass(duration.count()); }

  private:
    static constexpr std::int64_t ACCESS_NS = 1000;

    void pass(std::int64_t duration_ns) {
        time_ns_ = clock_.follow(time_ns_ + duration_ns);
        board_.advance(time_ns_);
    }

    FollowedClock clock_;
    board::Board board_;
    std::int64_t time_ns_ = 0;
};

/// Parts of the simulation.
struct Parts {
    board::Model model;
    board::PhysicsPlan physics;
};
Result<Parts> load(const VirtualBoardPlan &plan) {
    auto model = board::load_model(plan.model);
    if (!model) {
        return std::unexpected(model.error());
    }
    Parts parts{.model = std::move(*model), .physics = {}};
    if (!plan.physics_file.empty()) {
        const auto text = mw::read_file(plan.physics_file);
        if (!text) {
            return std::unexpected(text.error());
        }
        auto physics = board::parse_physics(*text, plan.physics_file, parts.model.idrom);
        if (!physics) {
            return std::unexpected(physics.error());
        }
        parts.physics = std::move(*physics);
    }
    return parts;
}

/// A relative path is relative to the folder of the configuration, if that is known.
std::string path_of(const std::string &file) {
    const char *const folder = std::getenv("CONFIG_DIR");
    const bool relative = !file.empty() && file.front() != '/';
    return relative && folder != nullptr ? fmt::format("{}/{}", folder, file) : file;
}

}  // namespace

VirtualBoardPlan with_paths(VirtualBoardPlan plan) {
    plan.physics_file = path_of(plan.physics_file);
    if (plan.model.contains('.')) {
        plan.model = path_of(plan.model);
    }
    return plan;
}

VirtualBoardPlan virtual_board_of(std::string_view board) {
    const char *const list = std::getenv("MILLWRIGHT_MESA");
    return with_paths(find_virtual_board(list == nullptr ? "" : list, board));
}

std::string missing_virtual_board(std::string_view board) {
    const char *const list = std::getenv("MILLWRIGHT_MESA");
    return fmt::format("the board of {} is not used under the virtual clock; name its model, such as "
                       "MILLWRIGHT_MESA={}=7i76e in the environment{}",
                       board, board, list == nullptr ? "" : fmt::format(", which has '{}'", list));
}

Result<VirtualRegisters> open_virtual_registers(const VirtualBoardPlan &plan,
                                                std::function<std::int64_t()> clock_ns) {
    auto parts = load(plan);
    if (!parts) {
        return std::unexpected(parts.error());
    }
    return VirtualRegisters{.card_name = parts->model.card_name,
                            .access = std::make_unique<SimulatedRegisters>(
                                parts->model, std::move(parts->physics), std::move(clock_ns))};
}

VirtualBoardPlan parse_virtual_board(std::string_view text) {
    const std::size_t colon = text.find(':');
    VirtualBoardPlan plan{.model = std::string(text.substr(0, colon)), .physics_file = {}};
    if (colon != std::string_view::npos) {
        plan.physics_file = text.substr(colon + 1);
    }
    return plan;
}

VirtualBoardPlan find_virtual_board(std::string_view list, std::string_view board) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(','), list.size());
        const std::string_view one = list.substr(0, end);
        const std::size_t equals = one.find('=');
        if (equals != std::string_view::npos && one.substr(0, equals) == board) {
            return parse_virtual_board(one.substr(equals + 1));
        }
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return {};
}

Result<std::unique_ptr<lbp16::Transport>> open_virtual_board(const VirtualBoardPlan &plan,
                                                             std::function<std::int64_t()> clock_ns) {
    auto parts = load(plan);
    if (!parts) {
        return std::unexpected(parts.error());
    }
    return std::make_unique<VirtualTransport>(std::move(parts->model), std::move(parts->physics),
                                              std::move(clock_ns));
}

}  // namespace mw::mesa
