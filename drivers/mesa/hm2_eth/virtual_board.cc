// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hm2_eth/virtual_board.hh"

#include <algorithm>

#include "drivers/mesa/board/board_transport.hh"
#include "drivers/mesa/board/model.hh"
#include "drivers/mesa/board/table_file.hh"

namespace mw::mesa {

namespace {

class VirtualTransport final : public lbp16::Transport {
  public:
    VirtualTransport(board::Model model, board::PhysicsPlan physics, std::function<std::int64_t()> clock_ns)
        : clock_ns_(std::move(clock_ns)), board_(model, std::move(physics)), link_(board_, {}),
          transport_(link_), last_clock_ns_(clock_ns_()) {}

    lbp16::TransportResult send(std::span<const std::byte> packet) noexcept override {
        transport_.sleep_until(now_ns());
        begin_ns_ = transport_.now_ns();
        last_clock_ns_ = clock_ns_();
        return transport_.send(packet);
    }
    lbp16::TransportResult receive(std::span<std::byte> packet) noexcept override {
        return transport_.receive(packet);
    }
    void wait_until(std::int64_t deadline_ns) noexcept override { transport_.wait_until(deadline_ns); }
    std::int64_t now_ns() const noexcept override {
        return std::max(begin_ns_ + (clock_ns_() - last_clock_ns_), transport_.now_ns());
    }

  private:
    std::function<std::int64_t()> clock_ns_;
    board::Board board_;
    board::Link link_;
    board::BoardTransport transport_;
    std::int64_t last_clock_ns_;  ///< of the clock at the last packet
    std::int64_t begin_ns_ = 0;   ///< time of the board then
};

}  // namespace

VirtualBoardPlan parse_virtual_board(std::string_view text) {
    const std::size_t colon = text.find(':');
    VirtualBoardPlan plan{.model = std::string(text.substr(0, colon)), .physics_file = {}};
    if (colon != std::string_view::npos) {
        plan.physics_file = text.substr(colon + 1);
    }
    return plan;
}

VirtualBoardPlan find_virtual_board(std::string_view list, std::string_view address) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(','), list.size());
        const std::string_view one = list.substr(0, end);
        const std::size_t equals = one.find('=');
        if (equals != std::string_view::npos && one.substr(0, equals) == address) {
            return parse_virtual_board(one.substr(equals + 1));
        }
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return {};
}

Result<std::unique_ptr<lbp16::Transport>> open_virtual_board(const VirtualBoardPlan &plan,
                                                             std::function<std::int64_t()> clock_ns) {
    auto model = board::load_model(plan.model);
    if (!model) {
        return std::unexpected(model.error());
    }
    board::PhysicsPlan physics;
    if (!plan.physics_file.empty()) {
        const auto text = board::read_text_file(plan.physics_file);
        if (!text) {
            return std::unexpected(text.error());
        }
        auto parsed = board::parse_physics(*text, plan.physics_file, model->idrom);
        if (!parsed) {
            return std::unexpected(parsed.error());
        }
        physics = std::move(*parsed);
    }
    return std::make_unique<VirtualTransport>(std::move(*model), std::move(physics), std::move(clock_ns));
}

}  // namespace mw::mesa
